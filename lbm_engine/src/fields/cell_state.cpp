#include "fields/cell_state.hpp"

#include "fields/first_exception.hpp"
#include "physics/comparison_schemes.hpp"

#include <optional>

namespace lbm {

template <class L, class T>
void read_row(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, int y, int z,
              const RowSaturation& cells, const SeeCell& see)
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
            // The collision adds F + F_s to the momentum: halfway through, it is the velocity's.
            cell.u[d] = 0.5 * (before.j[d] + answer.momentum[d]) / rho;
            cell.force[d] = answer.force[d];
            cell.momentum[d] = after.j[d];
            cell.next_momentum[d] = answer.momentum[d];
        }
        see(cell);
    }
}

template <class L, class T>
void for_cells(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, const SolidMap& solids,
               const SeeCell& see)
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
                read_row(populations, p, inertia, static_cast<int>(row % ny), static_cast<int>(row / ny), cells, see);
                if (covered) cells.clear();
            }
        }
    }
    out_of_memory.rethrow();
}

#define LBM_CELL_STATES(L, T)                                                                                          \
    template void read_row(const Populations<L, T>&, const CollisionParameters&, bool, int, int, const RowSaturation&, \
                           const SeeCell&);                                                                            \
    template void for_cells(const Populations<L, T>&, const CollisionParameters&, bool, const SolidMap&,               \
                            const SeeCell&);
LBM_CELL_STATES(D3Q19, double)
LBM_CELL_STATES(D3Q19, float)
LBM_CELL_STATES(D3Q27, double)
LBM_CELL_STATES(D3Q27, float)
#undef LBM_CELL_STATES

}  // namespace lbm
