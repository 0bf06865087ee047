#define LBM_ISA portable
#define LBM_LANES 2
#include "fields/solid_row.ipp"
#include "fields/sweep_row.ipp"
