#pragma once

/// Compiles a function for each instruction set and lets the loader choose. Contraction is off, so all give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define LBM_EACH_ISA [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define LBM_EACH_ISA
#endif
