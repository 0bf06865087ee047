#pragma once

#include "lbm/fluid_config.hpp"
#include "physics/rates.hpp"

#include <type_traits>
#include <utility>

namespace lbm {

/// The kind of number in a vector V, or V itself.
template <class V>
struct ScalarOf {
    using type = std::remove_cvref_t<decltype(V{}[0])>;
};
template <>
struct ScalarOf<double> {
    using type = double;
};
template <>
struct ScalarOf<float> {
    using type = float;
};
template <class V>
using Scalar = typename ScalarOf<V>::type;

/**
 * The collision of one cell, or of as many cells side by side as `V` has lanes: V is a number or a vector of them.
 * Populations are deviations from rest, f - w; lattice units with rho_0 = 1.
 */
struct CollisionParameters {
    TrtRates rates;
    double body_force[3];  ///< F = rho_0 * acceleration, in all cells, as the gradient of a pressure would act
    bool low_noise;        ///< parameter set of the weighting
    Scheme scheme = Scheme::exact;
};

/// What the watchdog sees of a cell.
template <class V>
struct Seen {
    V u2;  ///< square of the velocity
    /// (1 - eps) (rho - 1): what fills a solid may be compressed, where that moves into a wall of the box
    V drho;
};

template <class V>
struct Moments {
    V drho;  ///< rho - 1
    V j[3];  ///< sum f c
};

namespace detail {

/// Calls body.template operator()<i, j>() for the pairs of opposite directions i and j.
template <class L, class Body>
[[gnu::always_inline]] inline void for_pairs(Body&& body)
{
    [&]<int... p>(std::integer_sequence<int, p...>) __attribute__((always_inline))
    {
        (body.template operator()<2 * p + 1, 2 * p + 2>(), ...);
    }
    (std::make_integer_sequence<int, L::kPairs>{});
}

/// c[i] . v, without a multiplication.
template <class L, int i, class V>
[[gnu::always_inline]] inline V c_dot(const V (&v)[3])
{
    constexpr const int(&c)[3] = L::c[i];
    constexpr int a = c[0] != 0 ? 0 : c[1] != 0 ? 1 : 2;  // the first axis along which i moves
    V sum = c[a] > 0 ? v[a] : -v[a];
    if constexpr (a < 1 && c[1] > 0) sum += v[1];
    if constexpr (a < 1 && c[1] < 0) sum -= v[1];
    if constexpr (a < 2 && c[2] > 0) sum += v[2];
    if constexpr (a < 2 && c[2] < 0) sum -= v[2];
    return sum;
}

}  // namespace detail

template <class L, class V>
[[gnu::always_inline]] inline Moments<V> moments(const V (&f)[L::Q])
{
    Moments<V> m;
    V sums[3];  // side by side: one long chain of additions would be waited for
    detail::for_pairs<L>([&]<int a, int b>() __attribute__((always_inline)) {
        const V sum = f[a] + f[b], difference = f[a] - f[b];
        if constexpr (a < 6) {
            sums[a / 2] = sum;
            m.j[a / 2] = difference;
            return;
        }
        sums[a / 2 % 3] += sum;
        for (int d = 0; d < 3; ++d) {
            if (L::c[a][d] > 0) m.j[d] += difference;
            if (L::c[a][d] < 0) m.j[d] -= difference;
        }
    });
    m.drho = f[0] + (sums[0] + sums[1] + sums[2]);
    return m;
}

/// The least weight of a lattice. The others, and sums of them, are whole multiples of it.
template <class L>
inline constexpr double kLeastWeight = L::w(L::Q - 1);
template <class L>
constexpr int multiple_of_least(double sum_of_weights)
{
    return static_cast<int>(sum_of_weights / kLeastWeight<L> + 0.5);  // NOLINT(bugprone-incorrect-roundings): constexpr
}

/**
 * The sources of a relaxation. With the least weight w_0 and the trace of (rho u) E / rho, the even ones are w / w_0 (even + (c.rho u) (c.E) / rho) in population i, the odd ones
 * 6 w c.odd.
 */
template <class V>
struct Sources {
    V mass;    ///< that the even ones bring
    V odd[3];  ///< half of the momentum that the odd ones bring
    V even, trace, inverse_rho, rho_u[3], E[3];
};

/**
 * TRT relaxation:
 *
 *     f+ <- (1 - omega+) f+  + even sources
 *     f- <- (1 - omega-) f-  + odd sources
 *
 * With rounded weights the sources would bring a little too much or too little mass and momentum, at each step the same: in 32 bits it would show after 10^5 steps. So the population at
 * rest and those along the axes get what the others leave.
 */
template <class L, bool inertia, class V, class Rate>
[[gnu::always_inline]] inline void relax(V (&f)[L::Q], Scalar<V> keep_even, const Rate& keep_odd, const Sources<V>& s)
{
    using S = Scalar<V>;
    V along_axes[3], others[3];
    for (int d = 0; d < 3; ++d) {
        others[d] = S(6 * kLeastWeight<L>) * s.odd[d];
        along_axes[d] = s.odd[d] - S(multiple_of_least<L>(1.0 / 6 - L::w(1))) * others[d];
    }
    V moving = S(multiple_of_least<L>(1 - L::w(0))) * s.even;
    if constexpr (inertia) moving += S(multiple_of_least<L>(1.0 / 3)) * s.trace;
    f[0] = keep_even * f[0] + (s.mass - moving);
    detail::for_pairs<L>([&]<int a, int b>() __attribute__((always_inline)) {
        // Products with w are the same for many directions, and known before their sums are.
        constexpr S w = multiple_of_least<L>(L::w(a));
        V even = w * s.even;
        if constexpr (inertia) even += (w * s.inverse_rho) * (detail::c_dot<L, a>(s.rho_u) * detail::c_dot<L, a>(s.E));
        const V odd = L::w(a) == L::w(1) ? detail::c_dot<L, a>(along_axes) : w * detail::c_dot<L, a>(others);
        const V new_even = (S(0.5) * keep_even) * (f[a] + f[b]) + even;
        const V new_odd = (S(0.5) * keep_odd) * (f[a] - f[b]) + odd;
        f[a] = new_even + new_odd;
        f[b] = new_even - new_odd;
    });
}

/**
 * The even sources: e+ = w (drho + rho (9/2 (c.u)^2 - 3/2 u^2)) and, with total force F_t, the even Guo term
 * (1 - omega+/2) w (9 (c.u)(c.F_t) - 3 u.F_t). With E = 9/2 omega+ rho u + 9 (1 - omega+/2) F_t they are
 * w (omega+ drho - u.E / 3 + (c.u) (c.E)). Stokes flow keeps omega+ drho only. Nothing but the last step waits for 1 / rho.
 * @see Guo, Zheng & Shi (2002), Phys. Rev. E 65, 046308
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline void add_even_sources(Scalar<V> omega_plus, const V& drho, const V (&total_force)[3],
                                                    Sources<V>& s)
{
    using S = Scalar<V>;
    constexpr S least = kLeastWeight<L>;  // taken into E
    s.mass = omega_plus * drho;
    s.even = (least * omega_plus) * drho;
    if constexpr (inertia) {
        const S a = (S(4.5) * least) * omega_plus, b = (9 * least) * (1 - S(0.5) * omega_plus);
        for (int d = 0; d < 3; ++d) s.E[d] = a * s.rho_u[d] + b * total_force[d];
        s.trace = (s.rho_u[0] * s.E[0] + s.rho_u[1] * s.E[1] + s.rho_u[2] * s.E[2]) * s.inverse_rho;
        s.even -= S(1.0 / 3) * s.trace;
    }
}

template <class V>
[[gnu::always_inline]] inline V u2(const Sources<V>& s)
{
    const V square = s.rho_u[0] * s.rho_u[0] + s.rho_u[1] * s.rho_u[1] + s.rho_u[2] * s.rho_u[2];
    return square * (s.inverse_rho * s.inverse_rho);
}

/**
 * One TRT collision of fluid.
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_fluid(V (&f)[L::Q], const CollisionParameters& p)
{
    using S = Scalar<V>;
    // What is kept and what is not are together 1, exactly.
    const S keep_even = 1 - static_cast<S>(p.rates.omega_plus), keep_odd = 1 - static_cast<S>(p.rates.omega_minus);
    const S omega_plus = 1 - keep_even, omega_minus = 1 - keep_odd;
    const Moments<V> m = moments<L>(f);
    Sources<V> s;
    s.inverse_rho = V{} + S(1);
    if constexpr (inertia) s.inverse_rho = 1 / (1 + m.drho);
    V force[3];
    for (int d = 0; d < 3; ++d) {
        const S F = static_cast<S>(p.body_force[d]);
        s.rho_u[d] = m.j[d] + S(0.5) * F;
        force[d] = V{} + F;
        s.odd[d] = (S(0.5) * omega_minus) * m.j[d] + S(0.5) * F;
    }
    add_even_sources<L, inertia>(omega_plus, m.drho, force, s);
    relax<L, inertia>(f, keep_even, keep_odd, s);
    return {u2(s), m.drho};
}

/// What a partially saturated cell is told about its solids.
template <class V>
struct Saturation {
    V epsilon;   ///< solid fraction, 0 to 1, of the union of the solids
    V strength;  ///< sum of k eps
    V u_s[3];    ///< solid velocity at the cell centre, eps-weighted mean
};

/// What a partially saturated cell tells its solids.
template <class V>
struct Exchange {
    V force[3];     ///< F_s, of the solids on the fluid: the collision adds F + F_s to its momentum
    V momentum[3];  ///< sum f c after the collision
    V weight;       ///< kk rho
};

/// omega-_c = 1 / (Lm lam(eps) + 1/2), with the lam of the parameter set (Weighting).
template <class V>
[[gnu::always_inline]] inline V cell_omega_minus(const CollisionParameters& p, const V& epsilon)
{
    if (!p.low_noise) return V{} + p.rates.omega_minus;
    return 1 / (p.rates.Lm * low_noise_lam(epsilon) + 0.5);
}

/// What its solids make of a cell's collision: known before the populations are.
template <class V>
struct CutCell {
    V epsilon;      ///< solid fraction, 0 to 1
    V kk;           ///< weight of the solid force
    V omega_minus;  ///< omega-_c
    V u_s[3];       ///< solid velocity
};

template <class V>
[[gnu::always_inline]] inline CutCell<V> cut_cell(const CollisionParameters& p, const Saturation<V>& s)
{
    const V m = 1 - s.epsilon;
    const V g = p.low_noise ? low_noise_gain(s.epsilon) : V{} + 1.0;
    const V kLp = p.rates.Lp * s.strength * g;
    const V least = kLeastFluidFraction * g;
    const V kk = kLp / ((m > least ? m : least) + 0.5 * kLp);
    return {s.epsilon, kk, cell_omega_minus(p, s.epsilon), {s.u_s[0], s.u_s[1], s.u_s[2]}};
}

/**
 * One collision of a partially saturated cell, exact in tau for Stokes flow (superposition form, docs/physics.md):
 *
 *     kk   = k g eps Lp / (max(m, 0.02 g) + k g eps Lp / 2),   m = 1 - eps,   g = g(eps)
 *     Lm_c = Lm lam(eps),   omega-_c = 1 / (Lm_c + 1/2)
 *     u    = (sum f c + F / 2) / rho
 *     F_s  = kk rho (u_s - u),   u_phys = u + F_s / (2 rho)
 *
 * @return with u_phys
 * @tparam at_rest  u_s is zero, and not looked at
 */
template <class L, bool inertia, bool at_rest = false, class V>
[[gnu::always_inline]] inline Seen<V> collide_saturated(V (&f)[L::Q], const CollisionParameters& p,
                                                        const CutCell<V>& cell, Exchange<V>& out)
{
    const V m = 1 - cell.epsilon;
    const V kk = cell.kk, omega_minus = cell.omega_minus;
    const Moments<V> mo = moments<L>(f);
    Sources<V> sources;
    V total_force[3];
    V rho = V{} + 1.0;
    sources.inverse_rho = V{} + 1.0;
    if constexpr (inertia) {
        rho = 1 + mo.drho;
        sources.inverse_rho = 1 / rho;
    }
    out.weight = kk * rho;
    for (int d = 0; d < 3; ++d) {
        const double F = p.body_force[d];
        const V momentum = mo.j[d] + 0.5 * F;
        const V F_s = at_rest ? -kk * momentum : kk * (rho * cell.u_s[d] - momentum);
        sources.rho_u[d] = momentum + 0.5 * F_s;
        total_force[d] = F + F_s;
        sources.odd[d] = 0.5 * (omega_minus * mo.j[d] + total_force[d]);
        out.force[d] = F_s;
        out.momentum[d] = mo.j[d] + total_force[d];
    }
    add_even_sources<L, inertia>(p.rates.omega_plus, mo.drho, total_force, sources);
    relax<L, inertia>(f, 1 - p.rates.omega_plus, 1 - omega_minus, sources);
    return {u2(sources), m * mo.drho};
}

}  // namespace lbm
