/* The trials that are done and left, and threads that share a few: each trial once, the same sums.
 * A study's state grows with it, and the state of another study is refused. */

#include "math/hash.h"
#include "study/checkpoint.h"
#include "support/support.h"

/* ---------------------------------------------------------------------------------------------- stretches */

enum { TRIALS = 200 };

/* The set contains exactly the added trials, in order, and no two stretches touch. */
static void check_stretches(const wh_stretches_t *stretches, const bool wanted[TRIALS]) {
    uint64_t trials = 0;
    uint64_t before = 0;
    for (size_t i = 0; i < stretches->count; ++i) {
        const wh_stretch_t *stretch = &stretches->items[i];
        assert_true(stretch->count > 0 && (i == 0 || stretch->first > before));
        for (uint64_t trial = stretch->first; trial < stretch->first + stretch->count; ++trial) {
            assert_true(wanted[trial]);
            ++trials;
        }
        before = stretch->first + stretch->count;
    }
    uint64_t expected = 0;
    for (size_t trial = 0; trial < TRIALS; ++trial) {
        expected += wanted[trial] ? 1 : 0;
    }
    assert_int_equal(trials, expected);
    assert_int_equal(stretches->trials, expected);
}

static bool is_free(const bool has[TRIALS], wh_stretch_t stretch) {
    for (uint64_t i = 0; i < stretch.count; ++i) {
        if (has[stretch.first + i]) {
            return false;
        }
    }
    return stretch.count > 0;
}

static void stretches_hold_what_was_added(void **state) {
    (void)state;
    (void)wh_test_seed();
    for (int round = 0; round < 200; ++round) {
        wh_stretches_t done = {0};
        wh_stretches_t rest = {0};
        bool has[TRIALS] = {false};
        for (int i = 0; i < 60; ++i) {
            const uint64_t first = wh_test_random() % TRIALS;
            const uint64_t most = TRIALS - first < 12 ? TRIALS - first : 12;
            const wh_stretch_t stretch = {first, wh_test_random() % (most + 1)};
            const bool wanted = is_free(has, stretch);
            assert_int_equal(wh_stretches_add(&done, stretch), wanted);
            memset(&has[first], 1, wanted ? stretch.count : 0);
            check_stretches(&done, has);
        }
        for (size_t i = 0; i < TRIALS; ++i) {
            has[i] = !has[i];
        }
        wh_stretches_rest(&rest, &done, TRIALS);
        check_stretches(&rest, has);
        while (rest.trials > 0) {
            const uint64_t first = rest.items[0].first;
            const wh_stretch_t taken = wh_stretches_take(&rest, 1 + wh_test_random() % 9);
            assert_true(taken.count > 0 && taken.first == first);
            memset(&has[first], 0, taken.count);
            check_stretches(&rest, has);
        }
        assert_int_equal(wh_stretches_take(&rest, 5).count, 0);
        wh_stretches_free(&done);
        wh_stretches_free(&rest);
    }
}

/* --------------------------------------------------------------------------------------------------- pool */

static void open_study(wh_study_t *study, uint64_t trials) {
    memset(study, 0, sizeof *study);
    study->run =
        (wh_script_run_options_t){.script = "lua/examples/07_study.lua", .limits = {.print_to = stderr}};
    study->seed = 4;
    study->trials = trials;
    assert_true(wh_study_open(study));
}

/* Plays the trials that `known` lacks, and puts all of them into `progress`. */
static void play(const wh_study_t *study, size_t threads, const wh_progress_t *known,
                 wh_progress_t *progress) {
    wh_pool_t pool;
    wh_stretches_t rest = {0};
    assert_true(wh_pool_open(&pool, study, threads));
    if (known) {
        wh_progress_merge(&pool.progress, known);
    }
    wh_stretches_rest(&rest, &pool.progress.done, study->trials);
    wh_pool_queue(&pool, rest.items, rest.count, true);
    while (!wh_pool_look(&pool).idle) {
        wh_pool_wait(&pool, 5);
    }
    assert_false(wh_pool_look(&pool).failed);
    wh_progress_init(progress, study);
    wh_progress_merge(progress, &pool.progress);
    wh_tally_sort(&progress->tally);
    wh_pool_close(&pool);
    wh_stretches_free(&rest);
}

/* Whatever was in their place before, the first and the last are empty. */
static void nothing_is_left_of_what_was_there(void **state) {
    static const wh_stretches_t none;
    static wh_study_t study;
    wh_progress_t progress;
    (void)state;
    open_study(&study, 3);
    memset(&progress, 0xff, sizeof progress);
    wh_progress_init(&progress, &study);
    assert_memory_equal(&progress.done, &none, sizeof none);
    assert_true(wh_stretches_add(&progress.done, (wh_stretch_t){1, 2}));
    progress.done.trials = UINT64_MAX;
    progress.done.capacity = SIZE_MAX;
    wh_progress_free(&progress);
    assert_memory_equal(&progress.done, &none, sizeof none);
    wh_study_close(&study);
}

static void threads_share_few_trials(void **state) {
    static wh_study_t study;
    (void)state;
    open_study(&study, 37);
    char *first = NULL;
    for (size_t threads = 1; threads <= 5; ++threads) {
        wh_progress_t progress;
        play(&study, threads, NULL, &progress);
        assert_int_equal(progress.done.count, 1);
        assert_int_equal(progress.done.items[0].count, 37);
        assert_int_equal(progress.tally.trials, 37);
        char *text = wh_checkpoint_text(&study, &progress);
        if (first) {
            assert_string_equal(text, first);
            free(text);
        } else {
            first = text;
        }
        wh_progress_free(&progress);
    }
    free(first);
    wh_study_close(&study);
}

/* Another rank gets trials from the front, each once. */
static void others_take_from_the_front(void **state) {
    static wh_study_t study;
    wh_pool_t pool;
    const wh_stretch_t all = {0, 100};
    (void)state;
    open_study(&study, 100);
    assert_true(wh_pool_open(&pool, &study, 1));
    wh_pool_stop(&pool);
    while (!wh_pool_look(&pool).idle) {
        wh_pool_wait(&pool, 5);
    }
    wh_pool_queue(&pool, &all, 1, false);
    assert_int_equal(wh_pool_take(&pool, 30).count, 30);
    assert_int_equal(wh_pool_take(&pool, 30).first, 30);
    assert_int_equal(wh_pool_look(&pool).queued, 40);
    assert_int_equal(wh_pool_take(&pool, 90).count, 40);
    assert_int_equal(wh_pool_take(&pool, 90).count, 0);
    wh_pool_close(&pool);
    wh_study_close(&study);
}

/* -------------------------------------------------------------------------------------------------- state */

static void a_state_grows_with_its_study(void **state) {
    static wh_study_t study;
    wh_progress_t some;
    wh_progress_t taken;
    wh_progress_t grown;
    wh_progress_t whole;
    char message[300] = "";
    (void)state;
    open_study(&study, 60);
    play(&study, 2, NULL, &some);
    char *text = wh_checkpoint_text(&study, &some);
    study.trials = 95;
    wh_progress_init(&taken, &study);
    assert_true(wh_checkpoint_read(&study, text, strlen(text), &taken, message, sizeof message));
    assert_int_equal(taken.done.trials, 60);
    play(&study, 2, &taken, &grown);
    play(&study, 3, NULL, &whole);
    char *one = wh_checkpoint_text(&study, &grown);
    char *other = wh_checkpoint_text(&study, &whole);
    assert_string_equal(one, other);

    wh_progress_t refused;
    wh_progress_init(&refused, &study);
    study.trials = 59;
    assert_false(wh_checkpoint_read(&study, text, strlen(text), &refused, message, sizeof message));
    assert_string_equal(message, "of a longer study: its trial 59 is done (expected at least 60 trials)");
    study.trials = 60;
    ++study.seed;
    assert_false(wh_checkpoint_read(&study, text, strlen(text), &refused, message, sizeof message));
    assert_string_equal(message,
                        "of another study: its seed is \"0000000000000004\" (expected \"0000000000000005\")");
    --study.seed;
    char *lines = strstr(text, "\"lines\":\"");
    assert_non_null(lines);
    lines[strlen("\"lines\":\"") + 2] = 'x';
    assert_false(wh_checkpoint_read(&study, text, strlen(text), &refused, message, sizeof message));
    assert_non_null(strstr(message, "damaged: something in it was changed"));
    assert_int_equal(refused.done.trials + refused.tally.trials, 0);
    free(text);
    free(one);
    free(other);
    wh_progress_free(&refused);
    wh_progress_free(&some);
    wh_progress_free(&taken);
    wh_progress_free(&grown);
    wh_progress_free(&whole);
    wh_study_close(&study);
}

/* Makes the check of a state that was changed. */
static void seal(char *text) {
    const size_t covered = strlen(text) - strlen(",\"check\":\"0123456789abcdef\"}");
    uint64_t hash = WH_HASH_START;
    for (size_t i = 0; i < covered; ++i) {
        hash = wh_hash_word(hash, (unsigned char)text[i]);
    }
    (void)snprintf(text + covered, strlen(text) - covered + 1, ",\"check\":\"%016llx\"}",
                   (unsigned long long)hash);
}

/* Each format has other contents: one of before is not read as one of now. Counts that so many trials cannot
 * have are refused, too, whatever check they have. */
static void only_possible_states_are_read(void **state) {
    static const struct {
        const char *from, *to, *says;
    } changes[] = {
        {"\"format\":9,", "\"format\":8,", "of another version: its format is 8 (expected 9)"},
        {"\"trials\":9,\"met\":", "\"trials\":9,\"whole\":", "damaged (expected a study's state)"},
        {"\"met\":9", "\"met\":8", NULL},
        {"\"met\":9", "\"met\":99", "damaged (expected a study's state)"},
        {"\"ended\":0", "\"ended\":10", "damaged (expected a study's state)"},
        {"\"whole\":0", "\"whole\":10", "damaged (expected a study's state)"},
        {",0,9,0,-1]]", ",0,10,0,-1]]", "damaged (expected a study's state)"},
        {",0,9,0,-1]]", ",0,9,10,-1]]", "damaged (expected a study's state)"},
        {"\"events\":[9,9", "\"events\":[9,8", "damaged (expected a study's state)"},
        {"\"wafers\":[[0,", "\"wafers\":[[1,", "damaged (expected a study's state)"},
        {"\"worst\":[[", "\"worst\":[[9", "damaged (expected a study's state)"},
    };
    static wh_study_t study;
    wh_progress_t progress;
    (void)state;
    open_study(&study, 9);
    play(&study, 1, NULL, &progress);
    char *text = wh_checkpoint_text(&study, &progress);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        wh_progress_t read;
        char changed[1 << 16];
        char message[300] = "";
        const char *at = strstr(text, changes[i].from);
        if (!at) {
            fail_msg("there is no %s in %s", changes[i].from, text);
        }
        (void)snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, changes[i].to,
                       at + strlen(changes[i].from));
        seal(changed);
        wh_progress_init(&read, &study);
        const bool is_read =
            wh_checkpoint_read(&study, changed, strlen(changed), &read, message, sizeof message);
        if (is_read != !changes[i].says || (!is_read && strcmp(message, changes[i].says) != 0)) {
            fail_msg("%s: %s", changes[i].to, is_read ? "was read" : message);
        }
        wh_progress_free(&read);
    }
    free(text);
    wh_progress_free(&progress);
    wh_study_close(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stretches_hold_what_was_added), cmocka_unit_test(nothing_is_left_of_what_was_there),
        cmocka_unit_test(threads_share_few_trials),      cmocka_unit_test(others_take_from_the_front),
        cmocka_unit_test(a_state_grows_with_its_study),  cmocka_unit_test(only_possible_states_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
