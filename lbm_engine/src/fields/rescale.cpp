#include "fields/rescale.hpp"

#include "fields/cell_state.hpp"

namespace lbm {
namespace {

/// Equilibria and sources of a cell, half of the sources taken off: what the populations relax to.
template <class L>
struct Target {
    double drho, rho;
    Vec3 momentum;  ///< rho u, for the odd part
    Vec3 u;         ///< physical velocity, for the even part
    Vec3 body_force, total_force;
    bool inertia;

    double even(int i) const
    {
        const double w = L::w(i);
        if (!inertia) return w * drho;
        const double cu = along(i, u);
        const double source = w * (9 * cu * along(i, total_force) - 3 * dot(u, total_force));
        return w * (drho + rho * (4.5 * cu * cu - 1.5 * dot(u, u))) - 0.5 * source;
    }
    double odd(int i) const { return 3 * L::w(i) * (along(i, momentum) - 0.5 * along(i, body_force)); }

private:
    static double along(int i, const Vec3& v) { return L::c[i][0] * v[0] + L::c[i][1] * v[1] + L::c[i][2] * v[2]; }
};

template <class L>
Target<L> scaled(const Target<L>& t, double s)
{
    Target<L> r = t;
    r.drho = s * s * t.drho;
    r.rho = t.inertia ? 1 + r.drho : 1;
    r.u = s * t.u;
    r.body_force = (s * s) * t.body_force;
    // F_s = kk rho (u_s - u) holds with the new kk and rho, and u lacks half of it.
    const Vec3 solid_force = (s * s * r.rho / t.rho) * (t.total_force - t.body_force);
    r.total_force = r.body_force + solid_force;
    r.momentum = r.rho * r.u - 0.5 * solid_force;
    return r;
}

}  // namespace

template <class L, class T>
void rescale(Populations<L, T>& populations, const CollisionParameters& from, const CollisionParameters& to,
             bool inertia, const SolidMap& solids)
{
    const Layout<L>& layout = populations.layout;
    const double s = to.rates.Lp / from.rates.Lp;
    const double even_gain = s * from.rates.omega_plus / to.rates.omega_plus;
    for_cells(populations, from, inertia, solids, [&](const CellState& cell) {
        Target<L> before{cell.drho, inertia ? 1 + cell.drho : 1, {}, cell.u, {}, {}, inertia};
        for (int d = 0; d < 3; ++d) {
            before.body_force[d] = from.body_force[d];
            before.total_force[d] = before.body_force[d] + cell.force[d];
        }
        before.momentum = before.rho * before.u - 0.5 * cell.force;
        const Target<L> after = scaled(before, s);
        const double odd_gain = s * s * cell_omega_minus(from, cell.epsilon) / cell_omega_minus(to, cell.epsilon);
        double f_in[L::Q];
        populations.incoming(cell.x, cell.y, cell.z, f_in);
        for (int i = 0; i < L::Q; ++i) {
            const int o = L::opposite(i);
            const double even = 0.5 * (f_in[i] + f_in[o]), odd = 0.5 * (f_in[i] - f_in[o]);
            const double f =
                after.even(i) + even_gain * (even - before.even(i)) + after.odd(i) + odd_gain * (odd - before.odd(i));
            populations.data()[layout.incoming(i, cell.x, cell.y, cell.z, populations.odd)] = static_cast<T>(f);
        }
    });
}

template void rescale(Populations<D3Q19, double>&, const CollisionParameters&, const CollisionParameters&, bool,
                      const SolidMap&);
template void rescale(Populations<D3Q19, float>&, const CollisionParameters&, const CollisionParameters&, bool,
                      const SolidMap&);
template void rescale(Populations<D3Q27, double>&, const CollisionParameters&, const CollisionParameters&, bool,
                      const SolidMap&);
template void rescale(Populations<D3Q27, float>&, const CollisionParameters&, const CollisionParameters&, bool,
                      const SolidMap&);

}  // namespace lbm
