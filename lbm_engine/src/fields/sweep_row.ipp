// The sweep over a row, compiled once per instruction set: define LBM_ISA (a namespace) and LBM_LANES before including.
// Everything is inlined into functions of that namespace, so that no code for one instruction set leaks into another.

#include "fields/sweep_row.hpp"
#include "lattice/pack.hpp"
#include "physics/comparison_schemes.hpp"

#include <algorithm>
#include <type_traits>

namespace lbm::LBM_ISA {
namespace {

template <int W, class S>
struct WatchPack {
    Pack<W, S> max2{}, sum2{}, drho2{};
    [[gnu::always_inline]] void see(const Seen<Pack<W, S>>& cells)
    {
        max2 = cells.u2 > max2 ? cells.u2 : max2;
        sum2 += cells.u2;
        const Pack<W, S> squared = cells.drho * cells.drho;
        drho2 = squared > drho2 ? squared : drho2;
    }
};

// Unrolled, so that the populations live in registers.
template <class L, int asked, class V, class T>
[[gnu::always_inline]] inline void load_all(T* const (&p)[L::Q], int x, Slot ahead, V (&f)[L::Q])
{
    constexpr int kLanes = sizeof(V) / sizeof(Scalar<V>);
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) {
        f[i] = load<kLanes, Scalar<V>>(p[i] + x);
        // Memory works on the next row while this one is computed and its solids are served. 1: to be written, 2: into the second level.
        if (kLanes > 1 && i < asked) __builtin_prefetch(p[i] + x + ahead, 1, 2);
    }
}

template <class L, class V, class T>
[[gnu::always_inline]] inline void store_all(T* const (&p)[L::Q], int x, const V (&f)[L::Q])
{
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) store<sizeof(V) / sizeof(Scalar<V>), Scalar<V>>(p[L::opposite(i)] + x, f[i]);
}

/// How the cells of a block collide.
enum class Kind { fluid, cut, cut_by_fixed, any };

/// Cells of fluid are computed in the kind of number T that their populations are stored in, others in doubles.
template <Kind kind, class T>
using Number = std::conditional_t<kind == Kind::fluid, T, double>;

/// As many fit into a register.
template <Kind kind, class T>
constexpr int kWidest = LBM_LANES*(sizeof(double) / sizeof(Number<kind, T>));

/// From the sums of what the solids say to some cells to what their collision needs.
template <Kind kind, int W>
[[gnu::always_inline]] inline void weigh(const CollisionParameters& parameters, RowSaturation& cells, int x)
{
    using C = RowSaturation;
    const auto at = [&](int column) __attribute__((always_inline)) { return cells.column(column) + x; };
    const auto read = [&](int column) __attribute__((always_inline)) { return load<W>(at(column)); };
    Pack<W> u[3]{};
    if (kind == Kind::cut || !cells.fixed)
        for (int d = 0; d < 3; ++d) u[d] = read(C::kUs + d);
    const Mixture<Pack<W>> solids =
        mixture(read(C::kFraction), read(C::kStrength), u, parameters.scheme == Scheme::bounce_back);
    const CutCell<Pack<W>> cell = cut_cell(parameters, solids.saturation);
    store<W>(at(C::kFraction), cell.epsilon);
    store<W>(at(C::kStrength), cell.kk);
    if constexpr (kind != Kind::cut_by_fixed)
        for (int d = 0; d < 3; ++d) store<W>(at(C::kUs + d), cell.u_s[d]);
    store<W>(at(C::kOmegaMinus), cell.omega_minus);
    store<W>(at(C::kShare), solids.share);
}

template <class L, bool inertia, Kind kind, int W, class T>
[[gnu::always_inline]] inline void sweep_cells(T* const (&p)[L::Q], int x, Slot ahead,
                                               const CollisionParameters& parameters, RowSaturation* row,
                                               WatchPack<W, Number<kind, T>>& watch)
{
    Pack<W, Number<kind, T>> f[L::Q];
    load_all<L, kind == Kind::fluid ? L::Q : L::Q - RowAhead::kAll>(p, x, ahead, f);
    if constexpr (kind == Kind::fluid) watch.see(collide_fluid<L, inertia>(f, parameters));
    else {
        using C = RowSaturation;
        const auto at = [&](int column) __attribute__((always_inline)) { return row->column(column) + x; };
        const auto read = [&](int column) __attribute__((always_inline)) { return load<W>(at(column)); };
        CutCell<Pack<W>> cell{read(C::kFraction), read(C::kStrength), read(C::kOmegaMinus), {}};
        if constexpr (kind != Kind::cut_by_fixed)
            for (int d = 0; d < 3; ++d) cell.u_s[d] = read(C::kUs + d);
        Exchange<Pack<W>> answer;
        if constexpr (kind == Kind::cut) watch.see(collide_saturated<L, inertia>(f, parameters, cell, answer));
        else if constexpr (kind == Kind::cut_by_fixed)
            watch.see(collide_saturated<L, inertia, true>(f, parameters, cell, answer));
        else if (row->covered[x / kBlock] == C::kWall)
            watch.see(collide_beside_wall<L, inertia>(f, parameters, cell, read(C::kBounce), answer));
        else watch.see(collide_with_solids<L, inertia>(f, parameters, cell, answer));
        if (row->heard) {
            for (int d = 0; d < 3; ++d) {
                store<W>(at(C::kForce + d), answer.force[d]);
                store<W>(at(C::kMomentum + d), cell.epsilon * answer.momentum[d]);
            }
        } else {
            row->ahead.ask_rest(x / kBlock);
        }
        if constexpr (kind != Kind::cut_by_fixed) store<W>(at(C::kWeight), (1 - cell.epsilon) * answer.weight);
    }
    store_all<L>(p, x, f);
}

template <int W, class S>
void note(const WatchPack<W, S>& pack, FlowWatch& watch)
{
    const auto lane = [](const auto& of, int l) { return reinterpret_cast<const S*>(&of)[l]; };
    for (int l = 0; l < W; ++l) watch.see({lane(pack.max2, l), lane(pack.sum2, l), lane(pack.drho2, l)});
}

/// Cells from x on, W at a time as long as they last, then fewer.
template <class L, bool inertia, Kind kind, int W, class T>
[[gnu::noinline]] void sweep_rest(T* const (&p)[L::Q], int x, int end, Slot ahead,
                                  const CollisionParameters& parameters, RowSaturation* row, FlowWatch& watch)
{
    const CollisionParameters own = parameters;
    WatchPack<W, Number<kind, T>> pack;
    for (; x + W <= end; x += W) sweep_cells<L, inertia, kind, W>(p, x, ahead, own, row, pack);
    note(pack, watch);
    if constexpr (W > 1)
        if (x < end) sweep_rest<L, inertia, kind, W / 2>(p, x, end, ahead, parameters, row, watch);
}

/// What was seen in whole packs of cells of a kind, and in others.
template <Kind kind, class T>
struct RowWatch {
    WatchPack<kWidest<kind, T>, Number<kind, T>> packs;
    FlowWatch rest;
};

/// Neighbouring blocks of a row. One function for each kind of cells, because registers are few.
template <class L, bool inertia, Kind kind, class T>
[[gnu::noinline]] void sweep_blocks(T* const (&p)[L::Q], int begin, int end, Slot ahead,
                                    const CollisionParameters& parameters, RowSaturation& row, RowWatch<kind, T>& watch)
{
    constexpr int W = kWidest<kind, T>;
    const CollisionParameters own = parameters;
    int x = begin * kBlock;
    const int end_x = end * kBlock;
    if constexpr (kind != Kind::fluid)
        for (int i = x; i < end_x; i += W) weigh<kind, W>(parameters, row, i);
    auto seen = watch.packs;
    for (; x + W <= end_x; x += W) sweep_cells<L, inertia, kind, W>(p, x, ahead, own, &row, seen);
    watch.packs = seen;
    if constexpr (W > kBlock)
        if (x < end_x) sweep_rest<L, inertia, kind, W / 2>(p, x, end_x, ahead, parameters, &row, watch.rest);
}

/// A row with solids, whose cells are of one kind.
template <class L, bool inertia, Kind kind, class T>
[[gnu::always_inline]] inline void sweep_solid_row(T* const (&p)[L::Q], int nx, Slot ahead,
                                                   const CollisionParameters& parameters, RowSaturation& row,
                                                   FlowWatch& watch)
{
    const int whole = nx / kBlock;
    const auto is_covered = [&](int block) { return row.covered[block] != RowSaturation::kFluid; };
    RowWatch<kind, T> solid_watch;
    RowWatch<Kind::fluid, T> fluid_watch;
    for (int begin = 0, end = 0; begin < whole; begin = end) {
        const bool covered = is_covered(begin);
        do ++end;
        while (end < whole && is_covered(end) == covered);
        if (covered) sweep_blocks<L, inertia, kind>(p, begin, end, ahead, parameters, row, solid_watch);
        else sweep_blocks<L, inertia, Kind::fluid>(p, begin, end, ahead, parameters, row, fluid_watch);
    }
    if (whole * kBlock < nx) {
        constexpr int W = LBM_LANES;
        if (is_covered(whole)) {
            for (int x = 0; x < kBlock; x += W) weigh<kind, W>(parameters, row, whole * kBlock + x);
            sweep_rest<L, inertia, kind, W>(p, whole * kBlock, nx, ahead, parameters, &row, watch);
        } else {
            sweep_rest<L, inertia, Kind::fluid, W>(p, whole * kBlock, nx, ahead, parameters, &row, watch);
        }
    }
    note(solid_watch.packs, watch);
    note(fluid_watch.packs, watch);
    watch.see(solid_watch.rest);
    watch.see(fluid_watch.rest);
}

}  // namespace

template <class L, bool inertia, class T>
void sweep_row(T* f, const Slot (&slot)[L::Q], int nx, Slot ahead, const CollisionParameters& parameters,
               RowSaturation* cells, FlowWatch& watch) noexcept
{
    T* p[L::Q];
    for (int i = 0; i < L::Q; ++i) p[i] = f + slot[i];
    if (!cells) {
        sweep_rest<L, inertia, Kind::fluid, kWidest<Kind::fluid, T>>(p, 0, nx, ahead, parameters, nullptr, watch);
        return;
    }
    const bool wall =
        std::find(cells->covered.begin(), cells->covered.end(), RowSaturation::kWall) != cells->covered.end();
    if (wall || parameters.scheme != Scheme::exact)
        sweep_solid_row<L, inertia, Kind::any>(p, nx, ahead, parameters, *cells, watch);
    else if (cells->fixed) sweep_solid_row<L, inertia, Kind::cut_by_fixed>(p, nx, ahead, parameters, *cells, watch);
    else sweep_solid_row<L, inertia, Kind::cut>(p, nx, ahead, parameters, *cells, watch);
}

#define LBM_SWEEP_ROW(L, inertia, T)                                                                                   \
    template void sweep_row<L, inertia, T>(T*, const Slot(&)[L::Q], int, Slot, const CollisionParameters&,             \
                                           RowSaturation*, FlowWatch&) noexcept;
LBM_SWEEP_ROW(D3Q19, true, double)
LBM_SWEEP_ROW(D3Q19, false, double)
LBM_SWEEP_ROW(D3Q19, true, float)
LBM_SWEEP_ROW(D3Q19, false, float)
LBM_SWEEP_ROW(D3Q27, true, double)
LBM_SWEEP_ROW(D3Q27, false, double)
LBM_SWEEP_ROW(D3Q27, true, float)
LBM_SWEEP_ROW(D3Q27, false, float)
#undef LBM_SWEEP_ROW

}  // namespace lbm::LBM_ISA
