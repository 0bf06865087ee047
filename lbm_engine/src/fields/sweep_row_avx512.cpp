#define LBM_ISA avx512
#define LBM_LANES 8
#include "fields/solid_row.ipp"
#include "fields/sweep_row.ipp"
