#define LBM_ISA portable
#include "physics/sphere_kernels.ipp"
