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
 * atan2(y, x) for x, y >= 0 (0 where both are) in two steps, between which divisions of several angles can be taken together: a reduction to t = numerator / denominator with
 * |t| <= tan(pi/8), and a Chebyshev fit of atan(t)/t in t^2 with an error of 4e-17. Without branches, so that loops over it vectorise; the library's function does not.
 */
struct Angle {
    bool steep, wide;
    double numerator, denominator;

    [[gnu::always_inline]] Angle(double y, double x) : steep(x < y)
    {
        constexpr double kTanPi8 = 0.41421356237309504880;
        const double low = steep ? x : y, high = steep ? y : x;
        wide = low > kTanPi8 * high;
        numerator = wide ? low - high : low;
        denominator = wide ? low + high : high;
        denominator = denominator > 0 ? denominator : 1;
    }
    [[gnu::always_inline]] double value(double t) const
    {
        constexpr double kFit[] = {0.9999999999999999653,   -0.3333333333332843857,  0.1999999999885511013,
                                   -0.1428571418097646683,  0.1111110618045594522,   -0.0909077307480841379,
                                   0.07689953496306857756,  -0.06640233930429408589, 0.05688349226809010479,
                                   -0.04348052215716462478, 0.02113537315769324521};
        const double z = t * t;
        double fit = kFit[10];
        for (int i = 9; i >= 0; --i) fit = fit * z + kFit[i];
        const double octant = (wide ? kPi / 4 : 0) + t * fit;
        return steep ? kPi / 2 - octant : octant;
    }
};

/// Volume of the part of a sphere of radius R with x > a >= 0, y > b >= 0, z > 0.
[[gnu::always_inline]] inline double quadrant_volume(double a, double b, double R)
{
    const double w2 = R * R - a * a - b * b;
    const double w = std::sqrt(w2 > 0 ? w2 : 0);
    const double Qa = a * (R * R - a * a / 3), Qb = b * (R * R - b * b / 3);
    const double R3 = R * R * R;
    const Angle A(w, b), B(w, a), C(a * b, R * w);
    const double AB = A.denominator * B.denominator, inverse = 1 / (AB * C.denominator);
    const double at_a = A.value(A.numerator * (B.denominator * C.denominator * inverse));
    const double at_b = B.value(B.numerator * (A.denominator * C.denominator * inverse));
    const double at_c = C.value(C.numerator * (AB * inverse));
    const double volume = 0.5 * (kPi * R3 / 3 - Qa * at_a - Qb * at_b + (2.0 / 3) * a * b * w - (2.0 / 3) * R3 * at_c);
    return w2 > 0 ? volume : 0;
}

/// Lines of whole vectors need no loop for the rest.
std::size_t padded(int count) { return (static_cast<std::size_t>(count) + 7) / 8 * 8; }

double half_cap_volume(double a, double R) { return kPi * (R * R * R / 6 - 0.25 * a * (R * R - a * a / 3)); }

/// G2 of pairs of planes p (a line) and q (one line for each).
LBM_EACH_ISA
void pair_table(const double* p, std::size_t line, const double* q, int lines, double R, double* table)
{
    for (int j = 0; j < lines; ++j)
        for (std::size_t i = 0; i < line; ++i) table[j * line + i] = quadrant_volume(std::abs(p[i]), std::abs(q[j]), R);
}

/// Corners of cells in a plane z: lines along x, at all y.
struct CornerPlane {
    const double *x, *y, *g1x;  ///< planes, and G2(|x|, 0)
    const double *xy, *xz;      ///< G2 of these, and of x and z
    std::size_t line;           ///< corners in a line, with padding
    int lines;
    double z, R;
};

/// H at the corners. @param yz  G2(0, 0) - G2(y, 0) - G2(0, z) + G2(y, z), for each line
LBM_EACH_ISA
void corners(const CornerPlane& plane, const double* yz, double* h)
{
    for (int j = 0; j < plane.lines; ++j) {
        const double y = plane.y[j], area = y * plane.z, rest2 = plane.R * plane.R - y * y - plane.z * plane.z;
        const double sign_yz = std::copysign(1.0, y) * std::copysign(1.0, plane.z), of_yz = yz[j];
        const double* const xy = plane.xy + j * plane.line;
#pragma GCC ivdep
        for (std::size_t i = 0; i < plane.line; ++i) {
            const double x = plane.x[i];
            const double outside = std::copysign(1.0, x) * sign_yz * (of_yz - plane.g1x[i] + xy[i] + plane.xz[i]);
            h[j * plane.line + i] = x * x < rest2 ? x * area : outside;
        }
    }
}

/// Mixed differences of H along y and z. @param along_y  between lines of the plane below; become those of this one
LBM_EACH_ISA
void differences_of_lines(const double* h, std::size_t line, std::size_t count, double* along_y, double* mixed)
{
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
        const double difference = h[i + line] - h[i];
        mixed[i] = difference - along_y[i];
        along_y[i] = difference;
    }
}

/// Fractions of cells from mixed differences at their corners along x; `small` is round-off.
LBM_EACH_ISA
void differences_along_lines(const double* mixed, std::size_t count, double small, double* fraction)
{
    for (std::size_t i = 0; i < count; ++i) {
        const double volume = mixed[i + 1] - mixed[i];
        fraction[i] = volume < small ? 0 : volume > 1 - small ? 1 : volume;
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
    const auto tabulate = [R](const std::vector<double>& p, const std::vector<double>& q, int lines,
                              std::vector<double>& table) {
        table.resize(p.size() * lines);
        pair_table(p.data(), p.size(), q.data(), lines, R, table.data());
    };
    tabulate(x, y, count_[1] + 1, g2_[0]);
    tabulate(y, z, count_[2] + 1, g2_[1]);
    tabulate(x, z, count_[2] + 1, g2_[2]);

    const int ny = count_[1], nz = count_[2];
    const std::size_t mx = x.size(), my = y.size();
    line_ = mx;
    const std::size_t plane_size = mx * ny;
    corner_.resize(plane_size + mx);
    along_y_.resize(plane_size);
    mixed_.resize(plane_size + 1);  // differences read one beyond the padding
    fraction_.resize(plane_size * nz);
    yz_.resize(ny + 1);
    const double g0 = kPi * R * R * R / 6, small = kRoundOffOfVolumes * std::max(1.0, R * R * R);
    for (int k = 0; k <= nz; ++k) {
        for (int j = 0; j <= ny; ++j) yz_[j] = g0 - g1_[1][j] - g1_[2][k] + g2_[1][k * my + j];
        corners({x.data(), y.data(), g1_[0].data(), g2_[0].data(), g2_[2].data() + k * mx, mx, ny + 1, z[k], R},
                yz_.data(), corner_.data());
        differences_of_lines(corner_.data(), mx, plane_size, along_y_.data(), mixed_.data());
        if (k > 0) differences_along_lines(mixed_.data(), plane_size, small, fraction_.data() + (k - 1) * plane_size);
    }
}

}  // namespace lbm
