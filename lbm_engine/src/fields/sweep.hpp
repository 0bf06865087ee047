#pragma once

#include "fields/populations.hpp"
#include "fields/solid_map.hpp"
#include "fields/sweep_row.hpp"

#include <functional>

namespace lbm {

/**
 * Collides and streams all cells once and leaves the solids' sums in the map. Flips the parity; the faces come next.
 * @param after_row  called as after_row(y, z) when a row has made its step; rows in any order, by any thread
 */
template <class T>
SpeedWatch sweep(Populations<T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                 const std::function<void(int, int)>& after_row);

/// The state of a cell between two steps, in lattice units.
struct CellState {
    double epsilon;  ///< solid fraction
    double drho;     ///< rho - 1
    Vec3 u;          ///< velocity, with half of the body and solid forces
    Vec3 momentum;   ///< sum f c after the last collision
};

/**
 * Reads the cells of one row in order.
 * @param cells  scratch
 * @param body   called as body(row, x, CellState); row = z ny + y
 */
template <class T, class Body>
void for_cells_of_row(const Populations<T>& populations, const CollisionParameters& p, bool inertia,
                      const SolidMap& solids, std::size_t row, RowSaturation& cells, Body& body)
{
    const int nx = populations.layout.n[0], ny = populations.layout.n[1];
    const int y = static_cast<int>(row % ny), z = static_cast<int>(row / ny);
    const bool covered = solids.covers(row);
    if (covered) solids.saturate(row, cells);
    for (int x = 0; x < nx; ++x) {
        double f[D3Q19::Q];
        populations.outgoing(x, y, z, f);
        const Moments<double> after = moments(f);
        populations.incoming(x, y, z, f);
        const Moments<double> before = moments(f);
        const auto in = [&](int column) { return cells.column(column)[x]; };
        using C = RowSaturation;
        const Saturation<double> s{in(C::kEpsilon), in(C::kStrength), {in(C::kUs), in(C::kUs + 1), in(C::kUs + 2)}};
        Exchange<double> answer;
        if (inertia) collide_saturated<true>(f, p, s, answer);
        else collide_saturated<false>(f, p, s, answer);
        const double rho = inertia ? 1 + before.drho : 1;
        CellState state{s.epsilon, before.drho, {}, {after.j[0], after.j[1], after.j[2]}};
        // The collision adds m F + F_s to the momentum: halfway through, it is the velocity's.
        for (int d = 0; d < 3; ++d) state.u[d] = 0.5 * (before.j[d] + answer.momentum[d]) / rho;
        body(row, x, state);
    }
    if (covered) solids.clear(cells);
}

/// Reads all cells: rows in parallel, the cells of a row in order.
template <class T, class Body>
void for_cells(const Populations<T>& populations, const CollisionParameters& p, bool inertia, const SolidMap& solids,
               Body body)
{
    const int nx = populations.layout.n[0], ny = populations.layout.n[1], nz = populations.layout.n[2];
#pragma omp parallel
    {
        RowSaturation cells(nx);
#pragma omp for schedule(static)
        for (std::ptrdiff_t row = 0; row < static_cast<std::ptrdiff_t>(ny) * nz; ++row)
            for_cells_of_row(populations, p, inertia, solids, static_cast<std::size_t>(row), cells, body);
    }
}

/// Fills the solids' sums with sum eps j of the last collision, for solids that have just been placed.
template <class T>
void sum_inside(const Populations<T>& populations, SolidMap& solids);

}  // namespace lbm
