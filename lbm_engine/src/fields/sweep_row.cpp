#include "fields/sweep_row.hpp"

namespace lbm {

#define LBM_DECLARE(isa)                                                                                               \
    namespace isa {                                                                                                    \
    template <bool inertia, class T>                                                                                   \
    void sweep_row(T*, const Layout::Index (&)[D3Q19::Q], int, Layout::Index, const CollisionParameters&,              \
                   RowSaturation*, SpeedWatch&) noexcept;                                                              \
    }
LBM_DECLARE(portable)
#ifdef LBM_X86_KERNELS
LBM_DECLARE(avx2)
LBM_DECLARE(avx512)
#endif
#undef LBM_DECLARE

template <class T>
SweepRows<T> sweep_rows()
{
#ifdef LBM_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return {avx512::sweep_row<true, T>, avx512::sweep_row<false, T>};
    if (__builtin_cpu_supports("avx2")) return {avx2::sweep_row<true, T>, avx2::sweep_row<false, T>};
#endif
    return {portable::sweep_row<true, T>, portable::sweep_row<false, T>};
}

template SweepRows<double> sweep_rows();
template SweepRows<float> sweep_rows();

}  // namespace lbm
