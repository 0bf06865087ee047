#define LBM_ISA portable
#define LBM_LANES 2
#include "fields/sweep_row.ipp"
