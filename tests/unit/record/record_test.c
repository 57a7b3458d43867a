/* A run that did nothing at all: slices that were played, motion in them, commands. */
#include "support/support.h"

#include "record/record.h"

static void waiting_plays_slices_and_moves_nothing(void **state) {
    (void)state;
    const wh_record_t idle = {.ok = true};
    const wh_record_t waited = {.ok = true, .slices = 5};
    wh_record_t moved = {.ok = true, .slices = 5, .command_count = 1};
    moved.activity.shares[WH_SHARE_EMPTY] = 2;
    assert_true(wh_record_played_nothing(&idle));
    assert_true(wh_record_kept_still(&idle));
    assert_false(wh_record_played_nothing(&waited));
    assert_true(wh_record_kept_still(&waited));
    assert_false(wh_record_played_nothing(&moved));
    assert_false(wh_record_kept_still(&moved));
}

static void a_wafer_of_a_flow_that_was_placed_is_motion(void **state) {
    (void)state;
    static uint64_t placed[1];
    static wh_flow_tool_t tool = {.station_count = 1};
    wh_flow_t flow = {.figures = {.tool = &tool}};
    const wh_record_t record = {.ok = true, .flow = &flow};
    flow.figures.placed = (void *)placed;
    assert_true(wh_record_played_nothing(&record));
    assert_true(wh_record_moved_nothing(&record));
    placed[0] = 1;
    assert_false(wh_record_played_nothing(&record));
    assert_false(wh_record_kept_still(&record));
    assert_false(wh_record_moved_nothing(&record));
}

static void all_was_well_only_without_commands_and_errors(void **state) {
    (void)state;
    assert_true(wh_record_moved_nothing(&(wh_record_t){.ok = true}));
    assert_false(wh_record_moved_nothing(&(wh_record_t){.ok = false}));
    assert_false(wh_record_moved_nothing(&(wh_record_t){.ok = true, .command_count = 1}));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waiting_plays_slices_and_moves_nothing),
        cmocka_unit_test(a_wafer_of_a_flow_that_was_placed_is_motion),
        cmocka_unit_test(all_was_well_only_without_commands_and_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
