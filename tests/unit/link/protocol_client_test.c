/* The states that motion control accepts, and those that it refuses though their hash is right: a
 * simulator on memq first publishes an impossible state, and then the true one. The test also
 * checks when motion control stops waiting, and when it assumes silence. */
#include "support/support.h"

#include <time.h>

#include "layout/layout.h"
#include "link/protocol_client.h"
#include "link/protocol_server.h"
#include "reading/layout_read.h"
#include "wire/messages.h"

typedef void change_t(waferhand_state *message);

static wh_sandbox_t *sandbox;
static const wh_layout_t *layout;
static wh_protocol_server_t server;
static wh_protocol_client_t client;
static wh_node_t node;
static change_t *change;

static int set_up(void **state) {
    (void)state;
    const wh_sandbox_limits_t limits = {.print_to = stderr};
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(&limits);
    layout = wh_layout_load(sandbox, "lua/layouts/paper.lua", &result);
    return layout ? 0 : -1;
}

static int tear_down(void **state) {
    (void)state;
    wh_sandbox_free(sandbox);
    return 0;
}

/* wh_physics_state_hash of the message's contents. */
static int64_t hash_of(const waferhand_state *message) {
    static wh_link_arrays_t arrays;
    wh_grasp_t table;
    memset(&table, 0, sizeof table);
    wh_state_t state;
    (void)wh_link_state_from_message(message, &layout->grasp.tolerance, &arrays, &state);
    table.slice = (uint64_t)message->seq;
    table.storage.wafers = arrays.wafers;
    table.storage.wafer_count = (size_t)message->wafer_count;
    table.storage.grippers = arrays.grippers;
    table.storage.gripper_count = (size_t)message->gripper_count;
    return (int64_t)wh_physics_state_hash(&arrays.physics, &table);
}

static void tell_changed_state(void) {
    static uint8_t bytes[WH_LINK_DATAGRAM];
    static waferhand_event event = {.kind = WH_EVENT_PICKED, .other = WH_NONE, .measured_slice = 1};
    waferhand_state message;
    assert_true(wh_link_decode_state(server.encoded, server.encoded_size, &message));
    waferhand_event *const own = message.events;
    const int32_t own_count = message.event_count;
    message.events = &event;
    message.event_count = 1;
    change(&message);
    message.hash = hash_of(&message);
    const int size = waferhand_state_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_link_seal(bytes, (size_t)size);
    assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, bytes, (size_t)size));
    const waferhand_event plain = {.kind = WH_EVENT_PICKED, .other = WH_NONE, .measured_slice = 1};
    event = plain;
    message.events = own;
    message.event_count = own_count;
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_command(void *user, const void *data, size_t size) {
    (void)user;
    waferhand_command message;
    assert_true(wh_link_decode_command(data, size, &message));
    (void)wh_protocol_server_command(&server, &message, NULL);
    tell_changed_state();
    assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, server.encoded, server.encoded_size));
}

static uint64_t malformed_after(change_t *what) {
    wh_command_t command = {.seq = 1, .utime = 1000, .gripper_count = 2, .axis_count = 5};
    wh_state_t state = {.status = WH_OK};
    const wh_protocol_client_options_t options = {.rate = 0};
    for (size_t g = 0; g < 2; ++g) {
        command.grippers[g].base_from_gripper = wh_pose_identity();
        command.grippers[g].valve = WH_VALVE_CLOSED;
    }
    change = what;
    assert_true(wh_node_open(&node, "memq://", NULL));
    assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
    assert_true(wh_protocol_client_open(&client, &node, layout, &options));
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, on_command, NULL));
    assert_int_equal(client.link.exchange(&client.link, &command, &state), WH_OK);
    (void)wh_node_drain(&node, 64);
    wh_node_close(&node);
    return client.counters.malformed;
}

/* ----------------------------------------------------------------------------------------------- the changes */

static void change_nothing(waferhand_state *message) {
    (void)message;
}

static void hold_no_such_wafer(waferhand_state *message) {
    message->grippers[0].wafer = 123456;
    message->grippers[0].valve = WH_VALVE_OPEN;
}

static void hold_by_no_such_gripper(waferhand_state *message) {
    message->wafers[0].holder = -7;
}

static void put_wafer_nowhere(waferhand_state *message) {
    message->wafers[0].position[1] = (double)NAN;
}

static void switch_half(waferhand_state *message) {
    message->grippers[1].valve = 2;
}

static void miss_no_wafer(waferhand_state *message) {
    message->events[0].kind = WH_EVENT_NEAR_MISS;
    message->events[0].wafer = WH_NONE;
}

static void pick_by_nobody(waferhand_state *message) {
    message->events[0].gripper = WH_NONE;
}

static void hand_over_from_nobody(waferhand_state *message) {
    message->events[0].kind = WH_EVENT_HANDED_OVER;
    message->events[0].other = 2;
}

static void lie_below_no_such_wafer(waferhand_state *message) {
    message->events[0].kind = WH_EVENT_SLOT_OCCUPIED;
    message->events[0].other = 2;
}

static void measure_in_the_future(waferhand_state *message) {
    message->events[0].measured_slice = INT64_MAX;
}

static void measure_before_the_run(waferhand_state *message) {
    message->events[0].measured_slice = -1;
}

static void refuse_a_wafer(waferhand_state *message) {
    message->events[0].kind = WH_EVENT_BAD_INPUT;
}

static void a_possible_state_is_taken(void **state) {
    (void)state;
    assert_int_equal(malformed_after(change_nothing), 0);
    assert_int_equal(client.heard.count, 1);
}

static void impossible_states_are_not(void **state) {
    (void)state;
    static change_t *const changes[] = {
        hold_no_such_wafer,    hold_by_no_such_gripper, put_wafer_nowhere,     switch_half,
        miss_no_wafer,         pick_by_nobody,          hand_over_from_nobody, lie_below_no_such_wafer,
        measure_in_the_future, measure_before_the_run,  refuse_a_wafer};
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        /* There may be more than one on a busy machine, on which the client asked again. */
        if (malformed_after(changes[i]) == 0) {
            fail_msg("change %zu was taken", i);
        }
        assert_int_equal(client.heard.count, 0);
        assert_true(client.taken.hash == wh_protocol_server_hash(&server));
    }
}

/* ------------------------------------------------------------------------------------ when to wait no longer */

/* The way the simulator answers: as one of another layout does, a slice late, or not at all. */
static bool has_other_layout, is_late, is_silent;

static volatile sig_atomic_t stop;
static char said[4096];

static void hear_line(void *user, const char *line) {
    (void)user;
    const size_t length = strlen(said);
    snprintf(said + length, sizeof said - length, "%s\n", line);
}

static void open_client(const wh_protocol_client_options_t *options) {
    stop = 0;
    has_other_layout = is_late = is_silent = false;
    said[0] = '\0';
    assert_true(wh_node_open(&node, "memq://", NULL));
    node.speaker = "mcs";
    node.listener = hear_line;
    assert_int_equal(wh_protocol_server_open(&server, layout), WH_OK);
    assert_true(wh_protocol_client_open(&client, &node, layout, options));
}

static wh_status_t send_slice(int64_t seq, wh_state_t *state) {
    wh_command_t command = {.seq = seq, .utime = 1000 * seq, .gripper_count = 2, .axis_count = 5};
    for (size_t g = 0; g < 2; ++g) {
        command.grippers[g].base_from_gripper = wh_pose_identity();
        command.grippers[g].valve = WH_VALVE_CLOSED;
    }
    return client.link.exchange(&client.link, &command, state);
}

static void answer_truly(void *user, const void *data, size_t size) {
    (void)user;
    waferhand_command message;
    const size_t late_bytes = is_late ? server.encoded_size : 0;
    static uint8_t late[WH_LINK_DATAGRAM];
    memcpy(late, server.encoded, late_bytes);
    assert_true(wh_link_decode_command(data, size, &message));
    message.layout_hash += has_other_layout ? 1 : 0;
    (void)wh_protocol_server_command(&server, &message, NULL);
    if (is_silent || is_late) {
        assert_true(is_silent || wh_node_publish(&node, WH_CHANNEL_STATE, late, late_bytes));
        return;
    }
    assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, server.encoded, server.encoded_size));
}

/* The stop of a signal that comes once the command is out. */
static void stop_and_answer(void *user, const void *data, size_t size) {
    stop = 1;
    answer_truly(user, data, size);
}

static void a_simulator_that_does_not_answer_in_time_is_an_error_until_it_answers(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.timeout_us = 100000};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    for (int times = 0; times < 2; ++times) {
        const int64_t begin = wh_node_clock_us();
        assert_int_equal(send_slice(1, &answer), WH_STATUS_NO_ANSWER);
        assert_in_range(wh_node_clock_us() - begin, 100000, 5000000);
        assert_true(client.silence.timed_out);
    }
    assert_int_equal(wh_protocol_client_resume(&client), WH_STATUS_NO_ANSWER);
    assert_int_equal(wh_protocol_client_reached(&client), 1);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_truly, NULL));
    assert_int_equal(wh_protocol_client_resume(&client), WH_OK);
    assert_int_equal(send_slice(2, &answer), WH_OK);
    assert_false(client.silence.timed_out);
    assert_int_equal(server.seq, 2);
    wh_node_close(&node);
}

/* A simulator whose states cannot be. */
static void answer_impossibly(void *user, const void *data, size_t size) {
    (void)user;
    waferhand_command message;
    assert_true(wh_link_decode_command(data, size, &message));
    (void)wh_protocol_server_command(&server, &message, NULL);
    change = hold_by_no_such_gripper;
    tell_changed_state();
}

static void impossible_answers_end_a_wait_as_none_would(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.timeout_us = 200000};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_impossibly, NULL));
    assert_int_equal(send_slice(1, &answer), WH_STATUS_NO_ANSWER);
    assert_true(client.silence.timed_out && client.counters.malformed > 0);
    const char *told = strstr(said, "the simulator's state of slice 1 cannot be one of this layout");
    assert_non_null(told);
    assert_null(strstr(told + 1, "the simulator's state"));
    wh_node_close(&node);
}

/* It runs at full speed after its first slice, which a simulator has answered. */
static void begin_free_run(int64_t timeout_us, wh_state_t *answer) {
    const wh_protocol_client_options_t options = {.rate = 1000, .timeout_us = timeout_us};
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_truly, NULL));
    assert_int_equal(send_slice(1, answer), WH_OK);
}

static void a_refused_slice_has_not_gone_out(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.rate = 0};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_int_equal(wh_protocol_client_reached(&client), 0);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_truly, NULL));
    assert_int_equal(send_slice(1, &answer), WH_OK);
    has_other_layout = true;
    assert_int_equal(send_slice(2, &answer), WH_STATUS_OTHER_LAYOUT);
    assert_int_equal(wh_protocol_client_reached(&client), 1);
    assert_int_equal(wh_protocol_client_resume(&client), WH_OK);
    assert_int_equal(wh_protocol_client_reached(&client), 1);
    has_other_layout = false;
    assert_int_equal(send_slice(2, &answer), WH_OK);
    assert_int_equal(wh_protocol_client_reached(&client), 2);
    wh_node_close(&node);
}

/* Its answers come a slice late. */
static void a_free_run_hears_that_a_slice_before_the_last_was_refused(void **state) {
    (void)state;
    wh_state_t answer = {.status = WH_OK};
    begin_free_run(0, &answer);
    has_other_layout = true;
    is_late = true;
    assert_int_equal(send_slice(2, &answer), WH_OK);
    assert_int_equal(send_slice(3, &answer), WH_STATUS_OTHER_LAYOUT);
    assert_int_equal(client.link.missed(&client.link), 2);
    wh_node_close(&node);
}

static int64_t told[20];
static size_t told_count;

static void note_state(void *user, const wh_state_t *state) {
    (void)user;
    assert_true(told_count < sizeof told / sizeof told[0]);
    told[told_count++] = state->seq;
}

/* The answers from slice 2 on come all at once, behind slice 4, and each of them twice. */
static void answer_in_a_heap(void *user, const void *data, size_t size) {
    static uint8_t kept[3][WH_LINK_DATAGRAM];
    static size_t sizes[3];
    waferhand_command message;
    (void)user;
    assert_true(wh_link_decode_command(data, size, &message));
    (void)wh_protocol_server_command(&server, &message, NULL);
    if (message.seq == 1) {
        assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, server.encoded, server.encoded_size));
    } else if (message.seq <= 4) {
        sizes[message.seq - 2] = server.encoded_size;
        memcpy(kept[message.seq - 2], server.encoded, server.encoded_size);
    }
    for (size_t i = 0; message.seq == 4 && i < 6; ++i) {
        assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, kept[i / 2], sizes[i / 2]));
    }
}

/* An edge scan has samples in each state, so no state between two exchanges may be skipped. */
static void a_free_run_tells_each_state_that_it_takes_once(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.rate = 1000, .taken = note_state};
    wh_state_t answer = {.status = WH_OK};
    told_count = 0;
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_in_a_heap, NULL));
    for (int64_t seq = 1; seq <= 5; ++seq) {
        assert_int_equal(send_slice(seq, &answer), WH_OK);
    }
    (void)wh_node_drain(&node, 64);
    assert_int_equal(told_count, 4);
    for (size_t i = 0; i < 4; ++i) {
        assert_int_equal(told[i], i + 1);
    }
    wh_node_close(&node);
}

/* Without an answer from a simulator the next slice is due all the same, unless its state is awaited. */
static void a_free_run_waits_for_a_state_that_is_awaited(void **state) {
    (void)state;
    wh_state_t answer = {.status = WH_OK};
    begin_free_run(300000, &answer);
    is_late = true;
    assert_int_equal(send_slice(2, &answer), WH_OK);
    assert_int_equal(answer.seq, 1);
    wh_protocol_client_await(&client);
    assert_int_equal(send_slice(3, &answer), WH_OK);
    assert_int_equal(answer.seq, 3);
    is_silent = true;
    assert_int_equal(send_slice(4, &answer), WH_OK);
    wh_protocol_client_await(&client);
    assert_int_equal(send_slice(5, &answer), WH_STATUS_NO_ANSWER);
    assert_int_equal(answer.seq, 3);
    wh_node_close(&node);
}

/* The slices that the simulator has stepped are accepted; nothing is sent after the stop. */
static void a_stop_loses_no_slice(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.stop = &stop};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, stop_and_answer, NULL));
    assert_int_equal(send_slice(1, &answer), WH_OK);
    assert_int_equal(answer.seq, 1);
    /* On a busy machine the first slice may have been sent twice. */
    (void)wh_node_drain(&node, 64);
    const uint64_t commands = server.counters.commands;
    assert_int_equal(send_slice(2, &answer), WH_STATUS_STOPPED);
    (void)wh_node_drain(&node, 64);
    assert_int_equal(server.counters.commands, commands);
    assert_true(client.link.hash(&client.link) == wh_protocol_server_hash(&server));
    assert_int_equal(server.seq, 1);
    wh_node_close(&node);
}

static bool has_come(void) {
    return true;
}

/* It came while the client did not wait, as when the client reports that there is no answer. */
static void a_signal_between_two_waits_ends_the_wait_for_a_silent_simulator(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.interrupted = has_come, .timeout_us = 10000000};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_int_equal(send_slice(1, &answer), WH_STATUS_STOPPED);
    wh_node_close(&node);
}

/* The senders of the states, slice by slice. */
static bool is_shared(const uint64_t *senders, size_t count) {
    const wh_protocol_client_options_t options = {.rate = 0};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_truly, NULL));
    for (size_t i = 0; i < count; ++i) {
        node.sender = senders[i];
        assert_int_equal(send_slice((int64_t)i + 1, &answer), WH_OK);
    }
    wh_node_close(&node);
    assert_true(client.senders.shared == (strstr(said, "two simulators answer") != NULL));
    return client.senders.shared;
}

static void two_simulators_are_told_from_one_that_was_started_anew(void **state) {
    (void)state;
    static const uint64_t anew[] = {1, 1, 2, 2, 3, 3, 3}, two[] = {1, 1, 2, 1}, unknown[] = {0, 0, 0};
    assert_false(is_shared(anew, 7));
    assert_true(is_shared(two, 4));
    assert_false(is_shared(unknown, 3));
}

static void sleep_ms(long ms) {
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000};
    (void)nanosleep(&pause, NULL);
}

/* It owes no answer before the first command, and while nothing is sent. Then it owes one. */
static void a_simulator_that_was_not_asked_is_not_silent(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.rate = 0};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    sleep_ms(WH_CLIENT_SILENCE_US / 1000 + 100);
    wh_protocol_client_heartbeat(&client);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_truly, NULL));
    assert_int_equal(send_slice(1, &answer), WH_OK);
    sleep_ms(WH_CLIENT_SILENCE_US / 1000 + 100);
    wh_protocol_client_heartbeat(&client);
    wh_protocol_client_heartbeat(&client);
    assert_int_equal(client.counters.silences, 0);
    assert_string_equal(said, "");
    wh_node_close(&node);
    assert_true(wh_node_open(&node, "memq://", NULL)); /* where nobody is */
    wh_protocol_client_heartbeat(&client);
    sleep_ms(WH_CLIENT_SILENCE_US / 1000 + 100);
    wh_protocol_client_heartbeat(&client);
    assert_int_equal(client.counters.silences, 1);
    wh_node_close(&node);
}

/* The slices behind the last state, about which nobody knows. */
/* A simulator that does everything except take a state back. */
static void answer_but_take_nothing(void *user, const void *data, size_t size) {
    waferhand_command message;
    assert_true(wh_link_decode_command(data, size, &message));
    if (message.run == server.identity.run || message.seq == 1) {
        answer_truly(user, data, size);
        return;
    }
    (void)wh_protocol_server_command(&server, &message, NULL); /* UNKNOWN_RUN */
    assert_true(wh_node_publish(&node, WH_CHANNEL_STATE, server.encoded, server.encoded_size));
}

static void take_back(void *user, const void *data, size_t size) {
    (void)user;
    waferhand_state message;
    assert_true(wh_link_decode_state(data, size, &message));
    (void)wh_protocol_server_restore(&server, &message);
    (void)waferhand_state_decode_cleanup(&message);
}

static void a_run_is_put_back_if_the_simulator_takes_its_state(void **state) {
    (void)state;
    static uint8_t saved[2][sizeof(waferhand_command) + WH_LINK_DATAGRAM];
    const wh_protocol_client_options_t options = {.rate = 0};
    wh_state_t answer = {.status = WH_OK};
    open_client(&options);
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_COMMAND, answer_but_take_nothing, NULL));
    const size_t before = wh_protocol_client_save(&client, saved[0]);
    for (int64_t seq = 1; seq <= 3; ++seq) {
        assert_int_equal(send_slice(seq, &answer), WH_OK);
    }
    const size_t size = wh_protocol_client_save(&client, saved[1]);
    const uint64_t hash = client.taken.hash;
    const int64_t run = client.identity.run;
    assert_int_equal(send_slice(4, &answer), WH_OK);
    assert_int_equal(wh_protocol_client_restore(&client, saved[1], size, &answer), WH_STATUS_NOT_RESTORED);
    assert_int_equal(client.identity.run, run);
    assert_int_equal(send_slice(5, &answer), WH_OK); /* everything is as before */
    assert_int_equal(server.seq, 5);

    assert_true(wh_node_subscribe(&node, WH_CHANNEL_RESTORE, take_back, NULL));
    assert_int_equal(wh_protocol_client_restore(&client, saved[1], size, &answer), WH_OK);
    assert_true(client.identity.run != run);
    assert_int_equal(client.taken.hash, hash);
    assert_int_equal(answer.seq, 3);
    assert_int_equal(answer.event_count, 0);
    assert_int_equal(server.seq, 3);
    assert_int_equal(send_slice(4, &answer), WH_OK);
    assert_int_equal(server.seq, 4);

    assert_int_equal(wh_protocol_client_restore(&client, saved[0], before, &answer), WH_OK);
    assert_int_equal(send_slice(1, &answer), WH_OK);
    assert_int_equal(server.seq, 1);
    assert_string_equal(said, "");
    wh_node_close(&node);
}

static void slices_that_no_state_tells_of_are_missed_ones_of_a_free_run(void **state) {
    (void)state;
    wh_state_t answer = {.status = WH_OK};
    begin_free_run(0, &answer);
    assert_int_equal(client.link.missed(&client.link), 0);
    client.command.seq = 4;
    assert_int_equal(client.link.missed(&client.link), 3);
    wh_node_close(&node);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_possible_state_is_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(impossible_states_are_not, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_simulator_that_does_not_answer_in_time_is_an_error_until_it_answers,
                                        set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_refused_slice_has_not_gone_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_free_run_hears_that_a_slice_before_the_last_was_refused, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_free_run_waits_for_a_state_that_is_awaited, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_free_run_tells_each_state_that_it_takes_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(impossible_answers_end_a_wait_as_none_would, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_stop_loses_no_slice, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_signal_between_two_waits_ends_the_wait_for_a_silent_simulator,
                                        set_up, tear_down),
        cmocka_unit_test_setup_teardown(two_simulators_are_told_from_one_that_was_started_anew, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_simulator_that_was_not_asked_is_not_silent, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_run_is_put_back_if_the_simulator_takes_its_state, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(slices_that_no_state_tells_of_are_missed_ones_of_a_free_run, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests_name("client", tests, NULL, NULL);
}
