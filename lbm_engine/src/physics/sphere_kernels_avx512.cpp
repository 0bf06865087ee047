#define LBM_ISA avx512
#include "physics/sphere_kernels.ipp"
