#include "physics/narrow_pore.hpp"

#include "lattice/each_isa.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {
namespace {

/// Cells that are written at a time.
constexpr int kChunk = 8;

/// Half a diagonal: the centres of cells that a surface cuts are so near it.
constexpr double kCut = 0.87;

/// Pores that are wider than this, with the larger of two curvatures, are not narrow.
double widest_pore(double curvature) { return 1 / curvature; }

/// The pore between a sphere and what stands opposite: what does not depend on the cell.
struct Pore {
    Vec3 towards;
    double curvature1, curvature2;
    double distance;  ///< h = (curvature1 + curvature2) / 2 r^2 - r.towards + distance
    double widest;
    double inner, outer;  ///< radii between which cut cells have their centres

    Pore(double radius, const Opposite& other)
        : towards(other.towards)
        , curvature1(1 / radius)
        , curvature2(other.curvature)
        , distance(other.distance - 0.5 * radius)
        , widest(widest_pore(std::max(curvature1, curvature2)))
        , inner(std::max(0.0, radius - kCut))
        , outer(radius + kCut)
    {
    }

    struct Reach {
        double begin, end;
    };
    /// Where along z, from the centre of the sphere, its cut cells in the pore may be: those of a cap.
    Reach reach_z() const
    {
        const double length = norm(towards);
        const double faces = curvature2 * inner * inner;                                            // r.s < 0
        const double narrow = 0.5 * (curvature1 + curvature2) * inner * inner + distance - widest;  // h < widest
        const double height = std::max(faces, narrow) / length;
        if (!(height < outer)) return {0, -1};
        const double n = towards[2] / length;
        const double across = std::sqrt(std::max(0.0, (1 - n * n) * (outer * outer - height * height)));
        return {-n * outer >= height ? -outer : n * height - across, n * outer >= height ? outer : n * height + across};
    }
};

/// Coordinates along an axis of cells, the first one of all at `first`.
LBM_EACH_ISA
void coordinates(const std::int16_t* cell, int count, double first, double* x)
{
    for (int i = 0; i < count; ++i) x[i] = first + cell[i];
}

/// Raises the thickening of cells by what a pore asks for; x, y, z: their centres as seen from that of the sphere.
LBM_EACH_ISA
void narrow(const Pore& pore, const double* x, const double* y, const double* z, int count, double* thickening)
{
    constexpr double kStrength = 3.7, kWidth2 = 4;  // fitted: docs/physics.md
    const double tx = pore.towards[0], ty = pore.towards[1], tz = pore.towards[2];
    const double curvature = 0.5 * (pore.curvature1 + pore.curvature2), curvature2 = pore.curvature2;
    const double distance = pore.distance, over_widest = 1 / pore.widest, twice_curvature1 = 2 * pore.curvature1;
    const double inner2 = pore.inner * pore.inner;
    for (int i = 0; i < count; ++i) {
        const double r2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i], along = x[i] * tx + y[i] * ty + z[i] * tz;
        const double width = curvature * r2 - along + distance, h = width > 0 ? width : 0;
        const double narrow = 1 - h * over_widest, in_reach = narrow > 0 ? narrow : 0;
        const double facing = twice_curvature1 * (along - curvature2 * r2);  // -2 r.s / (R1 R2)
        const double t = kStrength / (h * h + kWidth2) * in_reach * (facing < 1 ? facing : 1);
        const double at_surface = r2 >= inner2 ? t : 0;  // not where parts of a body overlap
        thickening[i] = at_surface > thickening[i] ? at_surface : thickening[i];
    }
}

/// Thickens the fractions; leaves what was added in place of the thickening.
LBM_EACH_ISA
void apply(double* thickening, int count, double* fraction)
{
    for (int i = 0; i < count; ++i) {
        thickening[i] *= fraction[i] * (1 - fraction[i]);
        fraction[i] += thickening[i];
    }
}

}  // namespace

double narrow_reach(double radius1, double radius2)
{
    const double widest = widest_pore(1 / std::min(radius1, radius2));
    return radius1 + std::sqrt(radius2 * radius2 + 2 * radius2 * (widest + kCut));
}

void CutCells::clear(const std::array<int, 3>& corner)
{
    corner_ = corner;
    count_ = 0;
    planes_.clear();
}

/// Rows are written in whole chunks, of which the last one does not count to its end.
void CutCells::add(int begin, int end, int y, int z)
{
    while (static_cast<int>(planes_.size()) <= z - corner_[2]) planes_.push_back(count_);
    for (int i = begin; i < end; i += kChunk) {
        if (count_ + kChunk > static_cast<int>(cell_[0].size())) grow();
        for (int l = 0; l < kChunk; ++l) cell_[0][count_ + l] = static_cast<std::int16_t>(i - corner_[0] + l);
        for (int l = 0; l < kChunk; ++l) cell_[1][count_ + l] = static_cast<std::int16_t>(y - corner_[1]);
        for (int l = 0; l < kChunk; ++l) cell_[2][count_ + l] = static_cast<std::int16_t>(z - corner_[2]);
        count_ += std::min(kChunk, end - i);
    }
}

void CutCells::grow()
{
    const std::size_t size = 2 * (cell_[0].size() + 512);
    for (auto& cell : cell_) cell.resize(size);
    for (auto& place : place_) place.resize(size);
    thickening_.resize(size);
    planes_.reserve(size / 16);
}

double CutCells::thicken(const Vec3& centre, double radius, const std::vector<Opposite>& opposite, double* fractions)
{
    for (int d = 0; d < 3; ++d) coordinates(cell_[d].data(), count_, corner_[d] + 0.5 - centre[d], place_[d].data());
    std::fill_n(thickening_.begin(), count_, 0.0);
    const double planes = static_cast<double>(planes_.size());
    for (const Opposite& other : opposite) {
        const Pore pore(radius, other);
        const auto reach = pore.reach_z();
        if (reach.end < reach.begin) continue;
        const auto plane = [&](double z) {
            const auto k = static_cast<std::size_t>(std::clamp(centre[2] + z - corner_[2], 0.0, planes));
            return k < planes_.size() ? planes_[k] : count_;
        };
        const int first = plane(reach.begin), count = plane(reach.end + 1) - first;
        narrow(pore, place_[0].data() + first, place_[1].data() + first, place_[2].data() + first, count,
               thickening_.data() + first);
    }
    apply(thickening_.data(), count_, fractions);
    std::array<double, 4> sums{};  // side by side, in a fixed order
    for (int i = 0; i < count_; ++i) sums[i % 4] += thickening_[i];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace lbm
