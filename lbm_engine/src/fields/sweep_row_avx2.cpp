#define LBM_ISA avx2
#define LBM_LANES 4
#include "fields/solid_row.ipp"
#include "fields/sweep_row.ipp"
