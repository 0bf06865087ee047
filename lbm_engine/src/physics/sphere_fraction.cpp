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
        constexpr double c[] = {0.9999999999999999653,   -0.3333333333332843857,  0.1999999999885511013,
                                -0.1428571418097646683,  0.1111110618045594522,   -0.0909077307480841379,
                                0.07689953496306857756,  -0.06640233930429408589, 0.05688349226809010479,
                                -0.04348052215716462478, 0.02113537317769324521};
        // By pairs: what limits is how long one angle takes, not how many operations.
        const double z = t * t, z2 = z * z, z4 = z2 * z2;
        const double low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2, mid = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2,
                     high = (c[8] + c[9] * z) + c[10] * z2;
        const double fit = low + (mid + high * z4) * z4;
        const double octant = (wide ? kPi / 4 : 0) + t * fit;
        return steep ? kPi / 2 - octant : octant;
    }
};

/// Volume of the part of a sphere of radius R with x > a >= 0, y > b >= 0, z > 0.
[[gnu::always_inline]] inline double quadrant_volume(double a, double b, double R)
{
    const double w2 = R * R - a * a - b * b;
    const double w = std::sqrt(w2 > 0 ? w2 : 0);
    const double Qa = a * (R * R - (1.0 / 3) * (a * a)), Qb = b * (R * R - (1.0 / 3) * (b * b));
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
constexpr std::size_t kVector = 8;
std::size_t padded(int count) { return (static_cast<std::size_t>(count) + kVector - 1) / kVector * kVector; }

double half_cap_volume(double a, double R) { return kPi * (R * R * R / 6 - 0.25 * a * (R * R - a * a / 3)); }

/// G2 of pairs of planes p (a line) and q (one line for each).
LBM_EACH_ISA
void pair_table(const double* p, std::size_t line, const double* q, int lines, double R, double* table)
{
    line &= ~(kVector - 1);
    for (int j = 0; j < lines; ++j)
#pragma GCC ivdep
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

/**
 * Where rows of a plane meet the sphere: their ends, by the nearest and the farthest points of their cells along y and z.
 * @param x     of the centre, from the first cell on
 * @param rest2, inner2  R^2 without what the plane's nearest and farthest points along z take
 */
LBM_EACH_ISA
void ends_of_rows(const double* near2, const double* far2, int lines, double x, int cells, double rest2, double inner2,
                  RowEnds* ends)
{
    for (int j = 0; j < lines; ++j) {
        const double out2 = rest2 - near2[j], in2 = inner2 - far2[j];
        const double out = std::sqrt(out2 > 0 ? out2 : 0), in = std::sqrt(in2 > 0 ? in2 : 0);
        // Conversion of what is not negative rounds down; n minus that of n minus it, up.
        const int begin = static_cast<int>(x - out), end = cells - static_cast<int>(cells - (x + out));
        const int full_begin = cells - static_cast<int>(cells - (x - in)), full_end = static_cast<int>(x + in);
        const bool touches = out2 > 0, fills = full_begin < full_end;
        ends[j] = {touches ? begin : 0, touches ? (fills ? full_begin : end) : 0,
                   touches ? (fills ? full_end : end) : 0, touches ? end : 0};
    }
}

}  // namespace

const double* SphereFraction::row(int j, int k) const noexcept
{
    return fraction_.data() + (static_cast<std::size_t>(k) * count_[1] + j) * line_;
}

void SphereFraction::evaluate(const Vec3& centre, double R)
{
    centre_ = centre;
    R_ = R;
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
    fraction_.resize(plane_size * nz + mx);
    yz_.resize(ny + 1);
    const double g0 = kPi * R * R * R / 6, small = kRoundOffOfVolumes * std::max(1.0, R * R * R);
    for (int k = 0; k <= nz; ++k) {
        for (int j = 0; j <= ny; ++j) yz_[j] = g0 - g1_[1][j] - g1_[2][k] + g2_[1][k * my + j];
        corners({x.data(), y.data(), g1_[0].data(), g2_[0].data(), g2_[2].data() + k * mx, mx, ny + 1, z[k], R},
                yz_.data(), corner_.data());
        differences_of_lines(corner_.data(), mx, plane_size, along_y_.data(), mixed_.data());
        if (k > 0) differences_along_lines(mixed_.data(), plane_size, small, fraction_.data() + (k - 1) * plane_size);
    }
    find_ends();
}

void SphereFraction::find_ends()
{
    for (int d = 1; d < 3; ++d) {
        std::vector<double>&near2 = near2_[d - 1], &far2 = far2_[d - 1];
        near2.resize(count_[d]);
        far2.resize(count_[d]);
        for (int i = 0; i < count_[d]; ++i) {
            const double low = first_[d] + i - centre_[d], high = low + 1;
            const double nearest = std::max({low, -high, 0.0}), farthest = std::max(-low, high);
            near2[i] = nearest * nearest;
            far2[i] = farthest * farthest;
        }
    }
    ends_.resize(static_cast<std::size_t>(count_[1]) * count_[2]);
    for (int k = 0; k < count_[2]; ++k)
        ends_of_rows(near2_[0].data(), far2_[0].data(), count_[1], centre_[0] - first_[0], count_[0],
                     R_ * R_ - near2_[1][k], R_ * R_ - far2_[1][k],
                     ends_.data() + static_cast<std::size_t>(k) * count_[1]);
}

}  // namespace lbm
