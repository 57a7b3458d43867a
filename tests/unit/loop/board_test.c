/* The frames of a board: bytes as the manual has them, and what is left of a line that loses and damages. */
#include <stdbool.h>

#include "support/support.h"

#include "loop/board.h"

/* A state frame, written down by hand from the manual's table; its sum is zlib's CRC-32. */
static const uint8_t state_frame[WH_BOARD_STATE_BYTES] = {
    0xA5, 0x53, 0x01, 0x02, 0x04, 0x03, 0x02, 0x01, 0x03, 0x00, 0x00, 0x00, 0x16, 0x00,
    0x05, 0x00, 0xEF, 0xCD, 0xAB, 0x89, 0x67, 0x45, 0x23, 0x01, 0x00, 0x3E, 0x28, 0x1B};

static const uint8_t command_frame[WH_BOARD_COMMAND_BYTES(2)] = {
    0xA5, 0x43, 0x01, 0x02, 0x04, 0x03, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00,
    0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x04, 0xC0, 0xDF, 0x68, 0x70, 0x50};

static wh_board_news_t take_all(wh_board_t *board, const uint8_t bytes[], size_t size) {
    wh_board_news_t news = WH_BOARD_NOTHING;
    for (size_t i = 0; i < size; ++i) {
        const wh_board_news_t now = wh_board_take(board, bytes[i]);
        news = now != WH_BOARD_NOTHING ? now : news;
    }
    return news;
}

static void the_sum_is_the_usual_one(void **state) {
    (void)state;
    assert_int_equal(wh_board_sum((const uint8_t *)"123456789", 9), 0xCBF43926);
}

static void frames_have_the_bytes_of_the_manual(void **state) {
    (void)state;
    const double axes[2] = {1, -2.5};
    wh_board_t board;
    wh_board_init(&board, 2);
    assert_int_equal(take_all(&board, state_frame, sizeof state_frame), WH_BOARD_STATE);
    assert_int_equal(board.state.number, 0x01020304);
    assert_int_equal(board.state.sensors, 3);
    assert_int_equal(board.state.status, 22);
    assert_int_equal(board.state.held, 5);
    assert_true(board.state.hash == UINT64_C(0x0123456789ABCDEF));
    wh_board_answer(&board, axes, 1);
    assert_int_equal(board.out_size, sizeof command_frame);
    assert_memory_equal(board.out, command_frame, sizeof command_frame);
    assert_int_equal(take_all(&board, state_frame, sizeof state_frame), WH_BOARD_REPEATED);
    assert_memory_equal(board.out, command_frame, sizeof command_frame);
}

static void a_hello_answers_no_state(void **state) {
    (void)state;
    wh_board_gathered_t in = {.count = 0};
    wh_board_t board;
    size_t size = 0;
    wh_board_init(&board, 2);
    for (size_t i = 0; i < board.out_size; ++i) {
        size += wh_board_gather(&in, WH_BOARD_KIND_COMMAND, board.out[i]);
    }
    assert_int_equal(size, WH_BOARD_COMMAND_BYTES(2));
    assert_int_equal(wh_board_get(in.bytes + 4, 4), WH_BOARD_HELLO);
    assert_int_equal(wh_board_get(in.bytes + 8, 4), 0);
}

static void a_state_of_another_machine_is_counted_and_not_taken(void **state) {
    (void)state;
    wh_board_t board;
    wh_board_init(&board, 4);
    assert_int_equal(take_all(&board, state_frame, sizeof state_frame), WH_BOARD_NOTHING);
    assert_int_equal(board.others, 1);
    assert_int_equal(board.has_state, 0);
}

/* ---------------------------------------------------------------------------------------- a line that harms */

enum { FRAMES = 40, LINE = FRAMES * 2 * WH_BOARD_BYTES };

static uint8_t line[LINE];
static size_t line_size;
static uint8_t sent[FRAMES][WH_BOARD_BYTES];
static size_t starts[FRAMES], sizes[FRAMES];

/* A command frame of any number of axes. Many of its bytes look like the begin of one. */
static size_t make_frame(uint32_t number, uint8_t frame[]) {
    static const uint8_t odd[] = {WH_BOARD_BEGIN, WH_BOARD_KIND_COMMAND, WH_BOARD_VERSION, 32, 0};
    const uint8_t axes = (uint8_t)wh_test_below(9);
    const size_t size = WH_BOARD_COMMAND_BYTES(axes);
    for (size_t i = 8; i < size; ++i) {
        frame[i] = wh_test_below(2) == 0 ? odd[wh_test_below(sizeof odd)] : (uint8_t)wh_test_below(256);
    }
    wh_board_open(frame, WH_BOARD_KIND_COMMAND, axes, number);
    wh_board_seal(frame, size);
    return size;
}

/* Bytes of nobody. */
static void add_noise(void) {
    for (uint32_t i = wh_test_below(60); i > 0; --i) {
        line[line_size++] = (uint8_t)(wh_test_below(3) == 0 ? WH_BOARD_BEGIN : wh_test_below(256));
    }
}

/* A byte before or behind a frame may stand in for one that it loses: then it is whole. */
static bool may_lose(uint32_t number, size_t size) {
    return sent[number][size - 1] != WH_BOARD_BEGIN &&
           (line_size == 0 || line[line_size - 1] != WH_BOARD_BEGIN);
}

/* One in six has noise before it, one a flipped bit, one lacks a byte. */
static void add_frame(uint32_t number) {
    enum { NOISE, FLIP, LOSE, HARMS = 6 };
    const size_t size = make_frame(number, sent[number]);
    const uint32_t harm = wh_test_below(HARMS);
    const bool loses = harm == LOSE && may_lose(number, size);
    const size_t place = wh_test_below((uint32_t)size);
    if (harm == NOISE) {
        add_noise();
    }
    starts[number] = line_size;
    sizes[number] = size;
    memcpy(line + line_size, sent[number], size);
    if (harm == FLIP) {
        line[line_size + place] = (uint8_t)(line[line_size + place] ^ 1U << wh_test_below(8));
    } else if (loses) {
        memmove(line + line_size + place, line + line_size + place + 1, size - place - 1);
        line[line_size + size - 1] = 0;
    }
    line_size += size - (loses ? 1 : 0);
}

/* The next frame of the line that is whole, from `number` on. Noise may stand in for a byte that was lost. */
static size_t next_whole(size_t number) {
    while (number < FRAMES && memcmp(line + starts[number], sent[number], sizes[number]) != 0) {
        ++number;
    }
    return number;
}

/* The frames that no harm met come out in their order, each once, and no others: whatever lengths the bytes
 * between pretend. */
static void harm_reaches_no_other_frame(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(50, 20000, 1);
    while (wh_round(&rounds)) {
        wh_board_gathered_t in = {.count = 0};
        size_t number = 0;
        line_size = 0;
        memset(line, 0, sizeof line);
        for (uint32_t frame = 0; frame < FRAMES; ++frame) {
            add_frame(frame);
        }
        /* Frames that a pretended length has kept back come out with the bytes that follow. */
        for (size_t i = 0; i < line_size + WH_BOARD_BYTES * 2; ++i) {
            const size_t size =
                wh_board_gather(&in, WH_BOARD_KIND_COMMAND, i < line_size ? line[i] : (uint8_t)0);
            if (size > 0) {
                number = next_whole(number);
                assert_true(number < FRAMES);
                assert_memory_equal(in.bytes, sent[number], size);
                ++number;
            }
        }
        assert_int_equal(next_whole(number), FRAMES);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sum_is_the_usual_one),
        cmocka_unit_test(frames_have_the_bytes_of_the_manual),
        cmocka_unit_test(a_hello_answers_no_state),
        cmocka_unit_test(a_state_of_another_machine_is_counted_and_not_taken),
        cmocka_unit_test(harm_reaches_no_other_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
