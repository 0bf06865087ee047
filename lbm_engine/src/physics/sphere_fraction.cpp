#include "physics/sphere_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lbm {
namespace {

constexpr double kPi = std::numbers::pi;

/// Fractions this close to 0 or 1 are round-off of differences of volumes of order R^3.
constexpr double kRoundOffOfVolumes = 1e-13;

}  // namespace

const double* SphereFraction::row(int j, int k) const noexcept
{
    return fraction_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
}

void SphereFraction::evaluate(const Vec3& centre, double R)
{
    const SphereKernels& kernels = sphere_kernels();
    centre_ = centre;
    R_ = R;
    const double octant = kPi * R * R * R / 6;
    for (int d = 0; d < 3; ++d) {
        first_[d] = static_cast<int>(std::floor(centre[d] - R));
        count_[d] = static_cast<int>(std::ceil(centre[d] + R)) - first_[d];
        // Lines are padded to whole packs with planes that touch the sphere from outside.
        const std::size_t padded = padded_to_packs(count_[d] + 1);
        for (PackedNumbers* const numbers : {&plane_[d], &cap_[d], &moment_[d]}) numbers->reserve(padded);
        for (std::size_t i = 0; i < padded; ++i) {
            const double at = std::clamp(first_[d] + static_cast<double>(i) - centre[d], -R, R), a = std::abs(at);
            plane_[d][i] = at;
            moment_[d][i] = 0.5 * a * (R * R - a * a / 3);
            cap_[d][i] = octant - 0.5 * kPi * moment_[d][i];
        }
    }
    const auto tabulate = [&](int p, int q, PackedNumbers& table) {
        const std::size_t line = padded_to_packs(count_[p] + 1);
        const int lines = count_[q] + 1;
        table.reserve(line * lines);
        kernels.pair_table(planes(p), line, planes(q), lines, R, table.data());
    };
    tabulate(0, 1, pairs_[0]);
    tabulate(1, 2, pairs_[1]);
    tabulate(0, 2, pairs_[2]);

    const int ny = count_[1], nz = count_[2];
    const std::size_t mx = padded_to_packs(count_[0] + 1), my = padded_to_packs(count_[1] + 1);
    line_ = mx;
    const std::size_t plane_size = mx * ny;
    along_y_.reserve(plane_size);
    mixed_.reserve(plane_size + kPack);
    fraction_.reserve(plane_size * nz + mx);
    rest_.reserve(ny + 1);
    const double small = kRoundOffOfVolumes * std::max(1.0, R * R * R);
    for (int k = 0; k <= nz; ++k) {
        for (int j = 0; j <= ny; ++j) rest_[j] = octant - cap_[1][j] - cap_[2][k] + pairs_[1][k * my + j];
        kernels.fractions({plane_[0].data(), plane_[1].data(), cap_[0].data(), pairs_[0].data(),
                           pairs_[2].data() + k * mx, rest_.data(), mx, ny + 1, plane_[2][k], R},
                          along_y_.data(), mixed_.data(), small,
                          k > 0 ? fraction_.data() + (k - 1) * plane_size : nullptr);
    }
    find_ends();
}

void SphereFraction::find_ends()
{
    for (int d = 1; d < 3; ++d) {
        PackedNumbers &near2 = near2_[d - 1], &far2 = far2_[d - 1];
        near2.reserve(count_[d]);
        far2.reserve(count_[d]);
        for (int i = 0; i < count_[d]; ++i) {
            const double low = first_[d] + i - centre_[d], high = low + 1;
            const double nearest = std::max({low, -high, 0.0}), farthest = std::max(-low, high);
            near2[i] = nearest * nearest;
            far2[i] = farthest * farthest;
        }
    }
    ends_.resize(static_cast<std::size_t>(count_[1]) * count_[2] + kPack);
    for (int k = 0; k < count_[2]; ++k)
        sphere_kernels().ends({near2_[0].data(), far2_[0].data(), count_[1], centre_[0] - first_[0], count_[0],
                               R_ * R_ - near2_[1][k], R_ * R_ - far2_[1][k]},
                              ends_.data() + static_cast<std::size_t>(k) * count_[1]);
}

}  // namespace lbm
