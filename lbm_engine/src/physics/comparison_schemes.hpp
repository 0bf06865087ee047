#pragma once

#include "physics/collision.hpp"

namespace lbm {

/**
 * The published operators for cells with solids, written for reading and comparison (docs/physics.md). With a weight B in [0, 1] and w the
 * velocity of the fluid without any solid force they all are
 *
 *     f+ <- f+ - a+ (f+ - e+(u)) + B (e+(u_s) - e+(u)) + sources of (1 - B) F
 *     f- <- f- - a- (f- - e-(u)) + B (e-(u_s) - e-(u)) + sources of (1 - B) F
 *
 * where superposition [Holdych] keeps the rates of the fluid, a+- = omega+-, and the bounce-back of what is out of equilibrium [Noble & Torczynski]
 * has a+ = (1 - B) omega+, a- = (1 - B) omega- + 2 B. Bounce-back of all populations is the latter with B = 1 and u = u_s. The solids bear the rest of the drive, B F.
 */
template <class V>
struct PublishedWeight {
    V B;
    V keep;  ///< a+ / omega+
    V turn;  ///< a- - keep omega-
};

/// B of the operators with a weight; for bounce-back 1 in cells that are more than half solid.
template <class V>
[[gnu::always_inline]] inline PublishedWeight<V> published_weight(const CollisionParameters& p, const V& epsilon)
{
    const V one = V{} + 1.0, zero = V{};
    switch (p.scheme) {
    case Scheme::bounce_back: {
        const V B = epsilon >= 0.5 ? one : zero;
        return {B, 1 - B, 2 * B};
    }
    case Scheme::noble_torczynski_linear:
        return {epsilon, 1 - epsilon, 2 * epsilon};
    default: {
        const V B = epsilon * p.rates.Lp / ((1 - epsilon) + p.rates.Lp);
        if (p.scheme == Scheme::superposition) return {B, one, zero};
        return {B, 1 - B, 2 * B};
    }
    }
}

/**
 * One collision by a published operator.
 * @param bounces  whether cells with B = 1 turn all populations round
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_published(V (&f)[L::Q], const CollisionParameters& p, const V (&u_s)[3],
                                                        const PublishedWeight<V>& weight, bool bounces,
                                                        Exchange<V>& out)
{
    const Moments<V> mo = moments<L>(f);
    const V rho = inertia ? 1 + mo.drho : V{} + 1.0;
    const V m = 1 - weight.B;
    const V a_plus = weight.keep * p.rates.omega_plus, a_minus = weight.keep * p.rates.omega_minus + weight.turn;
    V u[3], F[3];
    for (int d = 0; d < 3; ++d) {
        F[d] = m * p.body_force[d];
        const V momentum = mo.j[d] + 0.5 * F[d];
        u[d] = momentum / rho;
        if (bounces) u[d] = weight.B > 0.5 ? u_s[d] : u[d];
        out.force[d] = a_minus * (rho * u[d] - momentum) + weight.B * (rho * (u_s[d] - u[d]) - p.body_force[d]);
        out.momentum[d] = mo.j[d] + p.body_force[d] + out.force[d];
    }
    out.weight = (bounces ? 2 : 1) * weight.B * rho;

    const V u2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    const V s2 = u_s[0] * u_s[0] + u_s[1] * u_s[1] + u_s[2] * u_s[2];
    const V uF = u[0] * F[0] + u[1] * F[1] + u[2] * F[2];
    f[0] -= a_plus * (f[0] - L::w(0) * mo.drho);
    if constexpr (inertia)
        f[0] += L::w(0) * (-1.5 * rho * (a_plus * u2 + weight.B * (s2 - u2)) - 3 * (1 - 0.5 * a_plus) * uF);
    detail::for_pairs<L>([&]<int a, int b>() __attribute__((always_inline)) {
        const double w = L::w(a);
        const V cu = detail::c_dot<L, a>(u), cs = detail::c_dot<L, a>(u_s), cF = detail::c_dot<L, a>(F);
        V even = 0.5 * (f[a] + f[b]), odd = 0.5 * (f[a] - f[b]);
        V e_plus = w * mo.drho;
        const V e_minus = 3 * w * rho * cu;
        if constexpr (inertia) {
            e_plus += w * rho * (4.5 * cu * cu - 1.5 * u2);
            const V of_solid = w * rho * (4.5 * (cs * cs - cu * cu) - 1.5 * (s2 - u2));
            even += weight.B * of_solid + (1 - 0.5 * a_plus) * w * (9 * cu * cF - 3 * uF);
        }
        const V even_before = 0.5 * (f[a] + f[b]);
        even -= a_plus * (even_before - e_plus);
        odd += -a_minus * (odd - e_minus) + 3 * w * (weight.B * rho * (cs - cu) + (1 - 0.5 * a_minus) * cF);
        f[a] = even + odd;
        f[b] = even - odd;
    });
    return {u2, m * mo.drho};
}

/// The collision of cells with solids in them, by the scheme of the parameters. This is the one place that chooses.
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_with_solids(V (&f)[L::Q], const CollisionParameters& p,
                                                          const CutCell<V>& cell, Exchange<V>& out)
{
    if (p.scheme == Scheme::exact) return collide_saturated<L, inertia>(f, p, cell, out);
    return collide_published<L, inertia>(f, p, cell.u_s, published_weight(p, cell.epsilon),
                                         p.scheme == Scheme::bounce_back, out);
}

/**
 * The same beside a solid whose surface runs along the lattice: its cells turn all populations round, which puts a no-slip wall exactly
 * half-way between their centres and those of the fluid.
 * @param bounce  1 in the solid's cells, 0 elsewhere
 */
template <class L, bool inertia, class V>
[[gnu::always_inline]] inline Seen<V> collide_beside_wall(V (&f)[L::Q], const CollisionParameters& p,
                                                          const CutCell<V>& cell, const V& bounce, Exchange<V>& out)
{
    V turned[L::Q];
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) turned[i] = f[i];
    Exchange<V> of_wall;
    const Seen<V> wall =
        collide_published<L, inertia>(turned, p, cell.u_s, {bounce, 1 - bounce, 2 * bounce}, true, of_wall);
    const Seen<V> other = collide_with_solids<L, inertia>(f, p, cell, out);
    const auto is_wall = bounce > 0.5;
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) f[i] = is_wall ? turned[i] : f[i];
    for (int d = 0; d < 3; ++d) {
        out.force[d] = is_wall ? of_wall.force[d] : out.force[d];
        out.momentum[d] = is_wall ? of_wall.momentum[d] : out.momentum[d];
    }
    out.weight = is_wall ? of_wall.weight : out.weight;
    return {is_wall ? wall.u2 : other.u2, is_wall ? wall.drho : other.drho};
}

}  // namespace lbm
