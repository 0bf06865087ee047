#pragma once

#include "fields/first_exception.hpp"
#include "fields/populations.hpp"
#include "fields/solid_map.hpp"
#include "fields/sweep_row.hpp"
#include "physics/comparison_schemes.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace lbm {

/**
 * Collides and streams all cells once and leaves the solids' sums in the map. Flips the parity; the faces come next.
 * @param after_row  called as after_row(y, z) when a row has made its step; rows in any order, by any thread
 */
template <class L, class T>
FlowWatch sweep(Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                const std::function<void(int, int)>& after_row);

/// The state of a cell between two steps, in lattice units.
struct CellState {
    int x, y, z;
    double epsilon;      ///< solid fraction
    double drho;         ///< rho - 1
    Vec3 u;              ///< velocity, with half of the body and solid forces
    Vec3 force;          ///< F_s that the next collision will apply
    Vec3 momentum;       ///< sum f c after the last collision
    Vec3 next_momentum;  ///< sum f c after the next one
};

/**
 * Reads the cells of one row in order.
 * @param cells  the row, saturated if it has solids
 * @param body   called as body(CellState)
 */
template <class L, class T, class Body>
void read_row(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, int y, int z,
              const RowSaturation& cells, Body& body)
{
    for (int x = 0; x < populations.layout.n[0]; ++x) {
        CellState cell{x, y, z, 0, 0, {}, {}, {}, {}};
        double f[L::Q];
        populations.outgoing(x, y, z, f);
        const Moments<double> after = moments<L>(f);
        populations.incoming(x, y, z, f);
        const Moments<double> before = moments<L>(f);
        using C = RowSaturation;
        const auto cover = cells.covered[x / kBlock];
        const auto in = [&](int column) { return cover == C::kFluid ? 0 : cells.column(column)[x]; };
        const auto velocity = [&](int d) { return cells.fixed ? 0 : in(C::kUs + d); };
        const double u[3] = {velocity(0), velocity(1), velocity(2)};
        const CutCell<double> s =
            cut_cell(p, mixture(in(C::kFraction), in(C::kStrength), u, p.scheme == Scheme::bounce_back).saturation);
        Exchange<double> answer;
        const double bounce = cover == C::kWall ? in(C::kBounce) : 0;
        if (inertia) collide_beside_wall<L, true>(f, p, s, bounce, answer);
        else collide_beside_wall<L, false>(f, p, s, bounce, answer);
        const double rho = inertia ? 1 + before.drho : 1;
        cell.epsilon = s.epsilon;
        cell.drho = before.drho;
        for (int d = 0; d < 3; ++d) {
            // The collision adds m F + F_s to the momentum: halfway through, it is the velocity's.
            cell.u[d] = 0.5 * (before.j[d] + answer.momentum[d]) / rho;
            cell.force[d] = answer.force[d];
            cell.momentum[d] = after.j[d];
            cell.next_momentum[d] = answer.momentum[d];
        }
        body(std::as_const(cell));
    }
}

/// Reads all cells: rows in parallel, the cells of a row in order.
template <class L, class T, class Body>
void for_cells(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, const SolidMap& solids,
               Body body)
{
    const int nx = populations.layout.n[0], ny = populations.layout.n[1], nz = populations.layout.n[2];
    FirstException out_of_memory;
#pragma omp parallel
    {
        std::optional<RowSaturation> scratch;
        if (out_of_memory.all_succeed([&] { scratch.emplace(nx); })) {
            RowSaturation& cells = *scratch;
#pragma omp for schedule(static)
            for (std::ptrdiff_t row = 0; row < static_cast<std::ptrdiff_t>(ny) * nz; ++row) {
                const bool covered = solids.covers(row);
                if (covered) solids.saturate(row, cells);
                read_row(populations, p, inertia, static_cast<int>(row % ny), static_cast<int>(row / ny), cells, body);
                if (covered) cells.clear();
            }
        }
    }
    out_of_memory.rethrow();
}

/**
 * Fills the solids' sums of momentum inside them, and no others.
 * @param momentum  of a cell: member of CellState
 */
template <class L, class T>
void sum_inside(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                Vec3 CellState::*momentum);

}  // namespace lbm
