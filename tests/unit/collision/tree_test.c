/* The tree over resting boxes finds what a plain search finds. */
#include "collision/tree.h"
#include "support/pose.h"
#include "support/random.h"

enum { MOST = 300, QUERIES = 200 };

static uint64_t seed = 7;
static wh_box_t boxes[MOST];
static wh_box_t nodes[1024];
static int32_t order[MOST];
static int32_t leaf_of[MOST];
static uint64_t codes[MOST];

static double draw(double low, double high) {
    return low + (high - low) * (double)(wh_test_splitmix(&seed) >> 11) * 0x1p-53;
}

static wh_box_t draw_box(double reach, double size) {
    wh_box_t box;
    box.low = wh_vec3(draw(-reach, reach), draw(-reach, reach), draw(-reach, reach));
    const wh_vec3_t by = {draw(0, size), draw(0, size), draw(0, size)};
    box.high = wh_vec3_add(&box.low, &by);
    return box;
}

static wh_tree_t plant(size_t count) {
    wh_tree_t tree = {.nodes = nodes, .order = order, .leaf_of = leaf_of, .codes = codes, .count = count};
    assert_true(wh_tree_nodes(count) <= sizeof nodes / sizeof nodes[0]);
    wh_tree_build(&tree, boxes);
    return tree;
}

static bool is_among(const int32_t found[], size_t count, int32_t item) {
    for (size_t i = 0; i < count; ++i) {
        if (found[i] == item) {
            return true;
        }
    }
    return false;
}

static void expect_the_same(const wh_tree_t *tree, const wh_box_t *box) {
    int32_t found[MOST];
    size_t expected = 0;
    const size_t count = wh_tree_find(tree, box, found, MOST);
    for (size_t i = 0; i < tree->count; ++i) {
        const bool there = wh_box_overlap(&boxes[i], box);
        expected += there ? 1 : 0;
        assert_int_equal(there, is_among(found, count, (int32_t)i));
    }
    assert_int_equal(count, expected);
}

static void finds_what_a_search_finds(void **state) {
    static const size_t counts[] = {0, 1, 2, 3, 4, 5, 63, 64, 65, MOST};
    (void)state;
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; ++c) {
        for (size_t i = 0; i < counts[c]; ++i) {
            boxes[i] = draw_box(1000, 200);
        }
        const wh_tree_t tree = plant(counts[c]);
        for (int q = 0; q < QUERIES; ++q) {
            const wh_box_t box = draw_box(1200, 500);
            expect_the_same(&tree, &box);
        }
    }
}

static void follows_boxes_that_change(void **state) {
    (void)state;
    for (size_t i = 0; i < MOST; ++i) {
        boxes[i] = draw_box(1000, 50);
    }
    wh_tree_t tree = plant(MOST);
    for (int change = 0; change < 400; ++change) {
        const int32_t item = (int32_t)(wh_test_splitmix(&seed) % MOST);
        boxes[item] = change % 5 == 0 ? wh_box_empty() : draw_box(1500, 300);
        wh_tree_set(&tree, item, &boxes[item]);
        const wh_box_t kept = wh_tree_box(&tree, item);
        assert_memory_equal(&kept, &boxes[item], sizeof kept);
        const wh_box_t box = draw_box(1500, 500);
        expect_the_same(&tree, &box);
    }
}

static void far_away_and_empty(void **state) {
    (void)state;
    boxes[0] = wh_box_empty();
    boxes[1] = draw_box(1, 1);
    boxes[1].low.x = -1e9;
    boxes[1].high.x = 1e9;
    const wh_tree_t tree = plant(2);
    const wh_box_t all = {{-1e20, -1e20, -1e20}, {1e20, 1e20, 1e20}};
    expect_the_same(&tree, &all);
    const wh_box_t nothing = wh_box_empty();
    const wh_box_t grown = wh_box_grown(&nothing, 1e6);
    assert_false(wh_box_overlap(&grown, &all));
    expect_the_same(&tree, &grown);
}

static void says_how_many_there_are_beyond_its_room(void **state) {
    (void)state;
    int32_t found[3] = {-7, -7, -7};
    for (size_t i = 0; i < 10; ++i) {
        boxes[i] = draw_box(1, 1);
    }
    const wh_tree_t tree = plant(10);
    const wh_box_t all = {{-100, -100, -100}, {100, 100, 100}};
    assert_int_equal(wh_tree_find(&tree, &all, found, 2), 10);
    assert_int_equal(found[2], -7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_what_a_search_finds),
        cmocka_unit_test(follows_boxes_that_change),
        cmocka_unit_test(far_away_and_empty),
        cmocka_unit_test(says_how_many_there_are_beyond_its_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
