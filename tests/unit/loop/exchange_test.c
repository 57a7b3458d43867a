/* Which answer is of which slice: by cases, and against a plain model of lines that lose, double, delay and
 * swap frames, with boards that are reset. */
#include "support/support.h"

#include "loop/exchange.h"

enum { AXES = 2 };

static wh_exchange_t exchange;

/* The answer to a state: its first axis tells its number. */
static void make_answer(uint32_t number, uint32_t sent, uint8_t frame[WH_BOARD_COMMAND_BYTES(AXES)]) {
    const double axis = number;
    uint64_t bits;
    memset(frame, 0, WH_BOARD_COMMAND_BYTES(AXES));
    memcpy(&bits, &axis, sizeof bits);
    wh_board_open(frame, WH_BOARD_KIND_COMMAND, AXES, number);
    wh_board_put(frame + 8, 4, sent);
    wh_board_put(frame + 12, 4, number & 1U);
    wh_board_put(frame + WH_BOARD_HEAD, 8, bits);
    wh_board_seal(frame, WH_BOARD_COMMAND_BYTES(AXES));
}

static wh_exchange_news_t hear(uint32_t number, uint32_t sent) {
    uint8_t frame[WH_BOARD_COMMAND_BYTES(AXES)];
    make_answer(number, sent, frame);
    return wh_exchange_hear(&exchange, frame, 0);
}

static void take(double wanted) {
    const wh_exchange_slot_t *slot = wh_exchange_take(&exchange);
    assert_non_null(slot);
    assert_true(slot->axes[0] == wanted);
    assert_int_equal(slot->valves, (uint32_t)wanted & 1U);
}

static void each_answer_drives_the_slice_behind_its_state(void **state) {
    (void)state;
    wh_exchange_init(&exchange, AXES, 1);
    for (uint32_t number = 0; number < 1000; ++number) {
        assert_false(wh_exchange_is_ready(&exchange));
        assert_int_equal(hear(number, number + 1), WH_EXCHANGE_TAKEN);
        assert_true(wh_exchange_is_ready(&exchange));
        take(number);
    }
    assert_int_equal(exchange.counters.held, 0);
    assert_int_equal(exchange.counters.lost_answers, 0);
    assert_int_equal(exchange.counters.resets, 0);
}

/* With a lag of 3 the answer to state 0 drives slices 1 to 3. */
static void a_lag_moves_answers_on(void **state) {
    (void)state;
    wh_exchange_init(&exchange, AXES, 3);
    assert_int_equal(hear(0, 1), WH_EXCHANGE_TAKEN);
    take(0);
    assert_int_equal(hear(1, 2), WH_EXCHANGE_TAKEN);
    take(0);
    take(0);
    take(1);
    assert_null(wh_exchange_take(&exchange));
    assert_int_equal(hear(2, 3), WH_EXCHANGE_LATE);
    assert_int_equal(wh_exchange_lost(&exchange), 0);
}

static void late_doubled_unknown_and_other_answers_are_told_apart(void **state) {
    (void)state;
    uint8_t frame[WH_BOARD_COMMAND_BYTES(AXES)];
    wh_exchange_init(&exchange, AXES, 1);
    assert_int_equal(hear(1, 1), WH_EXCHANGE_UNKNOWN);
    assert_int_equal(hear(0, 1), WH_EXCHANGE_TAKEN);
    assert_int_equal(hear(0, 1), WH_EXCHANGE_DOUBLED);
    take(0);
    assert_int_equal(hear(0, 1), WH_EXCHANGE_DOUBLED);
    assert_null(wh_exchange_take(&exchange));
    assert_int_equal(wh_exchange_lost(&exchange), 1);
    assert_int_equal(hear(1, 2), WH_EXCHANGE_LATE);
    assert_int_equal(hear(1, 2), WH_EXCHANGE_DOUBLED);
    assert_int_equal(wh_exchange_lost(&exchange), 0);
    make_answer(2, 3, frame);
    frame[3] = 3;
    assert_int_equal(wh_exchange_hear(&exchange, frame, 0), WH_EXCHANGE_OTHER_AXES);
    assert_int_equal(exchange.counters.held, 1);
}

static void a_board_that_begins_anew_is_told(void **state) {
    (void)state;
    wh_exchange_init(&exchange, AXES, 1);
    for (uint32_t number = 0; number < 10; ++number) {
        (void)hear(number, number + 1);
        (void)wh_exchange_take(&exchange);
    }
    assert_int_equal(hear(10, 1), WH_EXCHANGE_TAKEN);
    assert_true(exchange.is_reset);
    (void)wh_exchange_take(&exchange);
    assert_int_equal(hear(WH_BOARD_HELLO, 0), WH_EXCHANGE_HELLO);
    assert_int_equal(exchange.counters.resets, 2);
    assert_int_equal(hear(WH_BOARD_HELLO, 0), WH_EXCHANGE_HELLO);
    assert_int_equal(hear(11, 1), WH_EXCHANGE_TAKEN);
    assert_int_equal(exchange.counters.resets, 2);
    assert_int_equal(exchange.counters.lost_answers, 0);
}

static void answers_that_the_line_lost_are_counted(void **state) {
    (void)state;
    wh_exchange_init(&exchange, AXES, 1);
    (void)hear(0, 1);
    (void)wh_exchange_take(&exchange);
    (void)wh_exchange_take(&exchange); /* the board answered, and the line lost it */
    assert_int_equal(hear(2, 3), WH_EXCHANGE_TAKEN);
    (void)wh_exchange_take(&exchange);
    (void)wh_exchange_take(&exchange); /* the board had no state */
    assert_int_equal(hear(4, 4), WH_EXCHANGE_TAKEN);
    assert_int_equal(exchange.counters.held, 2);
    assert_int_equal(wh_exchange_lost(&exchange), 2);
    assert_int_equal(exchange.counters.lost_answers, 1);
}

/* It has not begun anew, so its count goes on. */
static void a_board_that_has_answered_other_runs_has_lost_nothing(void **state) {
    (void)state;
    wh_exchange_init(&exchange, AXES, 1);
    assert_int_equal(hear(0, 5001), WH_EXCHANGE_TAKEN);
    (void)wh_exchange_take(&exchange);
    assert_int_equal(hear(1, 5002), WH_EXCHANGE_TAKEN);
    assert_int_equal(exchange.counters.lost_answers, 0);
    assert_int_equal(exchange.counters.resets, 0);
}

/* ------------------------------------------------------------------------------------------------ the model */

enum { SLICES = 150, FLIGHT = 400 };

/* Frames on their way, with the slice before which they arrive. */
static struct {
    uint32_t number, sent;
    int64_t arrives;
} flying[FLIGHT];
static size_t flying_count;

static void send(uint32_t number, uint32_t sent, int64_t now) {
    const uint32_t harm = wh_test_below(8);
    for (uint32_t copies = harm == 0 ? 0 : harm == 1 ? 2 : 1; copies > 0; --copies) {
        flying[flying_count].number = number;
        flying[flying_count].sent = sent;
        flying[flying_count++].arrives = now + (wh_test_below(5) == 0 ? wh_test_below(6) : 0);
    }
}

/* By answer: how often it has arrived, and if that was in time. */
static struct {
    int times;
    bool in_time;
} arrived[SLICES + 1];

static void arrive(int64_t now) {
    size_t kept = 0;
    for (size_t i = 0; i < flying_count; ++i) {
        if (flying[i].arrives > now) {
            flying[kept++] = flying[i];
            continue;
        }
        const uint32_t slice = flying[i].number + exchange.lag;
        const bool in_time = slice >= exchange.next;
        const wh_exchange_news_t wanted = arrived[flying[i].number].times++ > 0 ? WH_EXCHANGE_DOUBLED
                                          : in_time                             ? WH_EXCHANGE_TAKEN
                                                                                : WH_EXCHANGE_LATE;
        arrived[flying[i].number].in_time = wanted == WH_EXCHANGE_TAKEN || arrived[flying[i].number].in_time;
        assert_int_equal(hear(flying[i].number, flying[i].sent), wanted);
    }
    flying_count = kept;
}

static void slices_have_the_answers_that_came_in_time(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(30, 20000, 1);
    while (wh_round(&rounds)) {
        uint64_t held = 0;
        flying_count = 0;
        memset(arrived, 0, sizeof arrived);
        wh_exchange_init(&exchange, AXES, 1 + wh_test_below(4));
        (void)hear(0, 1);
        arrived[0].times = 1;
        arrived[0].in_time = true;
        for (uint32_t slice = 1; slice <= SLICES; ++slice) {
            const uint32_t number = slice > exchange.lag ? slice - exchange.lag : 0;
            arrive(slice);
            const wh_exchange_slot_t *slot = wh_exchange_take(&exchange);
            assert_int_equal(slot != NULL, arrived[number].in_time);
            assert_true(!slot || slot->axes[0] == number);
            held += slot ? 0 : 1;
            send(slice, slice + 1, slice);
        }
        assert_true(exchange.counters.held == held);
        assert_true(exchange.counters.frames[WH_EXCHANGE_LATE] + wh_exchange_lost(&exchange) == held);
        assert_int_equal(exchange.counters.resets, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_answer_drives_the_slice_behind_its_state),
        cmocka_unit_test(a_lag_moves_answers_on),
        cmocka_unit_test(late_doubled_unknown_and_other_answers_are_told_apart),
        cmocka_unit_test(a_board_that_begins_anew_is_told),
        cmocka_unit_test(answers_that_the_line_lost_are_counted),
        cmocka_unit_test(a_board_that_has_answered_other_runs_has_lost_nothing),
        cmocka_unit_test(slices_have_the_answers_that_came_in_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
