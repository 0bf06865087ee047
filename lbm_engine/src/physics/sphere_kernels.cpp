#include "physics/sphere_kernels.hpp"

#include "lattice/isa.hpp"

namespace lbm {

namespace portable {
extern const SphereKernels kSphereKernels;
}
#ifdef LBM_X86_KERNELS
namespace avx2 {
extern const SphereKernels kSphereKernels;
}
namespace avx512 {
extern const SphereKernels kSphereKernels;
}
#endif

const SphereKernels& sphere_kernels()
{
    switch (widest_isa()) {
#ifdef LBM_X86_KERNELS
    case Isa::avx512:
        return avx512::kSphereKernels;
    case Isa::avx2:
        return avx2::kSphereKernels;
#endif
    default:
        return portable::kSphereKernels;
    }
}

}  // namespace lbm
