// The sweep over a row, compiled once per instruction set: define LBM_ISA (a namespace) and LBM_LANES before including.
// Everything is inlined into functions of that namespace, so that no code for one instruction set leaks into another.

#include "fields/pack.hpp"
#include "fields/sweep_row.hpp"
#include "physics/comparison_schemes.hpp"

namespace lbm::LBM_ISA {
namespace {

template <int W>
struct WatchPack {
    Pack<W> max2{}, sum2{}, drho2{};
    [[gnu::always_inline]] void see(const Seen<Pack<W>>& cells)
    {
        max2 = cells.u2 > max2 ? cells.u2 : max2;
        sum2 += cells.u2;
        const Pack<W> squared = cells.drho * cells.drho;
        drho2 = squared > drho2 ? squared : drho2;
    }
};

// Unrolled, so that the populations live in registers.
template <class L, class V, class T>
[[gnu::always_inline]] inline void load_all(T* const (&p)[L::Q], int x, Slot ahead, V (&f)[L::Q])
{
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) {
        f[i] = load<sizeof(V) / sizeof(double)>(p[i] + x);
        // Memory works on the next row while this one is computed and its solids are served. 1: to be written, 2: into the second level.
        if constexpr (sizeof(V) / sizeof(double) > 1) __builtin_prefetch(p[i] + x + ahead, 1, 2);
    }
}

template <class L, class V, class T>
[[gnu::always_inline]] inline void store_all(T* const (&p)[L::Q], int x, const V (&f)[L::Q])
{
#pragma GCC unroll 27
    for (int i = 0; i < L::Q; ++i) store<sizeof(V) / sizeof(double)>(p[L::opposite(i)] + x, f[i]);
}

template <class L, bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_fluid(T* const (&p)[L::Q], int x, Slot ahead,
                                               const CollisionParameters& parameters, WatchPack<W>& watch)
{
    Pack<W> f[L::Q];
    load_all<L>(p, x, ahead, f);
    watch.see(collide_fluid<L, inertia>(f, parameters));
    store_all<L>(p, x, f);
}

template <class L, bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_saturated(T* const (&p)[L::Q], int x, Slot ahead,
                                                   const CollisionParameters& parameters, RowSaturation& cells,
                                                   WatchPack<W>& watch)
{
    Pack<W> f[L::Q];
    load_all<L>(p, x, ahead, f);
    const auto read = [&](int column) __attribute__((always_inline)) { return load<W>(cells.column(column) + x); };
    const auto write = [&](int column, const Pack<W>& v) __attribute__((always_inline))
    {
        store<W>(cells.column(column) + x, v);
    };
    using C = RowSaturation;
    const Pack<W> u[3] = {read(C::kUs), read(C::kUs + 1), read(C::kUs + 2)};
    const Mixture<Pack<W>> solids =
        mixture(read(C::kFraction), read(C::kStrength), u, parameters.scheme == Scheme::bounce_back);
    const Saturation<Pack<W>>& saturation = solids.saturation;
    Exchange<Pack<W>> answer;
    if (cells.covered[x / kBlock] == C::kWall)
        watch.see(collide_beside_wall<L, inertia>(f, parameters, saturation, read(C::kBounce), answer));
    else watch.see(collide_with_solids<L, inertia>(f, parameters, saturation, answer));
    const Pack<W> filled = solids.per_fraction * saturation.epsilon;
    for (int d = 0; d < 3; ++d) {
        write(C::kForce + d, solids.per_fraction * answer.force[d]);
        write(C::kMomentum + d, filled * answer.momentum[d]);
    }
    write(C::kWeight, (1 - saturation.epsilon) * solids.per_fraction * answer.weight);
    store_all<L>(p, x, f);
}

template <class V>
void note(const V& pack, int lanes, FlowWatch& watch)
{
    const auto lane = [](const auto& of, int l) { return reinterpret_cast<const double*>(&of)[l]; };
    for (int l = 0; l < lanes; ++l) watch.see({lane(pack.max2, l), lane(pack.sum2, l), lane(pack.drho2, l)});
}

/// Cells from x to end, W at a time as long as they last, then fewer at a time.
template <class L, bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_cells(T* const (&p)[L::Q], int x, int end, Slot ahead,
                                               const CollisionParameters& parameters, RowSaturation* cells,
                                               FlowWatch& watch)
{
    WatchPack<W> pack;
    if (!cells) {
        for (; x + W <= end; x += W) sweep_fluid<L, inertia, W>(p, x, ahead, parameters, pack);
    } else {
        for (; x + W <= end; x += W) {
            if (cells->covered[x / kBlock]) sweep_saturated<L, inertia, W>(p, x, ahead, parameters, *cells, pack);
            else sweep_fluid<L, inertia, W>(p, x, ahead, parameters, pack);
        }
    }
    note(pack, W, watch);
    if constexpr (W > 1)
        if (x < end) sweep_cells<L, inertia, W / 2>(p, x, end, ahead, parameters, cells, watch);
}

}  // namespace

template <class L, bool inertia, class T>
void sweep_row(T* f, const Slot (&slot)[L::Q], int nx, Slot ahead, const CollisionParameters& parameters,
               RowSaturation* cells, FlowWatch& watch) noexcept
{
    T* p[L::Q];
    for (int i = 0; i < L::Q; ++i) p[i] = f + slot[i];
    const CollisionParameters local = parameters;
    sweep_cells<L, inertia, LBM_LANES>(p, 0, nx, ahead, local, cells, watch);
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
