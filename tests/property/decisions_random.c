/* A trial replayed from the tape leaves what running its script whole leaves: the simulator's state and the tally, bit for bit, for
 * hundreds of trials of which many fail, are caught and go other ways. */
#include <stdlib.h>
#include <string.h>

#include "study/trial.h"
#include "support/support.h"

enum { TRIALS = 150 / WH_TEST_SHARE };

typedef struct {
    wh_tally_t replayed, whole;
    uint64_t replays;
} comparison_t;

static void compare_tallies(const wh_tally_t *one, const wh_tally_t *other) {
    assert_int_equal(one->trials, other->trials);
    assert_int_equal(one->met, other->met);
    assert_int_equal(one->ended, other->ended);
    assert_memory_equal(one->events, other->events, sizeof one->events);
    assert_int_equal(one->expectations.count, other->expectations.count);
    for (size_t i = 0; i < one->expectations.count; ++i) {
        assert_string_equal(one->expectations.rows[i].text, other->expectations.rows[i].text);
        assert_int_equal(one->expectations.rows[i].bad, other->expectations.rows[i].bad);
    }
    assert_int_equal(one->errors.count, other->errors.count);
    assert_memory_equal(one->wafers, other->wafers, one->wafer_count * sizeof *one->wafers);
    assert_int_equal(wh_relations_size(&one->relations), wh_relations_size(&other->relations));
    for (size_t i = 0; i < wh_relations_size(&one->relations); ++i) {
        assert_true(*wh_relations_number(&one->relations, i) == *wh_relations_number(&other->relations, i));
    }
    assert_int_equal(one->worst_count, other->worst_count);
    for (size_t i = 0; i < one->worst_count; ++i) {
        assert_int_equal(one->worst[i].trial, other->worst[i].trial);
        assert_true(one->worst[i].off >= other->worst[i].off && one->worst[i].off <= other->worst[i].off);
    }
}

static void play(wh_worker_t *worker, uint64_t trial, wh_tally_t *tally) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    const size_t wafer_count = tally->wafer_count;
    wh_tally_free(tally);
    wh_tally_init(tally, wafer_count);
    assert_true(wh_worker_play(worker, trial, tally, message));
}

/* Plays a trial as the study does, and once more with a reason to run the script whole. */
static void compare_trial(wh_worker_t *worker, wh_study_t *study, comparison_t *comparison, uint64_t trial) {
    const char *whole = study->whole;
    study->whole = "to compare with";
    play(worker, trial, &comparison->whole);
    assert_true(worker->outcome.whole);
    study->whole = whole;
    play(worker, trial, &comparison->replayed);
    if (!worker->outcome.whole) {
        assert_int_equal(wh_simulator_hash(&worker->simulator), worker->hash);
        compare_tallies(&comparison->replayed, &comparison->whole);
        ++comparison->replays;
    }
}

/* Of so many trials at least `least` and at most `most` are replayed. */
static void compare(const char *script, const char *const parameters[], size_t parameter_count,
                    uint64_t least, uint64_t most) {
    static wh_study_t study;
    static wh_worker_t worker;
    comparison_t comparison = {.replays = 0};
    memset(&study, 0, sizeof study);
    study.run = (wh_script_run_options_t){
        .script = script, .parameters = parameters, .parameter_count = parameter_count};
    study.run.limits.print_to = stderr;
    study.seed = 5;
    study.trials = TRIALS;
    assert_true(wh_study_open(&study));
    wh_worker_open(&worker, &study);
    wh_tally_init(&comparison.replayed, study.wafer_count);
    wh_tally_init(&comparison.whole, study.wafer_count);
    for (uint64_t trial = 0; trial < study.trials; ++trial) {
        compare_trial(&worker, &study, &comparison, trial);
    }
    assert_in_range(comparison.replays, least, most);
    wh_tally_free(&comparison.replayed);
    wh_tally_free(&comparison.whole);
    wh_worker_close(&worker);
    wh_study_close(&study);
}

#define RETRY "tests/end_to_end/data/study_retry.lua"

static void picks_and_handovers(void **state) {
    (void)state;
    compare(RETRY, NULL, 0, TRIALS * 19 / 30, TRIALS * 29 / 30);
}

static void between_slices(void **state) {
    (void)state;
    static const char *const parameters[] = {"check=swept", "seat=true"};
    compare(RETRY, parameters, 2, TRIALS * 19 / 30, TRIALS * 29 / 30);
}

static void delayed_vacuum(void **state) {
    (void)state;
    static const char *const parameters[] = {"vacuum=delayed", "settle=true"};
    compare(RETRY, parameters, 2, TRIALS * 19 / 30, TRIALS * 29 / 30);
}

/* Where motion control waits for a sensor its slices shift: most trials cannot be replayed, and are not. */
static void late_valves_and_vacuum(void **state) {
    (void)state;
    static const char *const parameters[] = {"valve=0.002", "late=0.01", "z=0.3"};
    compare(RETRY, parameters, 3, 0, TRIALS / 2);
}

static void an_example(void **state) {
    (void)state;
    compare("lua/examples/07_study.lua", NULL, 0, TRIALS * 14 / 15, TRIALS);
}

static void a_script_that_measures_is_never_replayed(void **state) {
    (void)state;
    static const char *const parameters[] = {"by=offset", "by=frames"};
    compare(RETRY, &parameters[0], 1, 0, 0);
    compare(RETRY, &parameters[1], 1, 0, 0);
}

static void collisions_are_never_replayed(void **state) {
    (void)state;
    static const char *const parameters[] = {"collision=true"};
    static wh_study_t study;
    memset(&study, 0, sizeof study);
    study.run = (wh_script_run_options_t){.script = RETRY, .parameters = parameters, .parameter_count = 1};
    assert_true(wh_study_open(&study));
    assert_non_null(study.whole);
    wh_study_close(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picks_and_handovers),
        cmocka_unit_test(between_slices),
        cmocka_unit_test(delayed_vacuum),
        cmocka_unit_test(late_valves_and_vacuum),
        cmocka_unit_test(an_example),
        cmocka_unit_test(a_script_that_measures_is_never_replayed),
        cmocka_unit_test(collisions_are_never_replayed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
