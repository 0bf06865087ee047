#define LBM_ISA avx2
#include "physics/sphere_kernels.ipp"
