#include "fields/sweep.hpp"

#include "fields/first_exception.hpp"

#include <algorithm>

namespace lbm {
namespace {

/// Of the calling thread, kept from step to step.
RowSaturation& scratch_row(int nx)
{
    thread_local RowSaturation row(nx);
    thread_local int cells = nx;
    // What a longer row left in the padding of this one, perhaps not even numbers, would count, times 0, in sums over blocks.
    if (cells != nx) {
        row = RowSaturation(nx);
        cells = nx;
    }
    return row;
}

/// @param next  populations, one row on
template <class L, class T>
void look_ahead(const T* next, const Slot (&slot)[L::Q], RowAhead& ahead)
{
    for (int i = 0; i < RowAhead::kAll; ++i)
        ahead.populations[i] = reinterpret_cast<const char*>(next + slot[L::Q - RowAhead::kAll + i]);
    ahead.block_bytes = kBlock * sizeof(T);
}

}  // namespace

template <class L, class T>
FlowWatch sweep(Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                bool heard, const std::function<void(int, int)>& after_row)
{
    static const SweepRows<L, T> variants = sweep_rows<L, T>();
    const SweepRow<L, T> sweep_row = inertia ? variants.inertia : variants.stokes;
    const Layout<L>& layout = populations.layout;
    const int nx = layout.n[0];
    FlowWatch all;
    if (heard) solids.clear_sums();
    FirstException out_of_memory;
#pragma omp parallel
    if (out_of_memory.all_succeed([&] { scratch_row(nx); })) {
        RowSaturation& cells = scratch_row(nx);
        cells.heard = heard;
        FlowWatch watch;
        for_rows(solids.units(), [&](std::size_t row, int y, int z) {
            Slot slot[L::Q];
            for (int i = 0; i < L::Q; ++i) slot[i] = layout.incoming(i, 0, y, z, populations.odd);
            if (solids.covers(row)) {
                look_ahead<L>(populations.data() + layout.row, slot, cells.ahead);
                solids.saturate(row, cells);
                solids.prefetch(row + 1, heard);
                sweep_row(populations.data(), slot, nx, layout.row, p, &cells, watch);
                if (heard) solids.collect(row, cells);
                cells.clear();
            } else {
                sweep_row(populations.data(), slot, nx, layout.row, p, nullptr, watch);
            }
            after_row(y, z);
        });
#pragma omp critical
        all.see(watch);
    }
    out_of_memory.rethrow();
    populations.odd = !populations.odd;
    return all;
}

/// @param read  called as read(y, z, cells, answer) for rows with solids; calls answer(x, momentum inside the solids) for their cells
template <class Read>
static void sum_rows(SolidMap& solids, int nx, Read read)
{
    solids.clear_sums();
    FirstException out_of_memory;
#pragma omp parallel
    if (out_of_memory.all_succeed([&] { scratch_row(nx); })) {
        RowSaturation& cells = scratch_row(nx);
        cells.heard = true;
        for_rows(solids.units(), [&](std::size_t row, int y, int z) {
            if (!solids.covers(row)) return;
            solids.saturate(row, cells);
            std::fill(cells.column(RowSaturation::kForce), cells.column(RowSaturation::kColumns), 0.0);
            read(y, z, cells, [&](int x, const Vec3& momentum) {
                const double fraction = cells.column(RowSaturation::kFraction)[x];
                cells.column(RowSaturation::kShare)[x] = fraction > 0 ? 1 / fraction : 0;
                for (int d = 0; d < 3; ++d) cells.column(RowSaturation::kMomentum + d)[x] = momentum[d];
            });
            solids.collect(row, cells);
            cells.clear();
        });
    }
    out_of_memory.rethrow();
}

template <class L, class T>
void sum_inside(const Populations<L, T>& populations, const CollisionParameters& p, bool inertia, SolidMap& solids,
                Vec3 CellState::*momentum)
{
    sum_rows(solids, populations.layout.n[0], [&](int y, int z, const RowSaturation& cells, const auto& answer) {
        read_row(populations, p, inertia, y, z, cells,
                 [&](const CellState& cell) { answer(cell.x, cell.epsilon * (cell.*momentum)); });
    });
}

void sum_inside(const Vec3& momentum, const CollisionParameters& p, SolidMap& solids, int nx)
{
    constexpr double kAtRest[3] = {};
    const bool whole_cells = p.scheme == Scheme::bounce_back;
    sum_rows(solids, nx, [&](int, int, const RowSaturation& cells, const auto& answer) {
        for (int x = 0; x < nx; ++x) {
            if (cells.covered[x / kBlock] == RowSaturation::kFluid) continue;
            const double fraction = cells.column(RowSaturation::kFraction)[x];
            answer(x, mixture(fraction, 0.0, kAtRest, whole_cells).saturation.epsilon * momentum);
        }
    });
}

#define LBM_SWEEP(L, T)                                                                                                \
    template FlowWatch sweep(Populations<L, T>&, const CollisionParameters&, bool, SolidMap&, bool,                    \
                             const std::function<void(int, int)>&);                                                    \
    template void sum_inside(const Populations<L, T>&, const CollisionParameters&, bool, SolidMap&, Vec3 CellState::*);
LBM_SWEEP(D3Q19, double)
LBM_SWEEP(D3Q19, float)
LBM_SWEEP(D3Q27, double)
LBM_SWEEP(D3Q27, float)
#undef LBM_SWEEP

}  // namespace lbm
