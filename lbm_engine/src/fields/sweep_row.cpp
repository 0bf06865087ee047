#include "fields/sweep_row.hpp"

#include "fields/solid_row.hpp"

namespace lbm {

#define LBM_DECLARE(isa)                                                                                               \
    namespace isa {                                                                                                    \
    template <class L, bool inertia, class T>                                                                          \
    void sweep_row(T*, const Slot (&)[L::Q], int, Slot, const CollisionParameters&, RowSaturation*,                    \
                   FlowWatch&) noexcept;                                                                               \
    void saturate(const PiecesOfRow&, RowSaturation&) noexcept;                                                        \
    void collect(const PiecesOfRow&, const RowSaturation&, PieceSums*) noexcept;                                       \
    }
LBM_DECLARE(portable)
#ifdef LBM_X86_KERNELS
LBM_DECLARE(avx2)
LBM_DECLARE(avx512)
#endif
#undef LBM_DECLARE

#ifdef LBM_X86_KERNELS
namespace {

bool runs_avx512()
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}

}  // namespace
#endif

template <class L, class T>
SweepRows<L, T> sweep_rows()
{
#ifdef LBM_X86_KERNELS
    if (runs_avx512()) return {avx512::sweep_row<L, true, T>, avx512::sweep_row<L, false, T>};
    if (__builtin_cpu_supports("avx2")) return {avx2::sweep_row<L, true, T>, avx2::sweep_row<L, false, T>};
#endif
    return {portable::sweep_row<L, true, T>, portable::sweep_row<L, false, T>};
}

SolidRowKernels solid_row_kernels()
{
#ifdef LBM_X86_KERNELS
    if (runs_avx512()) return {avx512::saturate, avx512::collect};
    if (__builtin_cpu_supports("avx2")) return {avx2::saturate, avx2::collect};
#endif
    return {portable::saturate, portable::collect};
}

template SweepRows<D3Q19, double> sweep_rows();
template SweepRows<D3Q19, float> sweep_rows();
template SweepRows<D3Q27, double> sweep_rows();
template SweepRows<D3Q27, float> sweep_rows();

}  // namespace lbm
