/* Lua's memory in one place, so that a sandbox goes back in microseconds to where it was before an input: making a new one
 * with the operator's words and a cell takes milliseconds, and going on in the old one would let one input see another.
 *
 * A target that includes this takes its blocks from here (snapshot.c is linked with the allocator of lib/script). Blocks have
 * poisoned borders, so that AddressSanitizer sees what goes beyond them. One snapshot a process. */
#ifndef WH_TESTS_FUZZ_SNAPSHOT_H
#define WH_TESTS_FUZZ_SNAPSHOT_H

#include <stddef.h>

/* realloc and free. */
void *fuzz_arena_resize(void *block, size_t size);
void fuzz_arena_free(void *block);

/* Remembers all blocks and, besides, `size` bytes at `object`; again and again back to that. */
void fuzz_snapshot_add(void *object, size_t size);
void fuzz_snapshot_take(void);
void fuzz_snapshot_restore(void);

#endif
