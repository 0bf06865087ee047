// The sweep over a row, compiled once per instruction set: define LBM_ISA (a namespace) and LBM_LANES before including.
// Everything is inlined into functions of that namespace, so that no code for one instruction set leaks into another.

#include "fields/pack.hpp"
#include "fields/sweep_row.hpp"

namespace lbm::LBM_ISA {
namespace {

template <int W>
struct WatchPack {
    Pack<W> max2{}, sum2{};
    [[gnu::always_inline]] void see(const Pack<W>& u2)
    {
        max2 = u2 > max2 ? u2 : max2;
        sum2 += u2;
    }
};

// Unrolled, so that the populations live in registers.
template <class V, class T>
[[gnu::always_inline]] inline void load_all(T* const (&p)[D3Q19::Q], int x, Layout::Index ahead, V (&f)[D3Q19::Q])
{
#pragma GCC unroll 19
    for (int i = 0; i < D3Q19::Q; ++i) {
        f[i] = load<sizeof(V) / sizeof(double)>(p[i] + x);
        // Memory works on the next row while this one is computed and its solids are served. 1: to be written, 2: into the second level.
        if constexpr (sizeof(V) / sizeof(double) > 1) __builtin_prefetch(p[i] + x + ahead, 1, 2);
    }
}

template <class V, class T>
[[gnu::always_inline]] inline void store_all(T* const (&p)[D3Q19::Q], int x, const V (&f)[D3Q19::Q])
{
#pragma GCC unroll 19
    for (int i = 0; i < D3Q19::Q; ++i) store<sizeof(V) / sizeof(double)>(p[D3Q19::opposite(i)] + x, f[i]);
}

template <bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_fluid(T* const (&p)[D3Q19::Q], int x, Layout::Index ahead,
                                               const CollisionParameters& parameters, WatchPack<W>& watch)
{
    Pack<W> f[D3Q19::Q];
    load_all(p, x, ahead, f);
    watch.see(collide_fluid<inertia>(f, parameters));
    store_all(p, x, f);
}

template <bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_saturated(T* const (&p)[D3Q19::Q], int x, Layout::Index ahead,
                                                   const CollisionParameters& parameters, RowSaturation& cells,
                                                   WatchPack<W>& watch)
{
    Pack<W> f[D3Q19::Q];
    load_all(p, x, ahead, f);
    const auto read = [&](int column) __attribute__((always_inline)) { return load<W>(cells.column(column) + x); };
    const auto write = [&](int column, const Pack<W>& v) __attribute__((always_inline))
    {
        store<W>(cells.column(column) + x, v);
    };
    using C = RowSaturation;
    const Saturation<Pack<W>> saturation{
        read(C::kEpsilon), read(C::kStrength), {read(C::kUs), read(C::kUs + 1), read(C::kUs + 2)}};
    Exchange<Pack<W>> answer;
    watch.see(collide_saturated<inertia>(f, parameters, saturation, answer));
    for (int d = 0; d < 3; ++d) {
        write(C::kForce + d, answer.force[d]);
        write(C::kMomentum + d, answer.momentum[d]);
    }
    write(C::kWeight, answer.weight);
    store_all(p, x, f);
}

template <class V>
void note(const V& pack, int lanes, SpeedWatch& watch)
{
    const double* max2 = reinterpret_cast<const double*>(&pack.max2);
    const double* sum2 = reinterpret_cast<const double*>(&pack.sum2);
    for (int l = 0; l < lanes; ++l) {
        watch.max2 = max2[l] > watch.max2 ? max2[l] : watch.max2;
        watch.sum2 += sum2[l];
    }
}

/// Cells from x to end, W at a time as long as they last, then fewer at a time.
template <bool inertia, int W, class T>
[[gnu::always_inline]] inline void sweep_cells(T* const (&p)[D3Q19::Q], int x, int end, Layout::Index ahead,
                                               const CollisionParameters& parameters, RowSaturation* cells,
                                               SpeedWatch& watch)
{
    WatchPack<W> pack;
    if (!cells) {
        for (; x + W <= end; x += W) sweep_fluid<inertia, W>(p, x, ahead, parameters, pack);
    } else {
        for (; x + W <= end; x += W) {
            if (cells->covered[x / kBlock]) sweep_saturated<inertia, W>(p, x, ahead, parameters, *cells, pack);
            else sweep_fluid<inertia, W>(p, x, ahead, parameters, pack);
        }
    }
    note(pack, W, watch);
    if constexpr (W > 1)
        if (x < end) sweep_cells<inertia, W / 2>(p, x, end, ahead, parameters, cells, watch);
}

}  // namespace

template <bool inertia, class T>
void sweep_row(T* f, const Layout::Index (&slot)[D3Q19::Q], int nx, Layout::Index ahead,
               const CollisionParameters& parameters, RowSaturation* cells, SpeedWatch& watch) noexcept
{
    T* p[D3Q19::Q];
    for (int i = 0; i < D3Q19::Q; ++i) p[i] = f + slot[i];
    const CollisionParameters local = parameters;
    sweep_cells<inertia, LBM_LANES>(p, 0, nx, ahead, local, cells, watch);
}

template void sweep_row<true, double>(double*, const Layout::Index (&)[D3Q19::Q], int, Layout::Index,
                                      const CollisionParameters&, RowSaturation*, SpeedWatch&) noexcept;
template void sweep_row<false, double>(double*, const Layout::Index (&)[D3Q19::Q], int, Layout::Index,
                                       const CollisionParameters&, RowSaturation*, SpeedWatch&) noexcept;
template void sweep_row<true, float>(float*, const Layout::Index (&)[D3Q19::Q], int, Layout::Index,
                                     const CollisionParameters&, RowSaturation*, SpeedWatch&) noexcept;
template void sweep_row<false, float>(float*, const Layout::Index (&)[D3Q19::Q], int, Layout::Index,
                                      const CollisionParameters&, RowSaturation*, SpeedWatch&) noexcept;

}  // namespace lbm::LBM_ISA
