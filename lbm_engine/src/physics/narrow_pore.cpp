#include "physics/narrow_pore.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {
namespace {

/// Half a diagonal: the centres of cells that a surface cuts are so near it.
constexpr double kCut = 0.87;

/// The widest pores of any law that are narrow, in radii of the smaller sphere.
constexpr double kWidestPore = 2;

/// The pore between a sphere and what stands opposite: what does not depend on the cell.
struct Pore {
    Vec3 towards;
    double curvature1, curvature2;
    double distance;  ///< h = (curvature1 + curvature2) / 2 r^2 - r.towards + distance
    double widest, near, far, facing;
    double inner, outer;  ///< radii between which cut cells have their centres

    Pore(const PoreLaw& law, double radius, const Opposite& other)
        : towards(other.towards)
        , curvature1(1 / radius)
        , curvature2(other.curvature)
        , distance(other.distance - 0.5 * radius)
        , widest(law.widest / std::max(curvature1, curvature2))
        , near(law.near)
        , far(law.far)
        , facing(law.facing)
        , inner(std::max(0.0, radius - kCut))
        , outer(radius + kCut)
    {
    }

    PoreShape shape() const
    {
        const auto single = [](double x) { return static_cast<float>(x); };
        return {{single(towards[0]), single(towards[1]), single(towards[2])},
                single(0.5 * (curvature1 + curvature2)),
                single(distance),
                single(1 / widest),
                single(near),
                single(far),
                single(facing * curvature1),
                single(curvature2),
                single(inner * inner)};
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

}  // namespace

double narrow_reach(double radius1, double radius2)
{
    const double widest = kWidestPore * std::min(radius1, radius2);
    return radius1 + std::sqrt(radius2 * radius2 + 2 * radius2 * (widest + kCut));
}

void CutCells::gather()
{
    planes_.clear();
    lowest_ = rows_.empty() ? 0 : rows_.front().first[2];
    count_ = 0;
    for (const CutRow& row : rows_) {
        while (lowest_ + static_cast<double>(planes_.size()) < row.first[2] + 0.5) planes_.push_back(count_);
        count_ += row.before + row.after;
    }
    fraction_.reserve(count_ + kPore);
    for (Packed<float>* const numbers : {&place_[0], &place_[1], &place_[2], &thickening_})
        numbers->reserve(count_ + kPore);
    sphere_kernels().gather(rows_.data(), rows_.data() + rows_.size(), fraction_.data(), place_[0].data(),
                            place_[1].data(), place_[2].data());
    std::fill_n(fraction_.data() + count_, kPack, 0.0);
}

/// Works on whole packs: cells beyond the last one are empty.
void CutCells::thicken(const PoreLaw& law, double radius, const std::vector<Opposite>& opposite)
{
    if (count_ == 0) return;  // a sphere outside of the lattice, beside its own images
    const SphereKernels& kernels = sphere_kernels();
    std::fill_n(thickening_.data(), padded_to_packs(count_), 0.0F);
    for (const Opposite& other : opposite) {
        const Pore pore(law, radius, other);
        const auto reach = pore.reach_z();
        if (reach.end < reach.begin) continue;
        const auto plane = [&](double z) {  // the first cell of the first plane from z on
            const double k = std::ceil(z - lowest_);
            return k < static_cast<double>(planes_.size()) ? planes_[static_cast<std::size_t>(std::max(k, 0.0))]
                                                           : count_;
        };
        const std::size_t first = plane(reach.begin) / kPack * kPack, count = plane(reach.end) - first;
        kernels.narrow(pore.shape(), place_[0].data() + first, place_[1].data() + first, place_[2].data() + first,
                       count, thickening_.data() + first);
    }
    kernels.thicken(thickening_.data(), count_, fraction_.data());
}

}  // namespace lbm
