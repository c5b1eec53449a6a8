#pragma once
/// One source, several instruction sets: a loop that keeps eight running sums adds in the same order at every vector
/// width, so that the widest set the processor has is used and the bits stay the same. Elsewhere the portable loop is
/// the only one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define DRIFTLAB_WIDE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define DRIFTLAB_WIDE
#endif
