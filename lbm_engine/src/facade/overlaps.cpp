#include "lbm/overlap.hpp"

#include "fields/neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lbm {
namespace {

/// Common volume of two spheres whose centres are d apart, part of the smaller one's.
double shared_volume(double R1, double R2, double d)
{
    const double small = std::min(R1, R2), large = std::max(R1, R2);
    if (d >= R1 + R2) return 0;
    if (d <= large - small) return 1;
    const double depth = R1 + R2 - d, difference = R1 - R2;
    const double lens =
        std::numbers::pi * depth * depth * (d * d + 2 * d * (R1 + R2) - 3 * difference * difference) / (12 * d);
    return lens / (4 * std::numbers::pi / 3 * small * small * small);
}

}  // namespace

Overlaps overlaps(const FluidConfig& c, const std::vector<Solid>& solids)
{
    std::array<bool, 3> periodic;
    for (int d = 0; d < 3; ++d) periodic[d] = c.faces[2 * d].type == FaceType::periodic;
    std::vector<const Solid*> spheres;
    std::vector<Vec3> centres;  // [cells]
    double largest = 0;
    for (const Solid& s : solids) {
        if (s.shape != Shape::sphere) continue;
        Vec3 centre;
        bool inside = true;
        for (int d = 0; d < 3; ++d) {
            const int n = c.cells[d];
            centre[d] = (s.position[d] - c.lower[d]) / c.dx;
            if (periodic[d]) centre[d] -= n * std::floor(centre[d] / n);
            else inside = inside && centre[d] > -s.radius / c.dx && centre[d] < n + s.radius / c.dx;
        }
        if (!inside) continue;
        spheres.push_back(&s);
        centres.push_back(centre);
        largest = std::max(largest, s.radius / c.dx);
    }
    Overlaps found{};
    if (spheres.empty()) return found;
    Neighbours neighbours(c.cells, periodic);
    neighbours.sort(centres, 2 * largest);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        neighbours.for_near(static_cast<std::int32_t>(i), [&](std::int32_t j, const Vec3& shift) {
            const Solid &one = *spheres[i], &other = *spheres[j];
            if (j <= static_cast<std::int32_t>(i) || (one.body >= 0 && one.body == other.body)) return;
            const double apart = norm(centres[j] + shift - centres[i]);
            const double shared = shared_volume(one.radius / c.dx, other.radius / c.dx, apart);
            if (shared <= kContactOverlap) return;
            ++found.pairs;
            if (shared > found.shared) {
                found.one = one.id;
                found.other = other.id;
                found.shared = shared;
            }
        });
    return found;
}

double union_volume(const std::vector<Solid>& spheres)
{
    if (spheres.empty()) return 0;
    constexpr int kLines = 64;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
    for (const Solid& s : spheres)
        for (int d = 0; d < 2; ++d) {
            low[d] = std::min(low[d], s.position[d] - s.radius);
            high[d] = std::max(high[d], s.position[d] + s.radius);
        }
    double filled = 0;
    std::vector<std::pair<double, double>> chords;  // of one line
    for (int j = 0; j < kLines; ++j)
        for (int i = 0; i < kLines; ++i) {
            const double x = low[0] + (i + 0.5) / kLines * (high[0] - low[0]);
            const double y = low[1] + (j + 0.5) / kLines * (high[1] - low[1]);
            chords.clear();
            for (const Solid& s : spheres) {
                const double dx = x - s.position[0], dy = y - s.position[1];
                const double half2 = s.radius * s.radius - dx * dx - dy * dy;
                if (half2 <= 0) continue;
                const double half = std::sqrt(half2);
                chords.emplace_back(s.position[2] - half, s.position[2] + half);
            }
            std::sort(chords.begin(), chords.end());
            double end = -kInfinity;
            for (const auto& [from, to] : chords) {
                filled += std::max(0.0, to - std::max(from, end));
                end = std::max(end, to);
            }
        }
    return filled * (high[0] - low[0]) * (high[1] - low[1]) / (kLines * kLines);
}

}  // namespace lbm
