/* Recordings in memory: what is the same, what differs and how that is named, what is not there. */
#include "support/support.h"

#include "layout/layout.h"
#include "link/messages.h"
#include "log/replay.h"

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

/* As if another simulator had computed another state. */
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
    assert_int_equal(only_run()->compared, 30);
    assert_int_equal(only_run()->differing, 0);
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
    assert_int_equal(only_run()->compared, 5);
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
    assert_int_equal(run->differing, 2);
    assert_int_equal(run->difference.slice, 4);
    assert_string_equal(run->difference.what, "Wafer 2, position z");
    assert_near(run->difference.recorded, 900.5, 0);
    assert_near(run->difference.replayed, 900, 0);
    assert_int_equal(run->compared, 6);
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
    assert_int_equal(only_run()->differing, 1);
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
    assert_int_equal(only_run()->outside_valves, 1);
    assert_int_equal(only_run()->differing, 0);
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
    assert_int_equal(only_run()->differing, 0);
    assert_int_equal(only_run()->taken_up, 1);
    assert_int_equal(only_run()->last_slice, 9);
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

/* Numbers that a layout's file would be refused for, too: their squares are zero, and something divides by them. */
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
    assert_int_equal(replay.losses[WH_REPLAY_GARBAGE].count, 3);
    assert_int_equal(replay.run_count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_same, set_up, tear_down),
        cmocka_unit_test_setup_teardown(states_before_their_commands, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_first_difference_is_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(another_command_is_found_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(valves_from_outside_are_followed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_hole_is_bridged, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cells_that_no_layout_describes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(garbage_is_counted, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
