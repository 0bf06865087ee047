// What takes time when spheres are mapped, compiled once per instruction set: define LBM_ISA (a namespace) before including.

#include "lattice/pack.hpp"
#include "physics/sphere_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lbm::LBM_ISA {
namespace {

constexpr int kWidth = kPack;
using V = Pack<kWidth>;
constexpr V kLanes{0, 1, 2, 3, 4, 5, 6, 7};

/// Packs that go through each step of a longer calculation together: one after the other they would wait for roots and divisions.
constexpr std::size_t kTogether = 4;
static_assert(kPore == kTogether * kPack);

[[gnu::always_inline]] inline V read(const double* p) { return load<kWidth>(p); }
[[gnu::always_inline]] inline void write(double* p, const V& v) { store<kWidth>(p, v); }
[[gnu::always_inline]] inline V all(double x) { return V{} + x; }

/**
 * atan2(y, x) for x, y >= 0, not both 0: a reduction to t = numerator / denominator with |t| <= tan(pi/16), after which it is base + t fit(t^2), the fit of atan(t)/t
 * by Chebyshev having an error of 1e-17. Numerator and base of several angles are found before one division for all of them.
 */
struct Angle {
    V numerator, denominator, base;

    [[gnu::always_inline]] Angle(const V& y, const V& x)
    {
        constexpr double kPi = std::numbers::pi, kTanPi16 = 0.19891236737965800691, kTanPi8 = 0.41421356237309504880,
                         kTan3Pi16 = 0.66817863791929892;
        const auto steep = x < y;
        const V low = steep ? x : y, high = steep ? y : x;
        const auto wide = low > kTanPi8 * high;
        const V slope = wide ? all(kTan3Pi16) : all(kTanPi16), middle = wide ? all(3 * kPi / 16) : all(kPi / 16),
                rest = low - slope * high;
        numerator = steep ? -rest : rest;
        denominator = high + slope * low;
        base = steep ? kPi / 2 - middle : middle;
    }
};

[[gnu::always_inline]] inline V angle(const V& base, const V& t)
{
    constexpr double c[] = {0.99999999999999999062,  -0.33333333333330299065, 0.19999999998387275065,
                            -0.14285713958739706176, 0.11111078496327897636,  -0.090891371726965427083,
                            0.076386686308716971202, -0.058090914088185393799};
    const V z = t * t, z2 = z * z, z4 = z2 * z2;
    const V low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2, high = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2;
    return base + t * (low + high * z4);
}

void pair_table(const SpherePlanes& p, std::size_t line, const SpherePlanes& q, int lines, double R,
                double* table) noexcept
{
    constexpr double kNearlyNothing = 1e-100;  // instead of 0 where the pair does not meet the sphere
    const double whole = std::numbers::pi / 6 * R * R * R, R3 = R * R * R / 3, third = 1.0 / 3;
    struct Pair {
        double w2[kPack], w[kPack];
        V base[3], t[3];
    };
    Pair pairs[kTogether];
    const std::size_t packs = line / kPack, count = packs * lines;
    for (std::size_t first = 0; first < count; first += kTogether) {
        const std::size_t end = std::min(first + kTogether, count);
        for (std::size_t n = first; n < end; ++n) {
            Pair& pair = pairs[n - first];
            const double b = q.at[n / packs], rest2 = R * R - b * b;
            const double* const a = p.at + n % packs * kPack;
            for (std::size_t l = 0; l < kPack; ++l) pair.w2[l] = rest2 - a[l] * a[l];
            for (std::size_t l = 0; l < kPack; ++l)
                pair.w[l] = std::sqrt(pair.w2[l] > kNearlyNothing ? pair.w2[l] : kNearlyNothing);
        }
        for (std::size_t n = first; n < end; ++n) {
            Pair& pair = pairs[n - first];
            const V x = read(p.at + n % packs * kPack), a = x < 0 ? -x : x, b = all(std::abs(q.at[n / packs])),
                    w = read(pair.w);
            const Angle A(w, b), B(w, a), C(a * b, R * w);
            const V AB = A.denominator * B.denominator, inverse = 1 / (AB * C.denominator),
                    of_AB = C.denominator * inverse;
            pair.base[0] = A.base;
            pair.base[1] = B.base;
            pair.base[2] = C.base;
            pair.t[0] = A.numerator * (B.denominator * of_AB);
            pair.t[1] = B.numerator * (A.denominator * of_AB);
            pair.t[2] = C.numerator * (AB * inverse);
        }
        for (std::size_t n = first; n < end; ++n) {
            const Pair& pair = pairs[n - first];
            const std::size_t i = n % packs * kPack, j = n / packs;
            const V x = read(p.at + i), abw = (x < 0 ? -x : x) * std::abs(q.at[j]) * read(pair.w);
            const V at_a = angle(pair.base[0], pair.t[0]), at_b = angle(pair.base[1], pair.t[1]),
                    at_c = angle(pair.base[2], pair.t[2]);
            const V volume = (whole - (read(p.moment + i) * at_a + q.moment[j] * at_b)) + (third * abw - R3 * at_c);
            write(table + n * kPack, read(pair.w2) > 0 ? volume : V{});
        }
    }
}

void fractions(const CornerPlane& corners, double* along_y, double* mixed, double small, double* fraction) noexcept
{
    const CornerPlane plane = corners;  // which no store can change
    const double rest2_z = plane.R * plane.R - plane.z * plane.z;
    for (std::size_t i = 0; i < plane.line; i += kWidth) {
        const V x = read(plane.x + i), x2 = x * x, sign_x = x < 0 ? all(-1) : all(1),
                of_x = read(plane.xz + i) - read(plane.cap + i);
        const auto volume = [&](int j) __attribute__((always_inline))
        {
            const double y = plane.y[j], area = y * plane.z, rest2 = rest2_z - y * y;
            const V outside =
                (std::copysign(1.0, area) * sign_x) * ((plane.rest[j] + of_x) + read(plane.xy + j * plane.line + i));
            return x2 < rest2 ? x * area : outside;
        };
        V before = volume(0);
        for (int j = 1; j < plane.lines; ++j) {
            const std::size_t at = (j - 1) * plane.line + i;
            const V h = volume(j), difference = h - before;
            write(mixed + at, difference - read(along_y + at));
            write(along_y + at, difference);
            before = h;
        }
    }
    if (!fraction) return;
    const std::size_t count = (plane.lines - 1) * plane.line;
    for (std::size_t i = 0; i < count; i += kWidth) {
        const V volume = read(mixed + i + 1) - read(mixed + i), one = all(1);
        write(fraction + i, volume < small ? V{} : volume > 1 - small ? one : volume);
    }
}

void ends(const PlaneOfRows& rows, RowEnds* ends) noexcept
{
    const int cells = rows.cells;
    const double x = rows.x;
    for (int j = 0; j < static_cast<int>(padded_to_packs(rows.count)); ++j) {
        const double out2 = rows.out2 - rows.near2[j], in2 = rows.inside2 - rows.far2[j];
        const double out = std::sqrt(out2 > 0 ? out2 : 0), in = std::sqrt(in2 > 0 ? in2 : 0);
        // Conversion of what is not negative rounds down; n minus that of n minus it, up.
        const int begin = static_cast<int>(x - out), end = cells - static_cast<int>(cells - (x + out));
        const int full_begin = cells - static_cast<int>(cells - (x - in)), full_end = static_cast<int>(x + in);
        const bool touches = out2 > 0, fills = full_begin < full_end;
        ends[j] = {touches ? begin : 0, touches ? (fills ? full_begin : end) : 0,
                   touches ? (fills ? full_end : end) : 0, touches ? end : 0};
    }
}

void gather(const CutRow* row, const CutRow* end, double* fraction, float* x, float* y, float* z) noexcept
{
    for (; row != end; ++row) {
        const V y0 = all(row->first[1]), z0 = all(row->first[2]);
        const auto copy = [&](const double* from, double x0, int count) __attribute__((always_inline))
        {
            int i = 0;
            do {  // at least one pack, so that no branch has to be foreseen; what follows begins where the cells end
                store<kWidth>(fraction + i, read(from + i));
                store<kWidth>(x + i, (x0 + i) + kLanes);
                store<kWidth>(y + i, y0);
                store<kWidth>(z + i, z0);
                i += kWidth;
            } while (i < count);
            fraction += count;
            x += count;
            y += count;
            z += count;
        };
        const int skip = row->before + row->full;
        copy(row->fractions, row->first[0], row->before);
        copy(row->fractions + skip, row->first[0] + skip, row->after);
    }
}

void narrow(const PoreShape& shape, const float* xs, const float* ys, const float* zs, std::size_t count,
            float* thickening) noexcept
{
    constexpr int kFloats = 2 * kWidth, kRegisters = kPore / kFloats;
    using F = Pack<kFloats, float>;
    const PoreShape pore = shape;  // which no store can change
    const F zero{}, one = zero + 1;
    for (std::size_t i = 0; i < count; i += kPore) {
        F h[kRegisters], along[kRegisters], r2[kRegisters], t[kRegisters];
        const auto each = [&](auto&& step) __attribute__((always_inline))
        {
#pragma GCC unroll 4
            for (std::size_t n = 0; n < kRegisters; ++n) step(n, i + n * kFloats);
        };
        const auto read_floats = [](const float* p) __attribute__((always_inline)) { return load<kFloats, float>(p); };
        each([&](std::size_t n, std::size_t at) __attribute__((always_inline)) {
            const F x = read_floats(xs + at), y = read_floats(ys + at), z = read_floats(zs + at);
            r2[n] = x * x + y * y + z * z;
            along[n] = x * pore.towards[0] + y * pore.towards[1] + z * pore.towards[2];
        });
        each([&](std::size_t n, std::size_t) __attribute__((always_inline)) {
            const F width = pore.curvature * r2[n] - along[n] + pore.distance;
            h[n] = width > 0 ? width : zero;
            t[n] = (pore.near + pore.far * h[n]) * h[n] / (1 + h[n] * h[n] * h[n]);
        });
        each([&](std::size_t n, std::size_t at) __attribute__((always_inline)) {
            const F wide = h[n] * pore.over_widest, narrow = 1 - wide * wide, in_reach = narrow > 0 ? narrow : zero;
            const F facing = pore.facing * (along[n] - pore.curvature2 * r2[n]);  // -C r.s / (R1 R2)
            const F asked = t[n] * in_reach * (facing < 1 ? facing : one);
            const F at_surface = r2[n] >= pore.inner2 ? asked : zero;  // not where parts of a body overlap
            const F before = read_floats(thickening + at);
            store<kFloats, float>(thickening + at, at_surface > before ? at_surface : before);
        });
    }
}

void thicken(const float* thickening, std::size_t count, double* fraction) noexcept
{
    for (std::size_t i = 0; i < count; i += kWidth) {
        const V eps = read(fraction + i), m = 1 - eps;
        store<kWidth>(fraction + i, eps + load<kWidth>(thickening + i) * (eps * m) * (m * m));
    }
}

}  // namespace

extern const SphereKernels kSphereKernels;
const SphereKernels kSphereKernels{pair_table, fractions, ends, gather, narrow, thicken};

}  // namespace lbm::LBM_ISA
