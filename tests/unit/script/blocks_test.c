/* A sandbox's small blocks: none loses its bytes to another, inside of the region and beyond it. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "script/sandbox_internal.h"

enum { BLOCKS = 12000, ROUNDS = 200000, MOST = 1500 };

typedef struct {
    unsigned char *at;
    size_t size;
    unsigned char mark;
} block_t;

static uint64_t next(uint64_t *seed) {
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *seed >> 33;
}

/* Its first `size` bytes are its mark. */
static void check(const block_t *block, size_t size) {
    for (size_t i = 0; i < size; ++i) {
        assert_int_equal(block->at[i], block->mark);
    }
}

static void resize(wh_sandbox_blocks_t *blocks, block_t *block, size_t size) {
    unsigned char *const moved = wh_sandbox_block_resize(blocks, block->at, block->size, size);
    assert_non_null(moved);
    assert_int_equal((uintptr_t)moved % 16, 0);
    block->at = moved;
    check(block, block->size < size ? block->size : size);
    block->size = size;
    memset(moved, block->mark, size);
}

static void blocks_keep_their_bytes_while_others_come_and_go(void **state) {
    (void)state;
    static block_t kept[BLOCKS];
    wh_sandbox_blocks_t blocks;
    uint64_t seed = 7;
    wh_sandbox_blocks_open(&blocks);
    for (size_t i = 0; i < ROUNDS; ++i) {
        block_t *block = &kept[next(&seed) % BLOCKS];
        const uint64_t what = next(&seed) % 4;
        if (what == 0 && block->at != NULL) {
            check(block, block->size);
            wh_sandbox_block_free(&blocks, block->at, block->size);
            *block = (block_t){0};
        } else {
            block->mark = block->at != NULL ? block->mark : (unsigned char)next(&seed);
            resize(&blocks, block, 1 + next(&seed) % (what == 1 ? MOST : 64));
        }
    }
    /* With an address sanitizer there is no region. */
    assert_true(blocks.size == 0 || blocks.used > 0);
    for (size_t i = 0; i < BLOCKS; ++i) {
        if (kept[i].at != NULL) {
            check(&kept[i], kept[i].size);
            wh_sandbox_block_free(&blocks, kept[i].at, kept[i].size);
        }
    }
    wh_sandbox_blocks_close(&blocks);
}

static void a_freed_block_is_used_again_and_a_full_region_is_no_end(void **state) {
    (void)state;
    wh_sandbox_blocks_t blocks;
    wh_sandbox_blocks_open(&blocks);
    void *const first = wh_sandbox_block_resize(&blocks, NULL, 0, 100);
    wh_sandbox_block_free(&blocks, first, 100);
    void *const again = wh_sandbox_block_resize(&blocks, NULL, 0, 97);
    assert_true(blocks.size == 0 || again == first);
    wh_sandbox_block_free(&blocks, again, 97);
    blocks.used = blocks.size;
    block_t beyond = {NULL, 0, 5};
    resize(&blocks, &beyond, 200);
    resize(&blocks, &beyond, 20);
    resize(&blocks, &beyond, 2000);
    wh_sandbox_block_free(&blocks, beyond.at, beyond.size);
    wh_sandbox_blocks_close(&blocks);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_keep_their_bytes_while_others_come_and_go),
        cmocka_unit_test(a_freed_block_is_used_again_and_a_full_region_is_no_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
