/* Counts the calls of the heap in the whole program: malloc and its kin are replaced by functions
 * that count; under sanitizers the sanitizer's counts are used. Include it in one file of a test
 * and run its own test too. If a C library has other names, nothing is counted and
 * WH_TEST_COUNTS_HEAP is not defined. */
#ifndef WH_TESTS_SUPPORT_HEAP_H
#define WH_TESTS_SUPPORT_HEAP_H

#include "support/support.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) || __has_feature(thread_sanitizer)
#define WH_TEST_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WH_TEST_SANITIZED
#endif

#if defined(WH_TEST_SANITIZED) || defined(__GLIBC__)
#define WH_TEST_COUNTS_HEAP
static volatile unsigned long calls; /* compilers assume that malloc changes no variable of ours */
#endif

#if defined(WH_TEST_SANITIZED)
int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void *memory, size_t size),
                                              void (*free_hook)(const volatile void *memory));

static void count_malloc(const volatile void *memory, size_t size) {
    (void)memory;
    (void)size;
    calls = calls + 1;
}

static void count_free(const volatile void *memory) {
    (void)memory;
    calls = calls + 1;
}

__attribute__((constructor)) static void count_what_sanitizers_do(void) {
    (void)__sanitizer_install_malloc_and_free_hooks(count_malloc, count_free);
}
#elif defined(__GLIBC__)
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void __libc_free(void *memory);

void *malloc(size_t size) {
    calls = calls + 1;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    calls = calls + 1;
    return __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size) {
    calls = calls + 1;
    return __libc_realloc(memory, size);
}

void free(void *memory) {
    calls = calls + 1;
    __libc_free(memory);
}
#endif

#if defined(WH_TEST_COUNTS_HEAP)
/* Shows that calls are counted. */
static void the_count_counts(void **state) {
    (void)state;
    const unsigned long before = calls;
    void *volatile memory = malloc(1);
    free(memory);
    assert_int_equal(calls - before, 2);
}
#else
static void the_count_counts(void **state) {
    (void)state;
    skip();
}
#endif

/* The number of calls until now; 0 if nothing is counted. */
static inline unsigned long heap_calls(void) {
#if defined(WH_TEST_COUNTS_HEAP)
    return calls;
#else
    return 0;
#endif
}

#endif
