#include "physics/sphere_fraction.hpp"

#include "lattice/each_isa.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lbm {
namespace {

constexpr double kPi = std::numbers::pi;

/// Fractions this close to 0 or 1 are round-off of differences of volumes of order R^3.
constexpr double kRoundOffOfVolumes = 1e-13;

/**
 * atan2(y, x) for x, y >= 0 (0 where both are): a reduction to |t| <= tan(pi/8) and a Chebyshev fit of atan(t)/t in t^2 with an
 * error of 4e-17. Without branches, so that loops over it vectorise; the library's function does not.
 */
[[gnu::always_inline]] inline double angle(double y, double x)
{
    constexpr double kTanPi8 = 0.41421356237309504880;
    constexpr double kFit[] = {0.9999999999999999653,   -0.3333333333332843857,  0.1999999999885511013,
                               -0.1428571418097646683,  0.1111110618045594522,   -0.0909077307480841379,
                               0.07689953496306857756,  -0.06640233930429408589, 0.05688349226809010479,
                               -0.04348052215716462478, 0.02113537315769324521};
    const double low = x < y ? x : y, high = x < y ? y : x;
    const bool wide = low > kTanPi8 * high;
    const double numerator = wide ? low - high : low;
    const double denominator = wide ? low + high : high;
    const double t = numerator / (denominator > 0 ? denominator : 1);
    const double z = t * t;
    double fit = kFit[10];
    for (int i = 9; i >= 0; --i) fit = fit * z + kFit[i];
    const double octant = (wide ? kPi / 4 : 0) + t * fit;
    return x < y ? kPi / 2 - octant : octant;
}

/// Volume of the part of a sphere of radius R with x > a >= 0, y > b >= 0, z > 0.
[[gnu::always_inline]] inline double quadrant_volume(double a, double b, double R)
{
    const double w2 = R * R - a * a - b * b;
    const double w = std::sqrt(w2 > 0 ? w2 : 0);
    const double Qa = a * (R * R - a * a / 3), Qb = b * (R * R - b * b / 3);
    const double R3 = R * R * R;
    const double volume = 0.5 * (kPi * R3 / 3 - Qa * angle(w, b) - Qb * angle(w, a) + (2.0 / 3) * a * b * w -
                                 (2.0 / 3) * R3 * angle(a * b, R * w));
    return w2 > 0 ? volume : 0;
}

/// Lines of whole vectors need no loop for the rest.
std::size_t padded(int count) { return (static_cast<std::size_t>(count) + 7) / 8 * 8; }

double half_cap_volume(double a, double R) { return kPi * (R * R * R / 6 - 0.25 * a * (R * R - a * a / 3)); }

LBM_EACH_ISA
void pair_row(const double* p, std::size_t count, double q, double R, double* row)
{
    for (std::size_t i = 0; i < count; ++i) row[i] = quadrant_volume(std::abs(p[i]), std::abs(q), R);
}

void pair_table(const std::vector<double>& p, const std::vector<double>& q, int rows, double R,
                std::vector<double>& table)
{
    table.resize(p.size() * rows);
    for (int j = 0; j < rows; ++j) pair_row(p.data(), p.size(), q[j], R, table.data() + j * p.size());
}

/// H at the corners of one line along x.
LBM_EACH_ISA
void corner_line(const double* x, const double* g1x, const double* xy, const double* xz, std::size_t count, double yz,
                 double area, double sign_yz, double rest2, double* h)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double outside = std::copysign(1.0, x[i]) * sign_yz * (yz - g1x[i] + xy[i] + xz[i]);
        h[i] = x[i] * x[i] < rest2 ? x[i] * area : outside;
    }
}

/// Fractions of a row of cells from the corners of its four edges; `small` is round-off.
LBM_EACH_ISA
void difference_row(const double* upper, const double* upper_next, const double* lower, const double* lower_next,
                    std::size_t count, double small, double* row)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double above = (upper_next[i + 1] - upper_next[i]) - (upper[i + 1] - upper[i]);
        const double below = (lower_next[i + 1] - lower_next[i]) - (lower[i + 1] - lower[i]);
        const double volume = above - below;
        row[i] = volume < small ? 0 : volume > 1 - small ? 1 : volume;
    }
}

}  // namespace

const double* SphereFraction::row(int j, int k) const noexcept
{
    return fraction_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
}

void SphereFraction::evaluate(const Vec3& centre, double R)
{
    for (int d = 0; d < 3; ++d) {
        first_[d] = static_cast<int>(std::floor(centre[d] - R));
        count_[d] = static_cast<int>(std::ceil(centre[d] + R)) - first_[d];
        // Lines are padded to whole vectors with planes that touch the sphere from outside.
        plane_[d].resize(padded(count_[d] + 1));
        g1_[d].resize(plane_[d].size());
        for (std::size_t i = 0; i < plane_[d].size(); ++i) {
            plane_[d][i] = std::clamp(first_[d] + static_cast<double>(i) - centre[d], -R, R);
            g1_[d][i] = half_cap_volume(std::abs(plane_[d][i]), R);
        }
    }
    const auto& [x, y, z] = plane_;
    pair_table(x, y, count_[1] + 1, R, g2_[0]);
    pair_table(y, z, count_[2] + 1, R, g2_[1]);
    pair_table(x, z, count_[2] + 1, R, g2_[2]);

    const int ny = count_[1], nz = count_[2];
    const std::size_t mx = x.size(), my = y.size();
    line_ = mx;
    corner_.resize(2 * (ny + 1) * mx + 1);  // differences read one beyond the padding
    fraction_.resize(mx * ny * nz);
    const double g0 = kPi * R * R * R / 6;
    const double small = kRoundOffOfVolumes * std::max(1.0, R * R * R);
    for (int k = 0; k <= nz; ++k) {
        double* here = corner_.data() + (k % 2) * (ny + 1) * mx;
        const double* below = corner_.data() + ((k + 1) % 2) * (ny + 1) * mx;
        for (int j = 0; j <= ny; ++j) {
            const double rest2 = R * R - y[j] * y[j] - z[k] * z[k];
            const double yz = g0 - g1_[1][j] - g1_[2][k] + g2_[1][k * my + j];
            const double sign_yz = std::copysign(1.0, y[j]) * std::copysign(1.0, z[k]);
            corner_line(x.data(), g1_[0].data(), g2_[0].data() + j * mx, g2_[2].data() + k * mx, mx, yz, y[j] * z[k],
                        sign_yz, rest2, here + j * mx);
        }
        if (k == 0) continue;
        for (int j = 0; j < ny; ++j)
            difference_row(here + j * mx, here + (j + 1) * mx, below + j * mx, below + (j + 1) * mx, mx, small,
                           fraction_.data() + (static_cast<std::size_t>(k - 1) * ny + j) * mx);
    }
}

}  // namespace lbm
