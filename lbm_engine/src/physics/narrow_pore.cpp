#include "physics/narrow_pore.hpp"

#include "lattice/each_isa.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {
namespace {

/// Cells that are worked on at a time.
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

/// Copies rows of cells in whole chunks, at least one: what follows begins where they end.
LBM_EACH_ISA
void copy_rows(const CutCells::Row* row, const CutCells::Row* end, double* fraction, double* x, double* y, double* z)
{
    std::ptrdiff_t at = 0;
    for (; row != end; ++row) {
        const double y0 = row->first[1], z0 = row->first[2];
        const double* from = row->fractions;
        double x0 = row->first[0];
        int count = row->before;
        for (int part = 0; part < 2; ++part) {
            int i = 0;
            do {
                for (int l = 0; l < kChunk; ++l) fraction[at + i + l] = from[i + l];
                for (int l = 0; l < kChunk; ++l) x[at + i + l] = x0 + (i + l);
                for (int l = 0; l < kChunk; ++l) y[at + i + l] = y0;
                for (int l = 0; l < kChunk; ++l) z[at + i + l] = z0;
                i += kChunk;
            } while (i < count);
            at += count;
            from += row->before + row->full;
            x0 += row->before + row->full;
            count = row->after;
        }
    }
}

/// Raises the thickening of cells by what a pore asks for; x, y, z: their centres as seen from that of the sphere.
LBM_EACH_ISA
void narrow(const Pore& pore, const double* x, const double* y, const double* z, std::size_t count, double* thickening)
{
    constexpr double kStrength = 3.7, kWidth2 = 4;  // fitted: docs/physics.md
    const double tx = pore.towards[0], ty = pore.towards[1], tz = pore.towards[2];
    const double curvature = 0.5 * (pore.curvature1 + pore.curvature2), curvature2 = pore.curvature2;
    const double distance = pore.distance, over_widest = 1 / pore.widest, twice_curvature1 = 2 * pore.curvature1;
    const double inner2 = pore.inner * pore.inner;
    count &= ~static_cast<std::size_t>(kChunk - 1);  // whole chunks
    for (std::size_t i = 0; i < count; ++i) {
        const double r2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i], along = x[i] * tx + y[i] * ty + z[i] * tz;
        const double width = curvature * r2 - along + distance, h = width > 0 ? width : 0;
        const double narrow = 1 - h * over_widest, in_reach = narrow > 0 ? narrow : 0;
        const double facing = twice_curvature1 * (along - curvature2 * r2);  // -2 r.s / (R1 R2)
        const double t = kStrength / (h * h + kWidth2) * in_reach * (facing < 1 ? facing : 1);
        const double at_surface = r2 >= inner2 ? t : 0;  // not where parts of a body overlap
        thickening[i] = at_surface > thickening[i] ? at_surface : thickening[i];
    }
}

/// Thickens the fractions of whole chunks; adds what it added to sums, side by side: one order for all instruction sets.
LBM_EACH_ISA
void apply(const double* thickening, std::size_t count, double* fraction, double (&sums)[kChunk])
{
    for (std::size_t i = 0; i < count; i += kChunk)
        for (int l = 0; l < kChunk; ++l) {
            const double eps = fraction[i + l], more = thickening[i + l] * (eps * (1 - eps));
            fraction[i + l] = eps + more;
            sums[l] += more;
        }
}

}  // namespace

double narrow_reach(double radius1, double radius2)
{
    const double widest = widest_pore(1 / std::min(radius1, radius2));
    return radius1 + std::sqrt(radius2 * radius2 + 2 * radius2 * (widest + kCut));
}

void CutCells::gather()
{
    planes_.clear();
    lowest_ = rows_.empty() ? 0 : rows_.front().first[2];
    count_ = 0;
    for (const Row& row : rows_) {
        while (lowest_ + static_cast<double>(planes_.size()) < row.first[2] + 0.5) planes_.push_back(count_);
        count_ += row.before + row.after;
    }
    const std::size_t size = count_ + 2 * kChunk;
    if (size > fraction_.size()) {
        for (auto& place : place_) place.resize(2 * size);
        fraction_.resize(2 * size);
        thickening_.resize(2 * size);
    }
    copy_rows(rows_.data(), rows_.data() + rows_.size(), fraction_.data(), place_[0].data(), place_[1].data(),
              place_[2].data());
    std::fill_n(fraction_.begin() + static_cast<std::ptrdiff_t>(count_), kChunk, 0.0);
}

/// Works on whole chunks: cells beyond the last one are empty.
double CutCells::thicken(double radius, const std::vector<Opposite>& opposite)
{
    const auto chunks = [](std::size_t count) { return (count + kChunk - 1) / kChunk * kChunk; };
    std::fill_n(thickening_.begin(), chunks(count_), 0.0);
    for (const Opposite& other : opposite) {
        const Pore pore(radius, other);
        const auto reach = pore.reach_z();
        if (reach.end < reach.begin) continue;
        const auto plane = [&](double z) {  // the first cell of the first plane from z on
            const double k = std::ceil(z - lowest_);
            return k < static_cast<double>(planes_.size()) ? planes_[static_cast<std::size_t>(std::max(k, 0.0))]
                                                           : count_;
        };
        const std::size_t first = plane(reach.begin), count = chunks(plane(reach.end) - first);
        narrow(pore, place_[0].data() + first, place_[1].data() + first, place_[2].data() + first, count,
               thickening_.data() + first);
    }
    double sums[kChunk]{};
    apply(thickening_.data(), chunks(count_), fraction_.data(), sums);
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace lbm
