/* Hand-overs from the end-effector to chucks at random heights, with either order of the valves. */
#include "support/support.h"

#include "mcs/script_run.h"

#define TRANSFERS (750 / WH_TEST_SHARE)

/* The margin to eps_projz that a hand-over leaves at least, mm. */
#define LEAST_MARGIN 0.2

static double play(const char *handover) {
    char texts[5][60];
    const char *parameters[5];
    snprintf(texts[0], sizeof texts[0], "slot_height=%.17g", wh_test_uniform(650, 1250));
    snprintf(texts[1], sizeof texts[1], "chuck_height=%.17g", wh_test_uniform(650, 1250));
    snprintf(texts[2], sizeof texts[2], "dx=%.17g", wh_test_uniform(-20, 20));
    snprintf(texts[3], sizeof texts[3], "dy=%.17g", wh_test_uniform(-20, 20));
    snprintf(texts[4], sizeof texts[4], "handover=%s", handover);
    for (size_t i = 0; i < 5; ++i) {
        parameters[i] = texts[i];
    }
    const wh_script_run_options_t options = {
        .script = "tests/end_to_end/data/handover.lua", .parameters = parameters, .parameter_count = 5};
    wh_script_run_t run;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &options);
    if (outcome != WH_RUN_MET) {
        print_error("%s %s %s: %s %s\n", texts[0], texts[1], handover, run.message,
                    run.record.failure ? run.record.failure : "");
    }
    assert_int_equal(outcome, WH_RUN_MET);
    assert_int_equal(run.record.event_count, 2);
    const wh_event_t *event = &run.record.events[1].event;
    assert_int_equal(event->kind, WH_EVENT_HANDED_OVER);
    assert_true(event->measured.ready);
    const double margin = event->measured.margin_projz;
    wh_script_run_close(&run);
    return margin;
}

static void test_transfers(const char *handover) {
    double least = 1;
    for (int i = 0; i < TRANSFERS; ++i) {
        const double margin = play(handover);
        least = margin < least ? margin : least;
    }
    print_message("%s: %d transfers, least margin %.6f mm\n", handover, TRANSFERS, least);
    assert_true(least >= LEAST_MARGIN);
}

static void new_gripper_first(void **state) {
    (void)state;
    test_transfers("new_first");
}

static void within_the_same_slice(void **state) {
    (void)state;
    test_transfers("same_slice");
}

int main(void) {
    (void)wh_test_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_gripper_first),
        cmocka_unit_test(within_the_same_slice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
