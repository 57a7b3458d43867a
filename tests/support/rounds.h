/* Loops over random numbers that end by processor time, but not by chance: a round depends only on
 * the seed, the loop and the round's number. Part of support.h.
 *
 *     wh_rounds_t rounds = WH_ROUNDS(20, 5000, 0.5);
 *     while (wh_round(&rounds)) {
 *         ...
 *     }
 *     assert_true(found > rounds.made / 10);
 *
 * A test that counts its findings judges by `made`, and asks for at least as many rounds as the
 * judgement needs.
 *
 *   WH_TEST_SECONDS=s      processor seconds of a program's random loops: 3 (sanitizers: 0.3); "full": all
 *   WH_SEED=n              seeds the numbers; runs all rounds unless WH_TEST_SECONDS is set
 *   WH_SEED=n WH_ROUND=l:k runs only round k of loop l, and of the loops before it the least number */
#ifndef WH_TESTS_SUPPORT_ROUNDS_H
#define WH_TESTS_SUPPORT_ROUNDS_H

#include <time.h>
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif

typedef struct {
    const char *name;
    int loop;   /* its number in the program, from 1 on */
    int number; /* of this round, from 0 on */
    int made;   /* the rounds so far, including this one */
    int least, full;
    double begin, seconds; /* processor time; below 0: no limit */
} wh_rounds_t;

/* The loop of the running test; it is named if the loop does not reach its end. */
static struct {
    const char *name;
    int loop, number;
} wh_test_round;

static inline void wh_test_tell_round(void) {
    if (wh_test_round.name) {
        printf("%s did not end: WH_SEED=%llu WH_ROUND=%d:%d repeats its last round\n", wh_test_round.name,
               (unsigned long long)wh_test_first, wh_test_round.loop, wh_test_round.number);
        (void)fflush(stdout);
        wh_test_round.name = NULL;
    }
}

static inline void wh_test_watch_rounds(void) {
    static int is_watched;
    if (!is_watched) {
        is_watched = 1;
        (void)atexit(wh_test_tell_round);
#if defined(__SANITIZE_ADDRESS__)
        __sanitizer_set_death_callback(wh_test_tell_round);
#endif
    }
}

/* Processor seconds of this program. */
static inline double wh_test_cpu(void) {
#if defined(__unix__)
    return (double)clock() / (double)CLOCKS_PER_SEC;
#else
    return 0;
#endif
}

/* The seconds for all of the program's random loops; below 0: no limit. */
static inline double wh_test_seconds(void) {
    const char *text = getenv("WH_TEST_SECONDS");
    if (text ? strcmp(text, "full") == 0 : getenv("WH_SEED") != NULL) {
        return -1;
    }
#if defined(__SANITIZE_ADDRESS__)
    const double usual = 0.3;
#else
    const double usual = 3;
#endif
    return text ? atof(text) : usual;
}

/* True if all rounds are wanted: then a search with a fixed number of tries may use as many as help. */
static inline int wh_test_is_full(void) {
    return wh_test_seconds() < 0;
}

/* At least `least` and at most `full` rounds, in `part` of the program's seconds. */
#define WH_ROUNDS(least, full, part) wh_rounds_of(__func__, least, full, part)

/* The random numbers of a round, or those drawn before the rounds of a loop. */
static inline void wh_test_draw_for(int loop, int number) {
    wh_test_restart_at((uint64_t)loop << 32 | (uint32_t)(number + 1));
}

static inline wh_rounds_t wh_rounds_of(const char *name, int least, int full, double part) {
    static int loops;
    const double seconds = wh_test_seconds();
    wh_rounds_t rounds = {
        name, ++loops, -1, 0, least, full, wh_test_cpu(), seconds < 0 ? -1 : part * seconds};
    wh_test_tell_round();
    wh_test_watch_rounds();
    wh_test_draw_for(rounds.loop, -1);
#if !defined(__unix__)
    rounds.full = least > full / WH_TEST_SHARE ? least : full / WH_TEST_SHARE;
#endif
    assert_true(least > 0 && least <= full);
    if (getenv("WH_ROUND")) {
        rounds.seconds = 0;
    }
    return rounds;
}

/* The only round of this loop that is wanted; -1: there is none. */
static inline int wh_round_wanted(const wh_rounds_t *rounds) {
    const char *text = getenv("WH_ROUND");
    char *end = NULL;
    if (!text || strtol(text, &end, 10) != rounds->loop || *end != ':') {
        return -1;
    }
    return atoi(end + 1);
}

static inline int wh_rounds_are_over(const wh_rounds_t *rounds) {
    if (rounds->made < rounds->least) {
        return 0;
    }
    return rounds->made >= rounds->full ||
           (rounds->seconds >= 0 && wh_test_cpu() - rounds->begin >= rounds->seconds);
}

/* Begins the next round, with random numbers of its own; 0 if there is none. The numbers drawn
 * after the loop are the same however many rounds there were. */
static inline int wh_round(wh_rounds_t *rounds) {
    const int wanted = wh_round_wanted(rounds);
    wh_test_round.name = NULL;
    if (wanted >= 0 && rounds->made > 0) {
        printf("round %d of %s does not fail\n", wanted, rounds->name);
        exit(0);
    }
    if (wanted < 0 && wh_rounds_are_over(rounds)) {
        wh_test_draw_for(rounds->loop, -2);
        return 0;
    }
    ++rounds->made;
    rounds->number = wanted < 0 ? rounds->number + 1 : wanted;
    wh_test_round.name = rounds->name;
    wh_test_round.loop = rounds->loop;
    wh_test_round.number = rounds->number;
    wh_test_draw_for(rounds->loop, rounds->number);
    return 1;
}

#endif
