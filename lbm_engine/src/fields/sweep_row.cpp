#include "fields/sweep_row.hpp"

#include "fields/solid_row.hpp"
#include "lattice/isa.hpp"

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

template <class L, class T>
SweepRows<L, T> sweep_rows()
{
#ifdef LBM_X86_KERNELS
    const Isa isa = widest_isa();
    if (isa == Isa::avx512) return {avx512::sweep_row<L, true, T>, avx512::sweep_row<L, false, T>};
    if (isa == Isa::avx2) return {avx2::sweep_row<L, true, T>, avx2::sweep_row<L, false, T>};
#endif
    return {portable::sweep_row<L, true, T>, portable::sweep_row<L, false, T>};
}

SolidRowKernels solid_row_kernels()
{
#ifdef LBM_X86_KERNELS
    const Isa isa = widest_isa();
    if (isa == Isa::avx512) return {avx512::saturate, avx512::collect};
    if (isa == Isa::avx2) return {avx2::saturate, avx2::collect};
#endif
    return {portable::saturate, portable::collect};
}

template SweepRows<D3Q19, double> sweep_rows();
template SweepRows<D3Q19, float> sweep_rows();
template SweepRows<D3Q27, double> sweep_rows();
template SweepRows<D3Q27, float> sweep_rows();

}  // namespace lbm
