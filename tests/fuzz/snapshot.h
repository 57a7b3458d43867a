/* Lua's memory in one place, so that a sandbox returns in microseconds to its state before an
 * input. A new sandbox with the operator's words and a cell takes milliseconds, and if the old one
 * went on, one input would see another.
 *
 * A target that includes this takes its blocks from here (snapshot.c is linked with the allocator
 * of lib/script). Blocks have poisoned borders, so that AddressSanitizer sees accesses beyond them.
 * A process has one snapshot. */
#ifndef WH_TESTS_FUZZ_SNAPSHOT_H
#define WH_TESTS_FUZZ_SNAPSHOT_H

#include <stddef.h>

/* realloc and free. */
void *fuzz_arena_resize(void *block, size_t size);
void fuzz_arena_free(void *block);

/* Remembers all blocks and also `size` bytes at `object`; the other function returns to this state
 * any number of times. */
void fuzz_snapshot_add(void *object, size_t size);
void fuzz_snapshot_take(void);
void fuzz_snapshot_restore(void);

#endif
