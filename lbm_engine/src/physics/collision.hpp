#pragma once

#include "lbm/fluid_config.hpp"
#include "physics/rates.hpp"

#include <utility>

namespace lbm {

/**
 * The collision of one cell, or of as many cells side by side as `V` has lanes: V is double or a vector of doubles.
 * Populations are deviations from rest, f - w; lattice units with rho_0 = 1.
 */
struct CollisionParameters {
    TrtRates rates;
    double body_force[3];  ///< F = rho_0 * acceleration
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
    Moments<V> m{f[0], {V{}, V{}, V{}}};
    detail::for_pairs<L>([&]<int a, int b>() __attribute__((always_inline)) {
        m.drho += f[a] + f[b];
        const V difference = f[a] - f[b];
        for (int d = 0; d < 3; ++d) {
            if (L::c[a][d] > 0) m.j[d] += difference;
            if (L::c[a][d] < 0) m.j[d] -= difference;
        }
    });
    return m;
}

/**
 * TRT relaxation with the equilibria and sources already gathered into a few cell values:
 *
 *     f+ <- (1 - omega+) f+  + w (even_0 + (c.u) (c.even_2))
 *     f- <- (1 - omega-) f-  + w c.odd
 */
template <class L, bool inertia, class V, class Rate>
[[gnu::always_inline]] inline void relax(V (&f)[L::Q], double omega_plus, const Rate& omega_minus, const V& even_0,
                                         const V (&u)[3], const V (&even_2)[3], const V (&odd)[3])
{
    const double keep_even = 1 - omega_plus;
    const Rate keep_odd = 1 - omega_minus;
    f[0] = keep_even * f[0] + L::w(0) * even_0;
    detail::for_pairs<L>([&]<int a, int b>() __attribute__((always_inline)) {
        V even = even_0;
        if constexpr (inertia) even += detail::c_dot<L, a>(u) * detail::c_dot<L, a>(even_2);
        const V new_even = (0.5 * keep_even) * (f[a] + f[b]) + L::w(a) * even;
        const V new_odd = (0.5 * keep_odd) * (f[a] - f[b]) + L::w(a) * detail::c_dot<L, a>(odd);
        f[a] = new_even + new_odd;
        f[b] = new_even - new_odd;
    });
}

/**
 * The even sources of relax: e+ = w (drho + rho (9/2 (c.u)^2 - 3/2 u^2)) and, with total force F_t, the even Guo term
 * (1 - omega+/2) w (9 (c.u)(c.F_t) - 3 u.F_t). With E = 9/2 omega+ rho u + 9 (1 - omega+/2) F_t they are
 * w (omega+ drho - u.E / 3 + (c.u) (c.E)). Stokes flow keeps omega+ drho only.
 * @see Guo, Zheng & Shi (2002), Phys. Rev. E 65, 046308
 */
template <bool inertia, class V>
[[gnu::always_inline]] inline V even_sources(double omega_plus, const V& drho, const V (&u)[3],
                                             const V (&total_force)[3], V (&even_2)[3])
{
    V even_0 = omega_plus * drho;
    if constexpr (inertia) {
        const V a = (4.5 * omega_plus) * (1 + drho);
        const double b = 9 * (1 - 0.5 * omega_plus);
        for (int d = 0; d < 3; ++d) even_2[d] = a * u[d] + b * total_force[d];
        even_0 -= (1.0 / 3) * (u[0] * even_2[0] + u[1] * even_2[1] + u[2] * even_2[2]);
    }
    return even_0;
}

/**
 * One TRT collision of fluid.
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_fluid(V (&f)[L::Q], const CollisionParameters& p)
{
    const double omega_plus = p.rates.omega_plus, omega_minus = p.rates.omega_minus;
    const Moments<V> m = moments<L>(f);
    V u[3], odd[3], even_2[3], force[3];
    V inverse_rho{};
    if constexpr (inertia) inverse_rho = 1 / (1 + m.drho);
    for (int d = 0; d < 3; ++d) {
        const double F = p.body_force[d];
        const V momentum = m.j[d] + 0.5 * F;
        u[d] = inertia ? momentum * inverse_rho : momentum;
        force[d] = V{} + F;
        odd[d] = (3 * omega_minus) * momentum + 3 * (1 - 0.5 * omega_minus) * F;
    }
    const V even_0 = even_sources<inertia>(omega_plus, m.drho, u, force, even_2);
    relax<L, inertia>(f, omega_plus, omega_minus, even_0, u, even_2, odd);
    return {u[0] * u[0] + u[1] * u[1] + u[2] * u[2], m.drho};
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
    V force[3];     ///< F_s, of the solids on the fluid
    V momentum[3];  ///< sum f c after the collision
    V weight;       ///< kk rho
};

/// omega-_c = 1 / (Lm lam(eps) + 1/2), with the lam of the parameter set (Weighting), multiplied out: one division.
template <class V>
[[gnu::always_inline]] inline V cell_omega_minus(const CollisionParameters& p, const V& epsilon)
{
    if (!p.low_noise) return V{} + p.rates.omega_minus;
    const V a = 1 + 3 * epsilon;
    return a / (p.rates.Lm * ((1 - epsilon) + 0.05 * epsilon * a) + 0.5 * a);
}

/**
 * One collision of a partially saturated cell, exact in tau for Stokes flow (superposition form, docs/physics.md):
 *
 *     kk   = k eps Lp / (max(m, 0.02) + k eps Lp / 2),   m = 1 - eps
 *     Lm_c = Lm lam(eps),   omega-_c = 1 / (Lm_c + 1/2)
 *     u    = (sum f c + m F / 2) / rho
 *     F_s  = kk rho (u_s - u),   u_phys = u + F_s / (2 rho)
 *
 * @return with u_phys
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_saturated(V (&f)[L::Q], const CollisionParameters& p,
                                                        const Saturation<V>& s, Exchange<V>& out)
{
    const V m = 1 - s.epsilon;
    const V kLp = p.rates.Lp * s.strength;
    const V least = V{} + kLeastFluidFraction;
    const V kk = kLp / ((m > least ? m : least) + 0.5 * kLp);
    const V omega_minus = cell_omega_minus(p, s.epsilon);
    const Moments<V> mo = moments<L>(f);
    V u[3], odd[3], even_2[3], total_force[3];
    V rho = V{} + 1.0, inverse_rho = V{} + 1.0;
    if constexpr (inertia) {
        rho = 1 + mo.drho;
        inverse_rho = 1 / rho;
    }
    out.weight = kk * rho;
    for (int d = 0; d < 3; ++d) {
        const V mF = m * p.body_force[d];
        const V momentum = mo.j[d] + 0.5 * mF;
        const V F_s = kk * (rho * s.u_s[d] - momentum);
        u[d] = (momentum + 0.5 * F_s) * inverse_rho;
        odd[d] = 3 * (omega_minus * momentum + (1 - 0.5 * omega_minus) * mF + F_s);
        total_force[d] = mF + F_s;
        out.force[d] = F_s;
        out.momentum[d] = mo.j[d] + total_force[d];
    }
    const V even_0 = even_sources<inertia>(p.rates.omega_plus, mo.drho, u, total_force, even_2);
    relax<L, inertia>(f, p.rates.omega_plus, omega_minus, even_0, u, even_2, odd);
    return {u[0] * u[0] + u[1] * u[1] + u[2] * u[2], m * mo.drho};
}

}  // namespace lbm
