#include "snapshot.h"

#include <sanitizer/asan_interface.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

/* The allocator of the sandbox, on the arena; the linker then leaves out the one of lib/script. */
#define malloc(size) fuzz_arena_resize(NULL, size)
#define realloc fuzz_arena_resize
#define free fuzz_arena_free
#include "script/sandbox_blocks.c"
#undef malloc
#undef realloc
#undef free

#define ARENA ((size_t)64 << 20)
#define CLASSES 26
#define BORDER 32 /* before and behind each block; the class and size stand before it */
#define OBJECTS 8
#define SHADOW 8 /* bytes for each of AddressSanitizer's */

typedef struct {
    uint64_t size;
    uint32_t class;
} header_t;

/* Blocks of 64 << class bytes, taken from the end or from a list of free ones; a free block begins
 * with a pointer to the next. */
static struct {
    size_t used;
    uint8_t *free[CLASSES];
} arena;

static uint8_t bytes[ARENA] __attribute__((aligned(64)));

static struct {
    size_t used;
    uint8_t *bytes, *shadow;
    uint8_t *free[CLASSES];
    struct {
        void *object, *copy;
        size_t size;
    } objects[OBJECTS];
    size_t object_count;
} snapshot;

/* The memory of these functions is poisoned for all others, and their paths do not count as coverage. */
#define UNCHECKED __attribute__((no_sanitize("address", "coverage")))

static UNCHECKED uint8_t *take_block(uint32_t class) {
    uint8_t *block = arena.free[class];
    if (block) {
        arena.free[class] = *(uint8_t **)(void *)block;
        return block;
    }
    const size_t size = (size_t)64 << class;
    if (size > ARENA - arena.used) {
        return NULL;
    }
    block = bytes + arena.used;
    arena.used += size;
    ASAN_POISON_MEMORY_REGION(block, size);
    return block;
}

static UNCHECKED void *allocate(size_t size) {
    uint32_t class = 0;
    while (((size_t)64 << class) < size + (size_t)2 * BORDER && class < CLASSES - 1) {
        ++class;
    }
    uint8_t *const block = ((size_t)64 << class) < size + (size_t)2 * BORDER ? NULL : take_block(class);
    if (!block) {
        return NULL;
    }
    header_t *const header = (header_t *)(void *)block;
    header->size = size;
    header->class = class;
    ASAN_UNPOISON_MEMORY_REGION(block + BORDER, size);
    return block + BORDER;
}

static UNCHECKED size_t size_of(const uint8_t *block) {
    return ((const header_t *)(const void *)(block - BORDER))->size;
}

UNCHECKED void fuzz_arena_free(void *memory) {
    if (!memory) {
        return;
    }
    uint8_t *const block = (uint8_t *)memory - BORDER;
    const uint32_t class = ((const header_t *)(const void *)block)->class;
    ASAN_POISON_MEMORY_REGION(memory, size_of(memory));
    *(uint8_t **)(void *)block = arena.free[class];
    arena.free[class] = block;
}

void *fuzz_arena_resize(void *memory, size_t size) {
    void *const moved = allocate(size);
    if (memory && moved) {
        const size_t held = size_of(memory);
        memcpy(moved, memory, held < size ? held : size);
        fuzz_arena_free(memory);
    }
    return moved;
}

/* ------------------------------------------------------------------------------------------------ snapshots */

static uint8_t *shadow_of_arena(void) {
    size_t scale = 0;
    size_t offset = 0;
    __asan_get_shadow_mapping(&scale, &offset);
    return (uint8_t *)(((uintptr_t)bytes >> scale) + offset);
}

/* It is copied in pieces: AddressSanitizer would check a call of memcpy. Blocks are multiples of 64. */
static UNCHECKED __attribute__((noinline)) void copy_blocks(uint8_t *to, const uint8_t *from, size_t size) {
    for (size_t i = 0; i < size; i += SHADOW) {
        __builtin_memcpy(to + i, from + i, SHADOW);
        __asm__ volatile("" ::: "memory");
    }
}

static void *room(size_t size) {
    void *const memory = malloc(size);
    REQUIRE(memory != NULL);
    return memory;
}

void fuzz_snapshot_add(void *object, size_t size) {
    REQUIRE(snapshot.object_count < OBJECTS);
    snapshot.objects[snapshot.object_count].object = object;
    snapshot.objects[snapshot.object_count++].size = size;
}

void fuzz_snapshot_take(void) {
    snapshot.used = arena.used;
    memcpy(snapshot.free, arena.free, sizeof arena.free);
    snapshot.bytes = room(arena.used);
    snapshot.shadow = room(arena.used / SHADOW);
    copy_blocks(snapshot.bytes, bytes, arena.used);
    copy_blocks(snapshot.shadow, shadow_of_arena(), arena.used / SHADOW);
    for (size_t i = 0; i < snapshot.object_count; ++i) {
        snapshot.objects[i].copy = room(snapshot.objects[i].size);
        memcpy(snapshot.objects[i].copy, snapshot.objects[i].object, snapshot.objects[i].size);
    }
}

void fuzz_snapshot_restore(void) {
    copy_blocks(bytes, snapshot.bytes, snapshot.used);
    copy_blocks(shadow_of_arena(), snapshot.shadow, snapshot.used / SHADOW);
    ASAN_POISON_MEMORY_REGION(bytes + snapshot.used, arena.used - snapshot.used);
    arena.used = snapshot.used;
    memcpy(arena.free, snapshot.free, sizeof arena.free);
    for (size_t i = 0; i < snapshot.object_count; ++i) {
        memcpy(snapshot.objects[i].object, snapshot.objects[i].copy, snapshot.objects[i].size);
    }
}
