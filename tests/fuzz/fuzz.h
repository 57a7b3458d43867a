/* Functions that the fuzz targets share. A target is a file *_fuzz.c with LLVMFuzzerTestOneInput,
 * run from the project's root. */
#ifndef WH_TESTS_FUZZ_FUZZ_H
#define WH_TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned int seed);

/* A property of every input. If it is broken, the fuzzer keeps the input and prints the place. */
#define REQUIRE(condition) fuzz_require((condition), #condition, __FILE__, __LINE__)

static inline void fuzz_require(bool condition, const char *text, const char *file, int line) {
    if (!condition) {
        dprintf(STDERR_FILENO, "%s:%d: does not hold: %s\n", file, line, text);
        abort();
    }
}

/* The program's standard error is kept out of the fuzzer's log. */
static inline void fuzz_silence(void) {
    stderr = fopen("/dev/null", "w");
    REQUIRE(stderr != NULL);
}

/* One line, without control characters that a terminal would obey. */
static inline bool fuzz_is_one_line(const char *text) {
    for (; *text != '\0'; ++text) {
        if ((unsigned char)*text < 0x20 || *text == 0x7f) {
            return false;
        }
    }
    return true;
}

#endif
