/* Tests the rules that the other random tests rely on. A round draws the same numbers, however many
 * rounds there is time for. The least number of rounds is made even without time. A round that is
 * asked for by its number is that round. */
#include "support/support.h"

#include <sys/wait.h>
#include <unistd.h>

enum { LEAST = 5, FULL = 50 };

typedef struct {
    int made, last;
    uint64_t drawn[FULL], behind;
} played_t;

/* In a process of its own, as if it were the program's first loop. */
static played_t play(const char *seconds, const char *round) {
    played_t played = {.made = 0};
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    (void)fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        (void)setenv("WH_TEST_SECONDS", seconds, 1);
        (void)(round ? setenv("WH_ROUND", round, 1) : unsetenv("WH_ROUND"));
        wh_rounds_t rounds = WH_ROUNDS(LEAST, FULL, 1);
        while (wh_round(&rounds)) {
            played.drawn[rounds.number] = wh_test_random();
            played.made = rounds.made;
            played.last = rounds.number;
            if (round && strcmp(round, "1:17") == 0) {
                break; /* the next one would end the program */
            }
        }
        played.behind = wh_test_random();
        _exit(write(ends[1], &played, sizeof played) == sizeof played ? 0 : 1);
    }
    int status = 1;
    assert_int_equal(read(ends[0], &played, sizeof played), sizeof played);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(close(ends[0]) + close(ends[1]), 0);
    return played;
}

static void a_round_is_the_same_in_any_time(void **state) {
    (void)state;
    const played_t full = play("full", NULL), least = play("0", NULL), much = play("1000", NULL);
    assert_int_equal(full.made, FULL);
    assert_int_equal(much.made, FULL);
    assert_int_equal(least.made, LEAST);
    assert_memory_equal(full.drawn, much.drawn, sizeof full.drawn);
    assert_memory_equal(full.drawn, least.drawn, LEAST * sizeof *full.drawn);
    assert_true(full.behind == least.behind);
    for (size_t i = 1; i < FULL; ++i) {
        assert_true(full.drawn[i] != full.drawn[i - 1] && full.drawn[i] != full.behind);
    }
}

static void a_round_that_is_named_is_played_alone(void **state) {
    (void)state;
    const played_t full = play("full", NULL), one = play("0", "1:17"), other = play("full", "2:17");
    assert_int_equal(one.made, 1);
    assert_int_equal(one.last, 17);
    assert_true(one.drawn[17] == full.drawn[17]);
    assert_int_equal(other.made, LEAST); /* the loop before it */
    assert_memory_equal(other.drawn, full.drawn, LEAST * sizeof *full.drawn);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_round_is_the_same_in_any_time),
        cmocka_unit_test(a_round_that_is_named_is_played_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
