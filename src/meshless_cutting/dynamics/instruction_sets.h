// Compiles a function for several instruction sets; the program takes the best when it starts.
#pragma once

// Not fused (-ffp-contract=off), in the same order: the same bits from all of them. For free functions that are not templates.
// Not under ThreadSanitizer: it would trace the choice, which is made before its own start, and fall.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define MESHLESS_CUTTING_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define MESHLESS_CUTTING_CLONES
#endif
