#include "physics/sphere_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lbm {
namespace {

constexpr double kPi = std::numbers::pi;

/// Fractions this close to 0 or 1 are round-off of differences of volumes of order R^3.
constexpr double kRoundOffOfVolumes = 1e-13;

/// Volume of the part of a sphere of radius R with x > a >= 0, y > b >= 0, z > 0.
double quadrant_volume(double a, double b, double R)
{
    const double w2 = R * R - a * a - b * b;
    if (w2 <= 0) return 0;
    const double w = std::sqrt(w2);
    const auto Q = [R](double t) { return t * (R * R - t * t / 3); };
    const double R3 = R * R * R;
    return 0.5 * (kPi * R3 / 3 - Q(a) * std::atan2(w, b) - Q(b) * std::atan2(w, a) + (2.0 / 3) * a * b * w -
                  (2.0 / 3) * R3 * std::atan2(a * b, R * w));
}

double half_cap_volume(double a, double R) { return kPi * (R * R * R / 6 - 0.25 * a * (R * R - a * a / 3)); }

void pair_table(const std::vector<double>& p, const std::vector<double>& q, double R, std::vector<double>& table)
{
    table.resize(p.size() * q.size());
    for (std::size_t j = 0; j < q.size(); ++j)
        for (std::size_t i = 0; i < p.size(); ++i)
            table[j * p.size() + i] = quadrant_volume(std::abs(p[i]), std::abs(q[j]), R);
}

}  // namespace

const double* SphereFraction::row(int j, int k) const noexcept
{
    return fraction_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * count_[0];
}

void SphereFraction::evaluate(const Vec3& centre, double R)
{
    for (int d = 0; d < 3; ++d) {
        first_[d] = static_cast<int>(std::floor(centre[d] - R));
        count_[d] = static_cast<int>(std::ceil(centre[d] + R)) - first_[d];
        plane_[d].resize(count_[d] + 1);
        g1_[d].resize(count_[d] + 1);
        for (int i = 0; i <= count_[d]; ++i) {
            plane_[d][i] = std::clamp(first_[d] + i - centre[d], -R, R);
            g1_[d][i] = half_cap_volume(std::abs(plane_[d][i]), R);
        }
    }
    const auto& [x, y, z] = plane_;
    pair_table(x, y, R, g2_[0]);
    pair_table(y, z, R, g2_[1]);
    pair_table(x, z, R, g2_[2]);

    const int nx = count_[0], ny = count_[1], nz = count_[2];
    const std::size_t mx = nx + 1, my = ny + 1;
    corner_.resize(2 * my * mx);
    fraction_.resize(static_cast<std::size_t>(nx) * ny * nz);
    const double g0 = kPi * R * R * R / 6;
    for (int k = 0; k <= nz; ++k) {
        double* here = corner_.data() + (k % 2) * my * mx;
        const double* below = corner_.data() + ((k + 1) % 2) * my * mx;
        for (int j = 0; j <= ny; ++j) {
            const double rest2 = R * R - y[j] * y[j] - z[k] * z[k];
            const double yz = g0 - g1_[1][j] - g1_[2][k] + g2_[1][k * my + j];
            const double sign_yz = std::copysign(1.0, y[j]) * std::copysign(1.0, z[k]);
            const double* xy = g2_[0].data() + j * mx;
            const double* xz = g2_[2].data() + k * mx;
            for (int i = 0; i <= nx; ++i) {
                const double outside = std::copysign(sign_yz, sign_yz * x[i]) * (yz - g1_[0][i] + xy[i] + xz[i]);
                here[j * mx + i] = x[i] * x[i] < rest2 ? x[i] * y[j] * z[k] : outside;
            }
        }
        if (k == 0) continue;
        for (int j = 0; j < ny; ++j) {
            const double* a = here + j * mx;
            const double* b = below + j * mx;
            double* row = fraction_.data() + (static_cast<std::size_t>(k - 1) * ny + j) * nx;
            const double small = kRoundOffOfVolumes * std::max(1.0, R * R * R);
            for (int i = 0; i < nx; ++i) {
                const double upper = (a[mx + i + 1] - a[mx + i]) - (a[i + 1] - a[i]);
                const double lower = (b[mx + i + 1] - b[mx + i]) - (b[i + 1] - b[i]);
                const double volume = upper - lower;
                row[i] = volume < small ? 0 : volume > 1 - small ? 1 : volume;
            }
        }
    }
}

}  // namespace lbm
