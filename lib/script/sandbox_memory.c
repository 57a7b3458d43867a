/* The sandbox's allocator: a cap, a high-water mark, and a price for large blocks. */
#include "sandbox_internal.h"

/* Copying and clearing take time without counted instructions: one step for each 64 bytes of a long string
 * or a large block. */
#define STEP_SHIFT 6
#define LONG_STRING_BYTES 512
#define LARGE_BLOCK_BYTES ((size_t)64 << 10)

static void charge_block(wh_sandbox_t *sandbox, bool is_string, size_t size) {
    if (size >= LARGE_BLOCK_BYTES && size > sandbox->largest_block) {
        sandbox->largest_block = size;
    }
    if (size >= (is_string ? LONG_STRING_BYTES : LARGE_BLOCK_BYTES)) {
        wh_sandbox_spend(sandbox, size >> STEP_SHIFT);
    }
}

/* After a refusal Lua collects all garbage and tries again. Near the cap each small table could cost such a
 * collection, so its work is charged as well. */
static void *refuse_block(wh_sandbox_t *sandbox) {
    sandbox->refused = true;
    wh_sandbox_spend(sandbox, sandbox->memory >> STEP_SHIFT);
    if (sandbox->running != NULL && sandbox->job != NULL) {
        wh_sandbox_find_place(sandbox, sandbox->running, sandbox->refused_place);
    }
    return NULL;
}

/* Shrinking never fails, because Lua relies on it. */
static void *shrink(wh_sandbox_t *sandbox, void *block, size_t held, size_t size) {
    void *const moved = wh_sandbox_block_resize(&sandbox->blocks, block, held, size);
    if (moved == NULL) {
        return block;
    }
    sandbox->memory -= held - size;
    return moved;
}

static void *grow(wh_sandbox_t *sandbox, void *block, size_t held, size_t size) {
    void *const moved = size - held <= sandbox->memory_cap - sandbox->memory
                            ? wh_sandbox_block_resize(&sandbox->blocks, block, held, size)
                            : NULL;
    if (moved == NULL) {
        return refuse_block(sandbox);
    }
    sandbox->memory += size - held;
    if (sandbox->memory > wh_sandbox_memory_brim(sandbox)) {
        sandbox->brimming = true;
        wh_sandbox_alarm(sandbox);
    }
    if (sandbox->memory > sandbox->memory_high_water) {
        sandbox->memory_high_water = sandbox->memory;
    }
    return moved;
}

/* Lua passes a new object's type as the old size of a null block. */
void *wh_sandbox_allocate(void *opaque, void *block, size_t old_size, size_t new_size) {
    wh_sandbox_t *const sandbox = opaque;
    const size_t held = block != NULL ? old_size : 0;
    if (new_size == 0) {
        if (block != NULL) {
            wh_sandbox_block_free(&sandbox->blocks, block, held);
        }
        sandbox->memory -= held;
        return NULL;
    }
    if (new_size <= held) {
        return shrink(sandbox, block, held, new_size);
    }
    void *const moved = grow(sandbox, block, held, new_size);
    if (moved != NULL) {
        charge_block(sandbox, block == NULL && old_size == LUA_TSTRING, new_size);
    }
    return moved;
}

size_t wh_sandbox_memory_brim(const wh_sandbox_t *sandbox) {
    return sandbox->memory_cap - sandbox->memory_cap / 8;
}

size_t wh_sandbox_memory_high_water(const wh_sandbox_t *sandbox) {
    return sandbox->memory_high_water;
}
