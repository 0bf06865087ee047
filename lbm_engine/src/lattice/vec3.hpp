#pragma once

#include "lbm/solid.hpp"

#include <cmath>

namespace lbm {

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator-(const Vec3& a) { return {-a[0], -a[1], -a[2]}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Vec3& operator+=(Vec3& a, const Vec3& b) { return a = a + b; }
inline Vec3& operator-=(Vec3& a, const Vec3& b) { return a = a - b; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline bool is_finite(const Vec3& a) { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }

/// The axes of a body turned by a unit quaternion (w, x, y, z).
inline Mat3 rotated_axes(const std::array<double, 4>& q)
{
    const auto [w, x, y, z] = q;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
             {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
             {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

/// Half of the extent of a box with these axes along the lattice's axis d.
inline double half_reach(const Mat3& axes, const Vec3& half_extents, int d)
{
    double half = 0;
    for (int a = 0; a < 3; ++a) half += std::abs(axes[a][d]) * half_extents[a];
    return half;
}

inline bool is_along_axes(const Mat3& axes)
{
    for (const Vec3& e : axes)
        for (const double component : e)
            if (std::abs(component) > 1e-9 && std::abs(std::abs(component) - 1) > 1e-9) return false;
    return true;
}

}  // namespace lbm
