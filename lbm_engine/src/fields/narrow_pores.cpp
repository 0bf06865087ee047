#include "fields/narrow_pores.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {

void NarrowPores::search(const std::vector<LatticeSolid>& solids)
{
    centres_.clear();
    largest_ = 0;
    for (const LatticeSolid& solid : solids) {
        centres_.push_back(solid.geometry.centre);
        if (solid.geometry.shape == Shape::sphere) largest_ = std::max(largest_, solid.geometry.radius);
    }
    if (largest_ > 0) neighbours_.sort(centres_, narrow_reach(largest_, largest_));
}

/// Whether a point is nearer than its periodic images: of a rigid body, then, the member and not its image.
bool NarrowPores::is_nearest(const Vec3& image, const Vec3& to) const
{
    for (int d = 0; d < 3; ++d)
        if (periodic_[d] && 2 * std::abs(image[d] - to[d]) > n_[d]) return false;
    return true;
}

void NarrowPores::find(std::size_t solid, const std::vector<LatticeSolid>& solids,
                       std::vector<Opposite>& opposite) const
{
    constexpr std::size_t kMostly = 48;  // spheres of one size have fewer: no memory is asked for while they move
    opposite.clear();
    opposite.reserve(kMostly);
    const LatticeSolid& one = solids[solid];
    if (one.geometry.shape != Shape::sphere) return;
    const Vec3& centre = one.geometry.centre;
    const double R = one.geometry.radius, farthest = narrow_reach(R, largest_);
    const auto add = [&](const Vec3& image, double radius) {
        const Vec3 apart = image - centre;
        const double apart2 = dot(apart, apart);
        if (apart2 >= farthest * farthest || apart2 == 0) return;
        const double reach = narrow_reach(R, radius);
        if (apart2 < reach * reach) opposite.emplace_back(apart, radius);
    };
    const auto add_mirrored = [&](const Vec3& image, double radius) {
        for (int face = 0; face < 6; ++face) {
            if (!mirrors_[face]) continue;
            Vec3 mirrored = image;
            mirrored[face / 2] = (face % 2 == 0 ? 0 : 2 * n_[face / 2]) - image[face / 2];
            add(mirrored, radius);
        }
    };
    add_mirrored(centre, R);
    neighbours_.for_near(static_cast<std::int32_t>(solid), [&](std::int32_t other, const Vec3& shift) {
        const Vec3 image = centres_[other] + shift, apart = image - centre;
        if (!any_mirror_ && dot(apart, apart) >= farthest * farthest) return;
        const LatticeSolid& two = solids[other];
        if (two.geometry.shape != Shape::sphere) return;
        if (one.body >= 0 && one.body == two.body && is_nearest(image, centre)) return;
        add(image, two.geometry.radius);
        add_mirrored(image, two.geometry.radius);
    });
}

}  // namespace lbm
