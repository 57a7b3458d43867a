/* How fast memory can be read: a sum over all of it, by AVX2 where there is such. */
#ifndef WH_TESTS_BENCH_READ_MEMORY_H
#define WH_TESTS_BENCH_READ_MEMORY_H

#include <stddef.h>
#include <stdint.h>

#if defined(__x86_64__)
#include <immintrin.h>

/* Four sums, so that none waits for another. */
__attribute__((target("avx2"))) static inline uint64_t bench_read_avx2(const void *memory, size_t bytes) {
    const __m256i *words = (const __m256i *)memory;
    __m256i a = _mm256_setzero_si256();
    __m256i b = a;
    __m256i c = a;
    __m256i d = a;
    for (size_t i = 0; i + 4 <= bytes / sizeof *words; i += 4) {
        a = _mm256_add_epi64(a, _mm256_loadu_si256(&words[i]));
        b = _mm256_add_epi64(b, _mm256_loadu_si256(&words[i + 1]));
        c = _mm256_add_epi64(c, _mm256_loadu_si256(&words[i + 2]));
        d = _mm256_add_epi64(d, _mm256_loadu_si256(&words[i + 3]));
    }
    const __m256i all = _mm256_add_epi64(_mm256_add_epi64(a, b), _mm256_add_epi64(c, d));
    return (uint64_t)_mm256_extract_epi64(all, 0) + (uint64_t)_mm256_extract_epi64(all, 1) +
           (uint64_t)_mm256_extract_epi64(all, 2) + (uint64_t)_mm256_extract_epi64(all, 3);
}
#endif

static inline uint64_t bench_read_memory(const void *memory, size_t bytes) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        return bench_read_avx2(memory, bytes);
    }
#endif
    const uint64_t *words = (const uint64_t *)memory;
    uint64_t sum[4] = {0, 0, 0, 0};
    for (size_t i = 0; i + 4 <= bytes / sizeof *words; i += 4) {
        for (size_t k = 0; k < 4; ++k) {
            sum[k] += words[i + k];
        }
    }
    return sum[0] + sum[1] + sum[2] + sum[3];
}

#endif
