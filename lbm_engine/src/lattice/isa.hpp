#pragma once

namespace lbm {

/// Instruction sets for which kernels are compiled. All of them give the same bits: nothing is contracted, and sums have a fixed order.
enum class Isa { portable, avx2, avx512 };

/// The widest one that kernels were compiled for and that this processor runs.
inline Isa widest_isa()
{
#ifdef LBM_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return Isa::avx512;
    if (__builtin_cpu_supports("avx2")) return Isa::avx2;
#endif
    return Isa::portable;
}

}  // namespace lbm
