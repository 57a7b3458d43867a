/* The simulator's side of the protocol: what is stepped, repeated, ignored, turned away, taken over. */
#include "support/support.h"

#include "layout/layout.h"
#include "link/messages.h"
#include "link/protocol_server.h"

static wh_sandbox_t *sandbox;
static const wh_layout_t *layout;
static wh_protocol_server_t server;
static wh_protocol_server_t restarted;

static int set_up(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(NULL);
    layout = wh_layout_load(sandbox, "lua/layouts/paper.lua", &result);
    return layout && wh_protocol_server_open(&server, layout) == WH_OK &&
                   wh_protocol_server_open(&restarted, layout) == WH_OK
               ? 0
               : -1;
}

static int tear_down(void **state) {
    (void)state;
    wh_sandbox_free(sandbox);
    return 0;
}

/* The end-effector a little higher in each slice, everything closed. */
static waferhand_command command(int64_t run, int64_t seq) {
    waferhand_command message;
    memset(&message, 0, sizeof message);
    message.run = run;
    message.seq = seq;
    message.utime = 1000 * seq;
    message.layout_hash = (int64_t)server.identity.layout_hash;
    message.lockstep = 1;
    message.gripper_count = 2;
    message.axis_count = 5;
    for (size_t g = 0; g < 2; ++g) {
        message.gripper_position[g][0] = 300;
        message.gripper_position[g][2] = 900 + 0.01 * (double)seq;
        message.gripper_rotation[g][0] = message.gripper_rotation[g][4] = message.gripper_rotation[g][8] = 1;
        message.valve[g] = 1;
    }
    return message;
}

static wh_protocol_server_result_t send(wh_protocol_server_t *to, int64_t run, int64_t seq) {
    const waferhand_command message = command(run, seq);
    return wh_protocol_server_command(to, &message, NULL);
}

static int32_t answered_status(const wh_protocol_server_t *by) {
    waferhand_state message;
    assert_true(wh_link_decode_state(by->encoded, by->encoded_size, &message));
    const int32_t status = message.status;
    (void)waferhand_state_decode_cleanup(&message);
    return status;
}

static wh_protocol_server_result_t hand_over_state(void (*change)(waferhand_state *message)) {
    waferhand_state message;
    assert_true(wh_link_decode_state(server.encoded, server.encoded_size, &message));
    if (change) {
        change(&message);
    }
    const wh_protocol_server_result_t result = wh_protocol_server_restore(&restarted, &message);
    (void)waferhand_state_decode_cleanup(&message);
    return result;
}

static void each_slice_once(void **state) {
    (void)state;
    assert_int_equal(send(&server, 7, 1), WH_SERVER_NEW_RUN);
    assert_int_equal(send(&server, 7, 2), WH_SERVER_STEPPED);
    const uint64_t hash = wh_protocol_server_hash(&server);
    assert_int_equal(send(&server, 7, 2), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_OK);
    assert_int_equal(send(&server, 7, 1), WH_SERVER_IGNORED);
    assert_true(wh_protocol_server_hash(&server) == hash);
    assert_int_equal(server.counters.stepped, 2);
    assert_int_equal(server.counters.repeated, 1);
    assert_int_equal(server.counters.stale, 1);
}

static void gaps(void **state) {
    (void)state;
    send(&server, 7, 1);
    assert_int_equal(send(&server, 7, 3), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_STATUS_UNKNOWN_RUN);
    waferhand_command free_running = command(7, 4);
    free_running.lockstep = 0;
    assert_int_equal(wh_protocol_server_command(&server, &free_running, NULL), WH_SERVER_STEPPED);
    assert_int_equal(server.missed, 2);
}

static void runs_and_layouts(void **state) {
    (void)state;
    send(&server, 7, 1);
    assert_int_equal(send(&server, 8, 5), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_STATUS_UNKNOWN_RUN);
    assert_int_equal(send(&server, 8, 1), WH_SERVER_NEW_RUN);
    assert_int_equal(send(&server, 7, 2), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_STATUS_RUN_OVER);
    waferhand_command other = command(8, 2);
    other.layout_hash += 1;
    assert_int_equal(wh_protocol_server_command(&server, &other, NULL), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_STATUS_OTHER_LAYOUT);
    assert_int_equal(send(&server, 0, 1), WH_SERVER_IGNORED);
    assert_int_equal(send(&server, 8, 0), WH_SERVER_IGNORED);
    assert_int_equal(server.counters.commands, server.counters.stepped + server.counters.unknown_run +
                                                   server.counters.run_over + server.counters.other_layout +
                                                   server.counters.malformed);
}

static void a_refused_command_changes_nothing(void **state) {
    (void)state;
    send(&server, 7, 1);
    const uint64_t hash = wh_protocol_server_hash(&server);
    waferhand_command bad = command(7, 2);
    bad.valve[1] = 2;
    assert_int_equal(wh_protocol_server_command(&server, &bad, NULL), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&server), WH_STATUS_BAD_VALVE);
    assert_true(wh_protocol_server_hash(&server) == hash);
    assert_int_equal(send(&server, 7, 1), WH_SERVER_ANSWERED);
    assert_int_equal(server.room.message.event_count, 0);
    assert_int_equal(send(&server, 7, 2), WH_SERVER_STEPPED);
}

static void valves_from_outside(void **state) {
    static const int32_t open[WH_GRIPPERS] = {0, 0};
    (void)state;
    const waferhand_command message = command(7, 1);
    assert_int_equal(wh_protocol_server_command(&server, &message, open), WH_SERVER_NEW_RUN);
    assert_int_equal(server.state.grippers[0].valve, 0);
}

static void a_restarted_simulator_goes_on(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 5; ++seq) {
        send(&server, 7, seq);
    }
    assert_int_equal(send(&restarted, 7, 6), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&restarted), WH_STATUS_UNKNOWN_RUN);
    assert_int_equal(hand_over_state(NULL), WH_SERVER_RESTORED);
    assert_int_equal(hand_over_state(NULL), WH_SERVER_IGNORED);
    assert_int_equal(send(&restarted, 7, 6), WH_SERVER_STEPPED);
    send(&server, 7, 6);
    assert_true(wh_protocol_server_hash(&restarted) == wh_protocol_server_hash(&server));
}

static void shift_wafer(waferhand_state *message) {
    message->wafers[0].position[0] += 1e-9;
}

static void hold_twice(waferhand_state *message) {
    message->wafers[0].holder = 1;
}

static void spoil_rotation(waferhand_state *message) {
    message->wafers[1].rotation[0] = (double)NAN;
}

static void change_layout(waferhand_state *message) {
    message->layout_hash += 1;
}

static void drop_wafer(waferhand_state *message) {
    message->wafer_count -= 1;
}

static void miss_more_than_there_are(waferhand_state *message) {
    message->missed = INT64_MIN;
}

static void no_other_state_is_taken_over(void **state) {
    static void (*const changes[])(waferhand_state * message) = {
        shift_wafer, hold_twice, spoil_rotation, change_layout, miss_more_than_there_are, drop_wafer};
    (void)state;
    send(&server, 7, 1);
    const uint64_t hash = wh_protocol_server_hash(&restarted);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        assert_int_equal(hand_over_state(changes[i]), WH_SERVER_IGNORED);
        assert_true(wh_protocol_server_hash(&restarted) == hash);
    }
}

/* Of a sealed message, no other bits pass; cut short, it does not either. */
static void flipped_bits_are_seen(void **state) {
    (void)state;
    uint8_t bytes[2048];
    waferhand_command message = command(7, 1);
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &message);
    assert_true(wh_link_decode_command(bytes, (size_t)size, &message)); /* not sealed: nobody checks */
    wh_link_seal(bytes, (size_t)size);
    assert_true(wh_link_decode_command(bytes, (size_t)size, &message));
    for (size_t bit = 0; bit < 8 * (size_t)size; ++bit) {
        bytes[bit / 8] ^= (uint8_t)(1U << bit % 8);
        assert_false(wh_link_decode_command(bytes, (size_t)size, &message));
        bytes[bit / 8] ^= (uint8_t)(1U << bit % 8);
    }
    for (size_t cut = 0; cut < (size_t)size; ++cut) {
        assert_false(wh_link_decode_command(bytes, cut, &message));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_slice_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(gaps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(runs_and_layouts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_refused_command_changes_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(valves_from_outside, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_restarted_simulator_goes_on, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_other_state_is_taken_over, set_up, tear_down),
        cmocka_unit_test_setup_teardown(flipped_bits_are_seen, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
