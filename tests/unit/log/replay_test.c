/* Recordings in memory: equal slices, differing ones and their names, and missing ones. */
#include "support/support.h"

#include <unistd.h>

#include "layout/layout.h"
#include "log/reading.h"
#include "log/recording.h"
#include "reading/layout_read.h"

#define RUN 4711

static wh_sandbox_t *sandbox;
static const wh_layout_t *layout;
static wh_protocol_server_t server;
static wh_replay_t replay;
static uint8_t bytes[WH_LINK_DATAGRAM];

static void tell_cell(void) {
    static wh_link_cell_t cell;
    assert_true(wh_link_cell_from_layout(layout, &server.identity, &cell));
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &cell.message);
    wh_replay_event(&replay, WH_CHANNEL_CELL, bytes, (size_t)size);
}

static int set_up(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(NULL);
    layout = wh_layout_load(sandbox, "lua/layouts/paper.lua", &result);
    if (!layout || wh_protocol_server_open(&server, layout) != WH_OK) {
        return -1;
    }
    memset(&replay, 0, sizeof replay);
    tell_cell();
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    wh_replay_close(&replay);
    wh_sandbox_free(sandbox);
    return 0;
}

/* The end-effector rises below Wafer 1 of station A with its valve open. */
static waferhand_command command(int64_t seq) {
    waferhand_command message;
    memset(&message, 0, sizeof message);
    message.run = RUN;
    message.seq = seq;
    message.utime = 1000 * seq;
    message.layout_hash = (int64_t)server.identity.layout_hash;
    message.lockstep = 1;
    message.gripper_count = 2;
    message.axis_count = 5;
    for (size_t g = 0; g < 2; ++g) {
        message.gripper_position[g][0] = g == 0 ? 700 : -600;
        message.gripper_position[g][2] = g == 0 ? 899 + 0.1 * (double)seq : 950;
        message.gripper_rotation[g][0] = message.gripper_rotation[g][4] = message.gripper_rotation[g][8] = 1;
        message.valve[g] = g == 0 ? 0 : 1;
    }
    return message;
}

static void record_command(const waferhand_command *message) {
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, message);
    wh_link_seal(bytes, (size_t)size);
    wh_replay_event(&replay, WH_CHANNEL_COMMAND, bytes, (size_t)size);
}

static void record_state(void) {
    wh_replay_event(&replay, WH_CHANNEL_STATE, server.encoded, server.encoded_size);
}

static void simulate(int64_t seq) {
    const waferhand_command message = command(seq);
    assert_int_not_equal(wh_protocol_server_command(&server, &message, NULL), WH_SERVER_IGNORED);
}

/* A state that another simulator could have computed. */
static void record_changed_state(void (*change)(waferhand_state *message)) {
    waferhand_state message;
    assert_true(wh_link_decode_state(server.encoded, server.encoded_size, &message));
    change(&message);
    const int size = waferhand_state_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_link_seal(bytes, (size_t)size);
    wh_replay_event(&replay, WH_CHANNEL_STATE, bytes, (size_t)size);
    (void)waferhand_state_decode_cleanup(&message);
}

static const wh_replay_run_t *only_run(void) {
    wh_replay_end(&replay);
    assert_int_equal(replay.run_count, 1);
    assert_int_equal(replay.runs[0].run, RUN);
    return &replay.runs[0];
}

static void the_same(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 30; ++seq) {
        const waferhand_command message = command(seq);
        simulate(seq);
        record_command(&message);
        record_command(&message);
        record_state();
        record_state();
    }
    assert_int_equal(only_run()->slices.compared, 30);
    assert_int_equal(only_run()->slices.differing, 0);
    assert_true(only_run()->hash == wh_protocol_server_hash(&server));
    assert_int_equal(replay.server.simulator.table.counters.picked, 1);
}

static void states_before_their_commands(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 5; ++seq) {
        const waferhand_command message = command(seq);
        simulate(seq);
        if (seq > 1) {
            record_state();
        }
        record_command(&message);
        if (seq == 1) {
            record_state();
        }
    }
    assert_int_equal(only_run()->slices.compared, 5);
}

static void move_wafer(waferhand_state *message) {
    message->wafers[1].position[2] += 0.5;
    message->hash += 1;
}

static void take_wafer(waferhand_state *message) {
    message->wafers[0].holder = 1;
    message->hash += 1;
}

static void the_first_difference_is_named(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 6; ++seq) {
        const waferhand_command message = command(seq);
        simulate(seq);
        record_command(&message);
        if (seq == 4) {
            record_changed_state(move_wafer);
        } else if (seq == 5) {
            record_changed_state(take_wafer);
        } else {
            record_state();
        }
    }
    const wh_replay_run_t *run = only_run();
    assert_int_equal(run->slices.differing, 2);
    assert_int_equal(run->difference.slice, 4);
    assert_string_equal(run->difference.what, "Wafer 2, position z");
    assert_near(run->difference.recorded, 900.5, 0);
    assert_near(run->difference.replayed, 900, 0);
    assert_int_equal(run->slices.compared, 6);
}

/* A state that comes again is not stepped again, and must be as before: at once, later, or while it waits. */
static void a_state_that_comes_again_otherwise_is_counted(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 6; ++seq) {
        const waferhand_command message = command(seq);
        simulate(seq);
        record_command(&message);
        record_state();
        if (seq == 2) {
            record_changed_state(move_wafer);
        }
        assert_int_equal(replay.heard.losses[WH_REPLAY_CONTRADICTS].count, seq >= 2 ? 1 : 0);
    }
    assert_int_equal(only_run()->slices.compared, 6);
    assert_int_equal(only_run()->slices.differing, 0);
}

static void another_command_is_found_out(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 3; ++seq) {
        waferhand_command message = command(seq);
        simulate(seq);
        message.gripper_position[0][1] += seq == 2 ? 1e-9 : 0;
        record_command(&message);
        record_state();
    }
    assert_int_equal(only_run()->slices.differing, 1);
    assert_int_equal(only_run()->difference.slice, 2);
    assert_string_equal(only_run()->difference.what, "EE, position y");
}

static void valves_from_outside_are_followed(void **state) {
    static const int32_t closed[WH_GRIPPERS] = {1, 1};
    (void)state;
    const waferhand_command message = command(1);
    assert_int_not_equal(wh_protocol_server_command(&server, &message, closed), WH_SERVER_IGNORED);
    record_command(&message);
    record_state();
    assert_int_equal(only_run()->slices.outside_valves, 1);
    assert_int_equal(only_run()->slices.differing, 0);
}

static void a_hole_is_bridged(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 9; ++seq) {
        const waferhand_command message = command(seq);
        simulate(seq);
        if (seq < 4 || seq > 6) {
            record_command(&message);
            record_state();
        }
    }
    assert_int_equal(only_run()->slices.differing, 0);
    assert_int_equal(only_run()->slices.taken_up, 1);
    assert_int_equal(only_run()->last_slice, 9);
    assert_int_equal(only_run()->slices.compared, 5);
    assert_int_equal(only_run()->slices.skipped, 4);
}

/* Each slice up to the last one is compared or skipped, however many are missing. */
static void a_hole_of_any_size_is_counted(void **state) {
    static const int64_t holes[][2] = {{4, 5}, {4, 9}, {4, 3000}, {1, 3000}, {1, 90000}, {7, 90000}};
    (void)state;
    for (size_t i = 0; i < sizeof holes / sizeof holes[0]; ++i) {
        const int64_t last = holes[i][1] + 5;
        wh_replay_close(&replay);
        memset(&replay, 0, sizeof replay);
        wh_protocol_server_close(&server);
        assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
        tell_cell();
        for (int64_t seq = 1; seq <= last; ++seq) {
            simulate(seq);
            if (seq < holes[i][0] || seq >= holes[i][1]) {
                const waferhand_command message = command(seq);
                record_command(&message);
                record_state();
            }
        }
        assert_int_equal(only_run()->last_slice, last);
        assert_int_equal(only_run()->slices.compared, holes[i][0] - 1 + 5);
        assert_int_equal(only_run()->slices.skipped, holes[i][1] - holes[i][0] + 1);
        wh_replay_close(&replay);
    }
}

/* ---------------------------------------------------------------------------------------- how a run ended */

static void record_mcs(int32_t phase, int32_t number, const char *text) {
    const waferhand_mcs message = {.run = RUN,
                                   .layout_hash = (int64_t)server.identity.layout_hash,
                                   .phase = phase,
                                   .error = number,
                                   .command = wh_link_borrowed(""),
                                   .text = wh_link_borrowed(text)};
    const int size = waferhand_mcs_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_replay_event(&replay, WH_CHANNEL_MCS, bytes, (size_t)size);
}

static void the_reason_of_a_failed_run_is_kept(void **state) {
    (void)state;
    record_mcs(WH_LINK_PHASE_MET, 1, "so far");
    record_mcs(WH_LINK_PHASE_OVER, 0,
               "failed; commands 2, expectations 1, met 1, cycles 0; error.lua:4: GET Z 77");
    assert_int_equal(only_run()->over.outcome.verdict, WH_OUTCOME_FAILED);
    assert_string_equal(only_run()->over.reason, "error.lua:4: GET Z 77");
    assert_false(only_run()->over.is_wrong);
}

/* No program publishes a verdict that does not fit its counts, or contradicts its earlier ones. */
static void a_verdict_that_contradicts_is_damage(void **state) {
    static const struct {
        int32_t second; /* the phase of the second expectation; the first one was met */
        const char *text;
        bool is_wrong;
    } cases[] = {{WH_LINK_PHASE_MET, "passed; commands 0, expectations 2, met 2, cycles 0", false},
                 {WH_LINK_PHASE_UNMET, "failed; commands 0, expectations 2, met 1, cycles 0", false},
                 {WH_LINK_PHASE_MET, "failed; commands 0, expectations 2, met 2, cycles 0; why", false},
                 {WH_LINK_PHASE_MET, "", false}, /* as older programs say it */
                 {WH_LINK_PHASE_UNMET, "passed; commands 0, expectations 2, met 1, cycles 0", true},
                 {WH_LINK_PHASE_UNMET, "passed; commands 0, expectations 2, met 2, cycles 0", true},
                 {WH_LINK_PHASE_UNMET, "failed; commands 0, expectations 2, met 2, cycles 0", true},
                 {WH_LINK_PHASE_MET, "failed; commands 0, expectations 2, met 1, cycles 0", true},
                 {WH_LINK_PHASE_MET, "passed; commands 0, expectations 2, met 3, cycles 0", true},
                 {WH_LINK_PHASE_MET, "passes; commands 0, expectations 2, met 2, cycles 0", true}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        wh_replay_close(&replay);
        memset(&replay, 0, sizeof replay);
        tell_cell();
        record_mcs(WH_LINK_PHASE_MET, 1, "one");
        record_mcs(cases[i].second, 2, "two");
        record_mcs(WH_LINK_PHASE_OVER, 0, cases[i].text);
        print_message("%s\n", cases[i].text);
        assert_int_equal(only_run()->over.is_wrong, cases[i].is_wrong);
        assert_int_equal(replay.heard.losses[WH_REPLAY_CONTRADICTS].count, cases[i].is_wrong ? 1 : 0);
        wh_replay_close(&replay);
    }
}

/* Only the simulator's own message shows that a command of an unknown layout was in effect answered. */
static void a_run_of_another_layout_is_told(void **state) {
    (void)state;
    for (int refused = 0; refused < 2; ++refused) {
        waferhand_command message = command(1);
        wh_reading_t reading = {0};
        char reason[WH_READING_REASON];
        wh_replay_close(&replay);
        memset(&replay, 0, sizeof replay);
        tell_cell();
        message.layout_hash += 1;
        record_command(&message);
        if (refused) {
            assert_int_equal(wh_protocol_server_command(&server, &message, NULL), WH_SERVER_ANSWERED);
            record_state();
        }
        record_mcs(WH_LINK_PHASE_OVER, 0,
                   "failed; commands 1, expectations 0, met 0, cycles 0; OTHER_LAYOUT");
        const wh_replay_run_t *run = only_run();
        assert_false(run->is_begun);
        assert_int_equal(run->homeless.is_other_layout, refused);
        assert_int_equal(run->homeless.count, 1);
        assert_int_equal(run->over.outcome.verdict, WH_OUTCOME_FAILED);
        assert_int_equal(replay.heard.losses[WH_REPLAY_HOMELESS].count, 1 - refused);
        assert_int_equal(wh_reading_judge(&replay, &reading, false, reason), WH_READING_INCOMPLETE);
        assert_non_null(strstr(reason, refused ? "no slice" : "layout"));
        wh_replay_close(&replay);
    }
}

static void narrow_projz(waferhand_cell *cell) {
    cell->eps_projz = 1e-200;
}

static void narrow_near_projz(waferhand_cell *cell) {
    cell->near_projz = 1e-200;
}

static void narrow_near_projxy(waferhand_cell *cell) {
    cell->near_projxy = 1e-200;
}

/* Numbers for which a layout's file would be refused, too: their squares are zero, and are used as
 * divisors. */
static void cells_that_no_layout_describes(void **state) {
    static void (*const changes[])(waferhand_cell * cell) = {narrow_projz, narrow_near_projz,
                                                             narrow_near_projxy};
    (void)state;
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        static wh_link_cell_t cell;
        assert_true(wh_link_cell_from_layout(layout, &server.identity, &cell));
        wh_layout_t *const good = wh_link_layout_from_cell(&cell.message);
        assert_non_null(good);
        wh_link_layout_free(good);
        changes[i](&cell.message);
        assert_null(wh_link_layout_from_cell(&cell.message));
    }
}

static void garbage_is_counted(void **state) {
    (void)state;
    memset(bytes, 0x5a, 1000);
    wh_replay_event(&replay, WH_CHANNEL_COMMAND, bytes, 1000);
    wh_replay_event(&replay, WH_CHANNEL_STATE, bytes, 10);
    wh_replay_event(&replay, WH_CHANNEL_CELL, bytes, 0);
    wh_replay_event(&replay, "SOMEBODY_ELSE", bytes, 1000);
    assert_int_equal(replay.heard.losses[WH_REPLAY_GARBAGE].count, 3);
    /* Data that are skipped only if they are sound, too. */
    static const char *const others[] = {WH_CHANNEL_MCS,       WH_CHANNEL_RESTORE, WH_CHANNEL_REQUEST,
                                         WH_CHANNEL_PROXIMITY, WH_CHANNEL_SLICES,  WH_CHANNEL_RECORDING,
                                         WH_CHANNEL_EDGE_SCAN, WH_CHANNEL_LATCH};
    for (size_t i = 0; i < sizeof others / sizeof *others; ++i) {
        wh_replay_event(&replay, others[i], bytes, 1000);
        assert_int_equal(replay.heard.losses[WH_REPLAY_GARBAGE].count, 4 + i);
    }
    assert_int_equal(replay.run_count, 0);
}

/* --------------------------------------------------------------------------------------- what is not said */

static void narrow_height(waferhand_state *message) {
    message->wafers[1].position[1] += 1e-9;
}

/* The hash is right, but the body is another one. */
static void a_body_without_a_check_differs(void **state) {
    waferhand_state message;
    (void)state;
    for (int64_t seq = 1; seq <= 3; ++seq) {
        const waferhand_command sent = command(seq);
        simulate(seq);
        record_command(&sent);
        if (seq != 2) {
            record_state();
            continue;
        }
        assert_true(wh_link_decode_state(server.encoded, server.encoded_size, &message));
        narrow_height(&message);
        message.check = 0;
        const int size = waferhand_state_encode(bytes, 0, (int)sizeof bytes, &message);
        wh_replay_event(&replay, WH_CHANNEL_STATE, bytes, (size_t)size);
        (void)waferhand_state_decode_cleanup(&message);
    }
    assert_int_equal(only_run()->slices.compared, 3);
    assert_int_equal(only_run()->slices.differing, 1);
    assert_int_equal(only_run()->difference.slice, 2);
    assert_string_equal(only_run()->difference.what, "Wafer 2, position y");
    assert_int_equal(replay.heard.losses[WH_REPLAY_UNCHECKED].count, 1);
}

/* Free-running: states come some commands later, and some commands never came. */
static void states_behind_later_commands(void **state) {
    enum { SLICES = 40, LATE = 7 };
    static uint8_t kept[SLICES + 1][8192];
    static size_t sizes[SLICES + 1];
    int64_t missed = 0;
    (void)state;
    for (int64_t seq = 1; seq <= SLICES + LATE; ++seq) {
        waferhand_command sent = command(seq);
        sent.lockstep = seq == 1 ? 1 : 0;
        if (seq <= SLICES) {
            record_command(&sent);
            sizes[seq] = 0;
            if (seq % 9 == 5) {
                ++missed;
            } else {
                assert_int_not_equal(wh_protocol_server_command(&server, &sent, NULL), WH_SERVER_IGNORED);
                memcpy(kept[seq], server.encoded, server.encoded_size);
                sizes[seq] = server.encoded_size;
            }
        }
        if (seq > LATE && sizes[seq - LATE] > 0) {
            wh_replay_event(&replay, WH_CHANNEL_STATE, kept[seq - LATE], sizes[seq - LATE]);
        }
    }
    const wh_replay_run_t *run = only_run();
    assert_int_equal(run->slices.compared, SLICES - missed);
    assert_int_equal(run->slices.differing, 0);
    assert_int_equal(run->slices.missed, missed);
    assert_int_equal(
        run->slices.unanswered + run->slices.last_unanswered + run->slices.taken_up + run->slices.skipped, 0);
}

static void a_state_that_is_missing_is_counted(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 9; ++seq) {
        const waferhand_command sent = command(seq);
        simulate(seq);
        record_command(&sent);
        if (seq != 4 && seq != 9) {
            record_state();
        }
    }
    assert_int_equal(only_run()->slices.compared, 7);
    assert_int_equal(only_run()->slices.unanswered, 1);
    assert_int_equal(only_run()->slices.last_unanswered, 1);
    assert_int_equal(only_run()->slices.differing, 0);
}

static void messages_on_other_channels(void **state) {
    (void)state;
    const waferhand_command sent = command(1);
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &sent);
    wh_replay_event(&replay, "WAFERHAND_COMMANE", bytes, (size_t)size);
    wh_replay_event(&replay, "SOMEBODY_ELSE", bytes, (size_t)size);
    wh_replay_event(&replay, "WAFERHAND_ELSE", "12345678", 8);
    wh_replay_event(&replay, "SOMEBODY_ELSE", "12345678", 8);
    assert_int_equal(replay.heard.losses[WH_REPLAY_STRAY].count, 3);
}

/* ------------------------------------------------------------------------------------------ event numbers */

typedef struct {
    const char *numbers;
    uint64_t missing, doubled, moved, misnumbered;
} numbered_t;

static void event_numbers_tell_what_is_missing(void **state) {
    static const numbered_t cases[] = {
        {"0 1 2 3", 0, 0, 0, 0},     {"", 0, 0, 0, 0},          {"2 3", 2, 0, 0, 0},
        {"0 1 4 5", 2, 0, 0, 0},     {"0 1 1 2", 0, 1, 0, 0},   {"0 1 2 2", 0, 1, 0, 0},
        {"0 2 1 3", 0, 0, 1, 0},     {"0 1 9 3", 0, 0, 0, 1},   {"0 1 2 9", 6, 0, 0, 0},
        {"0 4 1 2 3 5", 0, 0, 3, 0}, {"0 1 0 1 2", 0, 2, 0, 0}, {"5", 5, 0, 0, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        wh_log_numbers_t numbers = {0};
        const char *at = cases[i].numbers;
        for (char *end = NULL; *at; at = end) {
            wh_log_numbers_take(&numbers, strtoull(at, &end, 10), 0);
        }
        wh_log_numbers_finish(&numbers);
        print_message("%s\n", cases[i].numbers);
        assert_int_equal(wh_log_numbers_missing(&numbers), cases[i].missing);
        assert_int_equal(numbers.doubled, cases[i].doubled);
        assert_int_equal(numbers.moved, cases[i].moved);
        assert_int_equal(numbers.misnumbered, cases[i].misnumbered);
    }
}

/* --------------------------------------------------------------------------------- logs damaged at random */

#define HEADER 28
#define EVENTS 2000
#define LOG_BYTES (1 << 20)
/* The slices of the logs that get damaged. */
#define SLICES 120

typedef enum { OF_SLICES, OF_ALL, OF_VERSION_1, VERSIONS } version_t;

/* A log in memory, and the places where its events begin. */
typedef struct {
    uint8_t bytes[2 * LOG_BYTES]; /* room for insertions */
    size_t size;
    size_t starts[EVENTS + 1];
    size_t count;
} log_t;

static log_t whole[VERSIONS], damaged;
static wh_recording_t recording;
static wh_log_t reader;

static void say(int32_t phase, int64_t seq, const char *text) {
    const waferhand_mcs message = {.utime = 1000 * seq,
                                   .seq = seq,
                                   .run = RUN,
                                   .layout_hash = (int64_t)server.identity.layout_hash,
                                   .phase = phase,
                                   .error = phase == WH_LINK_PHASE_MET ? 1 : 0,
                                   .command = wh_link_borrowed(""),
                                   .text = wh_link_borrowed(text)};
    const int size = waferhand_mcs_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_recording_message(&recording, WH_CHANNEL_MCS, bytes, (size_t)size);
}

static void say_cell(void) {
    static wh_link_cell_t cell;
    assert_true(wh_link_cell_from_layout(layout, &server.identity, &cell));
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &cell.message);
    wh_recording_message(&recording, WH_CHANNEL_CELL, bytes, (size_t)size);
}

static void say_slices(void) {
    for (int64_t seq = 1; seq <= SLICES; ++seq) {
        const waferhand_command message = command(seq);
        const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &message);
        wh_link_seal(bytes, (size_t)size);
        wh_recording_message(&recording, WH_CHANNEL_COMMAND, bytes, (size_t)size);
        simulate(seq);
        wh_recording_message(&recording, WH_CHANNEL_STATE, server.encoded, server.encoded_size);
        if (seq == SLICES / 2) {
            say(WH_LINK_PHASE_MET, seq, "half of it");
            say_cell();
        }
    }
    say(WH_LINK_PHASE_OVER, SLICES, "passed; commands 0, expectations 1, met 1, cycles 0");
}

static size_t length_at(const log_t *log, size_t at) {
    const uint8_t *header = log->bytes + at;
    size_t channel = 0;
    size_t data = 0;
    for (size_t i = 0; i < 4; ++i) {
        channel = channel << 8 | header[20 + i];
        data = data << 8 | header[24 + i];
    }
    return HEADER + channel + data;
}

static void find_events(log_t *log) {
    log->count = 0;
    for (size_t at = 0; at < log->size; at += length_at(log, at)) {
        assert_true(log->count < EVENTS);
        log->starts[log->count++] = at;
    }
    log->starts[log->count] = log->size;
}

static bool is_on(const log_t *log, size_t event, const char *channel) {
    return strncmp((const char *)log->bytes + log->starts[event] + HEADER, channel, strlen(channel)) == 0;
}

static void put_event(log_t *log, const log_t *from, size_t event) {
    const size_t length = from->starts[event + 1] - from->starts[event];
    memcpy(log->bytes + log->size, from->bytes + from->starts[event], length);
    log->size += length;
}

/* In the form of programs before recordings. */
static void make_version_1(void) {
    log_t *log = &whole[OF_VERSION_1];
    uint64_t number = 0;
    log->size = 0;
    for (size_t i = 0; i < whole[OF_ALL].count; ++i) {
        if (is_on(&whole[OF_ALL], i, WH_CHANNEL_RECORDING)) {
            continue;
        }
        uint8_t *header = log->bytes + log->size;
        put_event(log, &whole[OF_ALL], i);
        for (size_t k = 0; k < 8; ++k) {
            header[4 + k] = (uint8_t)(number >> (56 - 8 * k));
        }
        ++number;
    }
    find_events(log);
}

static void record_whole(version_t version) {
    char path[WH_TEST_PATH];
    const int fd = mkstemp(wh_test_path(path, "replay"));
    assert_true(fd >= 0);
    memset(&recording, 0, sizeof recording);
    recording.options =
        (wh_recording_options_t){.path = path, .program = "test", .all = version == OF_ALL, .replaces = true};
    assert_true(wh_recording_open(&recording));
    assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
    say_cell();
    say_slices();
    assert_true(wh_recording_close(&recording));
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    whole[version].size = fread(whole[version].bytes, 1, LOG_BYTES, file);
    (void)fclose(file);
    (void)close(fd);
    (void)unlink(path);
    find_events(&whole[version]);
}

static void record_all_versions(void) {
    record_whole(OF_SLICES);
    record_whole(OF_ALL);
    make_version_1();
}

/* Replays a log; `replay` then has its runs. */
static wh_reading_verdict_t verdict_of(log_t *log, bool lenient) {
    wh_reading_t reading;
    FILE *file = fmemopen(log->bytes, log->size > 0 ? log->size : 1, "rb");
    assert_non_null(file);
    wh_replay_close(&replay);
    memset(&replay, 0, sizeof replay);
    const wh_log_files_t files = {.files = {file}, .count = 1};
    wh_reading_replay(&files, &reader, &replay, &reading);
    wh_log_close(&reader);
    (void)fclose(file);
    return wh_reading_judge(&replay, &reading, lenient, NULL);
}

static void copy_whole(const log_t *log) {
    memcpy(damaged.bytes, log->bytes, log->size);
    damaged.size = log->size;
}

/* True for a byte that nothing protects: a time stamp; in a log of version 1 also the bytes of
 * messages without a check. */
static bool is_unguarded(const log_t *log, version_t version, size_t at) {
    size_t event = 0;
    while (log->starts[event + 1] <= at) {
        ++event;
    }
    const size_t within = at - log->starts[event];
    const bool checked = is_on(log, event, WH_CHANNEL_COMMAND) || is_on(log, event, WH_CHANNEL_STATE);
    return (within >= 12 && within < 20) || (version == OF_VERSION_1 && within >= HEADER && !checked);
}

static void flip_bits(const log_t *log, version_t version) {
    copy_whole(log);
    for (uint64_t left = 1 + wh_test_below(3); left > 0;) {
        const size_t at = wh_test_below((uint32_t)log->size);
        if (!is_unguarded(log, version, at)) {
            damaged.bytes[at] ^= (uint8_t)(1U << wh_test_below(8));
            --left;
        }
    }
}

static void overwrite(const log_t *log, version_t version) {
    size_t at = wh_test_below((uint32_t)log->size);
    copy_whole(log);
    while (is_unguarded(log, version, at)) {
        at = wh_test_below((uint32_t)log->size);
    }
    damaged.bytes[at] = (uint8_t)~damaged.bytes[at];
    for (size_t left = wh_test_below(5000); left > 0 && ++at < log->size; --left) {
        damaged.bytes[at] = (uint8_t)wh_test_random();
    }
}

static void cut_off(const log_t *log, version_t version) {
    (void)version;
    copy_whole(log);
    damaged.size = wh_test_below((uint32_t)log->size);
}

static void cut_out(const log_t *log, version_t version) {
    const size_t at = wh_test_below((uint32_t)log->size);
    const size_t length = 1 + wh_test_below((uint32_t)(log->size - at < 9000 ? log->size - at : 9000));
    (void)version;
    copy_whole(log);
    memmove(damaged.bytes + at, damaged.bytes + at + length, log->size - at - length);
    damaged.size -= length;
}

/* Events in another order, one of them twice or missing. */
static void shuffle(const log_t *log, version_t version) {
    const size_t one = wh_test_below((uint32_t)log->count);
    const size_t other = (one + 1 + wh_test_below((uint32_t)log->count - 1)) % log->count;
    const uint64_t what = wh_test_below(4);
    (void)version;
    damaged.size = 0;
    for (size_t i = 0; i < log->count; ++i) {
        if (what == 0) { /* swapped */
            put_event(&damaged, log, i == one ? other : (i == other ? one : i));
        } else if (i != one) {
            put_event(&damaged, log, i);
        } else if (what == 1) { /* doubled */
            put_event(&damaged, log, i);
            put_event(&damaged, log, i);
        }                              /* else: lost */
        if (what == 3 && i == other) { /* moved */
            put_event(&damaged, log, one);
        }
    }
}

static const struct {
    const char *name;
    void (*damage)(const log_t *log, version_t version);
} kinds[] = {{"flipped bits", flip_bits},
             {"bytes overwritten", overwrite},
             {"cut off", cut_off},
             {"bytes cut out", cut_out},
             {"events shuffled", shuffle}};

/* No damage yields a right check. No slice in the log is another one, so none may be reported as
 * different. */
static void damaged_logs_never_say_more_than_they_have(void **state) {
    (void)state;
    (void)wh_test_seed();
    record_all_versions();
    for (version_t version = OF_SLICES; version < VERSIONS; ++version) {
        const wh_reading_verdict_t verdict = verdict_of(&whole[version], false);
        assert_int_equal(verdict, WH_READING_SAME);
        assert_int_equal(replay.runs[0].slices.compared, SLICES);
    }
    for (int i = 0; i < 1000 / WH_TEST_SHARE; ++i) {
        const version_t version = (version_t)wh_test_below(VERSIONS);
        const size_t kind = wh_test_below(sizeof kinds / sizeof kinds[0]);
        do {
            kinds[kind].damage(&whole[version], version);
        } while (damaged.size == whole[version].size &&
                 memcmp(damaged.bytes, whole[version].bytes, damaged.size) == 0);
        const wh_reading_verdict_t lenient = verdict_of(&damaged, true);
        const wh_reading_verdict_t verdict = verdict_of(&damaged, false);
        if (verdict == WH_READING_SAME || verdict == WH_READING_DIFFERS || lenient == WH_READING_DIFFERS) {
            fail_msg("log %d, version %d, %s: %s", i, (int)version, kinds[kind].name,
                     wh_reading_word(verdict));
        }
    }
}

/* A state with another body and the right check for it differs in that slice alone. */
static void a_forged_state_differs_where_it_stands(void **state) {
    (void)state;
    record_all_versions();
    for (version_t version = OF_SLICES; version < VERSIONS; ++version) {
        const log_t *log = &whole[version];
        for (size_t event = 0; event<log->count; event += WH_TEST_SHARE> 1 ? 3 : 1) {
            if (!is_on(log, event, WH_CHANNEL_STATE)) {
                continue;
            }
            const size_t data = log->starts[event] + HEADER + strlen(WH_CHANNEL_STATE);
            copy_whole(log);
            damaged.bytes[data + 100 + wh_test_below(80)] ^= 1;
            wh_link_seal(damaged.bytes + data, log->starts[event + 1] - data);
            assert_int_equal(verdict_of(&damaged, false), WH_READING_DIFFERS);
            assert_int_equal(replay.runs[0].slices.differing, 1);
        }
    }
}

static void an_unknown_version_is_refused(void **state) {
    (void)state;
    record_all_versions();
    const log_t *log = &whole[OF_SLICES];
    const size_t data = log->starts[0] + HEADER + strlen(WH_CHANNEL_RECORDING);
    static const uint8_t unknown[] = {0, WH_RECORDING_OLDEST - 1, WH_RECORDING_VERSION + 1};
    for (size_t i = 0; i < sizeof unknown; ++i) {
        copy_whole(log);
        damaged.bytes[data + 43] = unknown[i];
        wh_link_seal(damaged.bytes + data, log->starts[1] - data);
        assert_int_equal(verdict_of(&damaged, false), WH_READING_UNUSABLE);
        assert_int_equal(replay.recording.version, unknown[i]);
    }
    /* A log of the program before this one is read: the first message alone says so here, and is sealed. */
    copy_whole(log);
    damaged.bytes[data + 43] = WH_RECORDING_OLDEST;
    wh_link_seal(damaged.bytes + data, log->starts[1] - data);
    assert_int_not_equal(verdict_of(&damaged, false), WH_READING_UNUSABLE);
    assert_int_equal(replay.runs[0].slices.differing, 0);
}

/* One bit of the cell alone: the slices may be unchanged. */
static void a_changed_cell_is_no_difference(void **state) {
    (void)state;
    record_all_versions();
    for (version_t version = OF_SLICES; version <= OF_ALL; ++version) {
        const log_t *log = &whole[version];
        const size_t data = log->starts[1] + HEADER + strlen(WH_CHANNEL_CELL);
        for (size_t at = data + 8; at < log->starts[2]; at += WH_TEST_SHARE) {
            copy_whole(log);
            damaged.bytes[at] ^= (uint8_t)(1U << at % 8);
            const wh_reading_verdict_t verdict = verdict_of(&damaged, false);
            assert_true(verdict == WH_READING_INCOMPLETE || verdict == WH_READING_UNUSABLE);
        }
    }
}

/* Begun and not closed, wherever it ends. */
static void a_log_that_is_not_closed_is_cut(void **state) {
    (void)state;
    record_all_versions();
    for (version_t version = OF_SLICES; version < VERSIONS; ++version) {
        const log_t *log = &whole[version];
        copy_whole(log);
        damaged.size = log->starts[log->count - 1];
        assert_int_equal(verdict_of(&damaged, false), WH_READING_CUT);
        assert_int_equal(replay.runs[0].slices.compared, SLICES);
        damaged.size += 30;
        assert_int_equal(verdict_of(&damaged, true), WH_READING_CUT);
    }
}

/* -------------------------------------------------------------------------------- back to an earlier state */

#define AGAIN (RUN + 1)
/* The slice whose state starts the second run: it is farther away than commands wait for a state. */
#define SAVED (WH_REPLAY_WINDOW + 50)

/* An event of a log in memory. */
typedef struct {
    const char *channel;
    uint8_t *data;
    size_t size;
} event_t;

static event_t events[4 * SAVED];
static size_t event_count;

static void keep_event(const char *channel, const uint8_t *data, size_t size) {
    event_t *event = &events[event_count++];
    *event = (event_t){channel, malloc(size), size};
    assert_non_null(event->data);
    memcpy(event->data, data, size);
}

static void keep_slice(int64_t run, int64_t seq) {
    waferhand_command message = command(seq);
    message.run = run;
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_link_seal(bytes, (size_t)size);
    keep_event(WH_CHANNEL_COMMAND, bytes, (size_t)size);
    (void)wh_protocol_server_command(&server, &message, NULL);
    keep_event(WH_CHANNEL_STATE, server.encoded, server.encoded_size);
}

/* A run, and a second one that continues from a state of the first, taken from its slice SAVED; the
 * event of that state in the second run. */
static size_t keep_two_runs(void) {
    event_count = 0;
    waferhand_state saved = {0};
    for (int64_t seq = 1; seq <= SAVED + 20; ++seq) {
        keep_slice(RUN, seq);
        if (seq == SAVED) {
            assert_true(wh_link_decode_state(server.encoded, server.encoded_size, &saved));
        }
    }
    saved.run = AGAIN;
    assert_int_equal(wh_protocol_server_restore(&server, &saved), WH_SERVER_RESTORED);
    (void)waferhand_state_decode_cleanup(&saved);
    waferhand_command message = command(SAVED);
    message.run = AGAIN;
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_link_seal(bytes, (size_t)size);
    keep_event(WH_CHANNEL_COMMAND, bytes, (size_t)size);
    keep_event(WH_CHANNEL_STATE, server.encoded, server.encoded_size);
    const size_t at = event_count - 1;
    for (int64_t seq = SAVED + 1; seq <= SAVED + 30; ++seq) {
        keep_slice(AGAIN, seq);
    }
    return at;
}

/* Replays all of them but some. */
static void replay_without(size_t from, size_t to) {
    wh_replay_close(&replay);
    memset(&replay, 0, sizeof replay);
    tell_cell();
    for (size_t i = 0; i < event_count; ++i) {
        if (i < from || i >= to) {
            wh_replay_look_ahead(&replay, events[i].channel, events[i].data, events[i].size);
        }
    }
    for (size_t i = 0; i < event_count; ++i) {
        if (i < from || i >= to) {
            wh_replay_event(&replay, events[i].channel, events[i].data, events[i].size);
        }
    }
    wh_replay_end(&replay);
    assert_int_equal(replay.run_count, 2);
}

static void let_events_go(void) {
    for (size_t i = 0; i < event_count; ++i) {
        free(events[i].data);
    }
    event_count = 0;
}

static void a_run_that_goes_on_from_an_earlier_state_is_whole(void **state) {
    (void)state;
    (void)keep_two_runs();
    replay_without(0, 0);
    const wh_replay_run_t *again = &replay.runs[1];
    assert_int_equal(replay.runs[0].slices.compared, SAVED + 20);
    assert_int_equal(again->goes_on_from, RUN);
    assert_int_equal(again->first_slice, SAVED);
    assert_int_equal(again->slices.compared, 30);
    assert_int_equal(again->slices.differing + again->slices.skipped + again->slices.taken_up +
                         again->slices.unanswered,
                     0);
    assert_true(again->hash == wh_protocol_server_hash(&server));
    let_events_go();
}

/* The state is missing; so is the one of the earlier run; so are slices of the later run behind it. */
static void what_goes_on_from_no_known_state_has_lost_slices(void **state) {
    (void)state;
    const size_t begins = keep_two_runs();
    replay_without(begins, begins + 1);
    assert_int_equal(replay.runs[1].goes_on_from, 0);
    assert_int_equal(replay.runs[1].slices.skipped, SAVED + 1);
    assert_int_equal(replay.runs[1].slices.taken_up, 1);
    const size_t earlier = 2 * (SAVED - 5);
    replay_without(earlier, earlier + 20);
    assert_true(replay.runs[0].slices.skipped > 0);
    assert_int_equal(replay.runs[1].goes_on_from, 0);
    assert_int_equal(replay.runs[1].slices.skipped, SAVED);
    assert_int_equal(replay.runs[1].slices.taken_up, 1);
    replay_without(begins + 1, begins + 7);
    assert_int_equal(replay.runs[1].goes_on_from, RUN);
    assert_int_equal(replay.runs[1].slices.skipped, 4);
    assert_int_equal(replay.runs[1].slices.taken_up, 1);
    let_events_go();
}

/* A state with that number that belongs to no slice cannot be a start. */
static void another_state_of_the_same_slice_is_no_earlier_one(void **state) {
    (void)state;
    const size_t begins = keep_two_runs();
    const size_t other = 2 * SAVED + 1; /* the slice behind it, reported as this one's */
    waferhand_state message;
    assert_true(wh_link_decode_state(events[other].data, events[other].size, &message));
    message.run = AGAIN;
    message.seq = SAVED;
    message.utime = 1000 * SAVED;
    assert_int_equal(waferhand_state_encode(bytes, 0, (int)sizeof bytes, &message), events[begins].size);
    wh_link_seal(bytes, events[begins].size);
    memcpy(events[begins].data, bytes, events[begins].size);
    (void)waferhand_state_decode_cleanup(&message);
    replay_without(0, 0);
    assert_int_equal(replay.runs[1].goes_on_from, 0);
    assert_true(replay.runs[1].slices.skipped >= SAVED);
    let_events_go();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_same, set_up, tear_down),
        cmocka_unit_test_setup_teardown(states_before_their_commands, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_first_difference_is_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_state_that_comes_again_otherwise_is_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(another_command_is_found_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(valves_from_outside_are_followed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_hole_is_bridged, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_hole_of_any_size_is_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_reason_of_a_failed_run_is_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_verdict_that_contradicts_is_damage, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_of_another_layout_is_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cells_that_no_layout_describes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(garbage_is_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_body_without_a_check_differs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(states_behind_later_commands, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_state_that_is_missing_is_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(messages_on_other_channels, set_up, tear_down),
        cmocka_unit_test(event_numbers_tell_what_is_missing),
        cmocka_unit_test_setup_teardown(damaged_logs_never_say_more_than_they_have, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_forged_state_differs_where_it_stands, set_up, tear_down),
        cmocka_unit_test_setup_teardown(an_unknown_version_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_changed_cell_is_no_difference, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_log_that_is_not_closed_is_cut, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_that_goes_on_from_an_earlier_state_is_whole, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_goes_on_from_no_known_state_has_lost_slices, set_up, tear_down),
        cmocka_unit_test_setup_teardown(another_state_of_the_same_slice_is_no_earlier_one, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
