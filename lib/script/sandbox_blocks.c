/* Small blocks of a sandbox's Lua, out of a region of its own: Lua tells the size of a block that it gives
 * back, so taking one and giving it back are some ten instructions each. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sandbox_internal.h"

#define STEP ((size_t)16)

/* Under an address sanitizer each block stands by itself, so that it sees what is read beside one. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define REGION_BYTES ((size_t)0)
#endif
#endif
#if !defined(REGION_BYTES) && defined(__SANITIZE_ADDRESS__)
#define REGION_BYTES ((size_t)0)
#endif
#if !defined(REGION_BYTES)
/* Most scripts need less. All blocks beyond it are taken from the heap, so no script can spread its freed
 * ones over much more memory than its cap. Pages that are never used cost nothing. */
#define REGION_BYTES ((size_t)4 << 20)
#endif

void wh_sandbox_blocks_open(wh_sandbox_blocks_t *blocks) {
    memset(blocks, 0, sizeof *blocks);
    blocks->region = REGION_BYTES > 0 ? malloc(REGION_BYTES) : NULL;
    blocks->size = blocks->region != NULL ? REGION_BYTES : 0;
}

void wh_sandbox_blocks_close(wh_sandbox_blocks_t *blocks) {
    free(blocks->region);
}

static bool is_inside(const wh_sandbox_blocks_t *blocks, const void *block) {
    return (uintptr_t)block - (uintptr_t)blocks->region < blocks->size;
}

static size_t kind_of(size_t size) {
    return (size + STEP - 1) / STEP;
}

static void *take(wh_sandbox_blocks_t *blocks, size_t size) {
    const size_t kind = kind_of(size);
    if (kind >= WH_SANDBOX_BLOCK_KINDS) {
        return malloc(size);
    }
    void *const block = blocks->free[kind];
    if (block != NULL) {
        memcpy(&blocks->free[kind], block, sizeof(void *));
        return block;
    }
    if (kind * STEP > blocks->size - blocks->used) {
        return malloc(size);
    }
    blocks->used += kind * STEP;
    return blocks->region + blocks->used - kind * STEP;
}

void wh_sandbox_block_free(wh_sandbox_blocks_t *blocks, void *block, size_t held) {
    if (!is_inside(blocks, block)) {
        free(block);
        return;
    }
    memcpy(block, &blocks->free[kind_of(held)], sizeof(void *));
    blocks->free[kind_of(held)] = block;
}

void *wh_sandbox_block_resize(wh_sandbox_blocks_t *blocks, void *block, size_t held, size_t size) {
    if (block == NULL) {
        return take(blocks, size);
    }
    if (!is_inside(blocks, block)) {
        return realloc(block, size);
    }
    if (kind_of(held) == kind_of(size)) {
        return block;
    }
    void *const moved = take(blocks, size);
    if (moved != NULL) {
        memcpy(moved, block, held < size ? held : size);
        wh_sandbox_block_free(blocks, block, held);
    }
    return moved;
}
