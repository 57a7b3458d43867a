/* What motion control takes as a state, and what not, though its hash is right: a simulator on memq that says something
 * impossible first, and then the truth. */
#include "support/support.h"

#include "layout/layout.h"
#include "link/messages.h"
#include "link/protocol_client.h"
#include "link/protocol_server.h"

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

/* wh_physics_state_hash of what the message says. */
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
    assert_int_equal(client.event_count, 1);
}

static void impossible_states_are_not(void **state) {
    (void)state;
    static change_t *const changes[] = {
        hold_no_such_wafer,    hold_by_no_such_gripper, put_wafer_nowhere,     switch_half,
        miss_no_wafer,         pick_by_nobody,          hand_over_from_nobody, lie_below_no_such_wafer,
        measure_in_the_future, measure_before_the_run,  refuse_a_wafer};
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        /* More than once where the machine was so busy that the client asked again. */
        if (malformed_after(changes[i]) == 0) {
            fail_msg("change %zu was taken", i);
        }
        assert_int_equal(client.event_count, 0);
        assert_true(client.hash == wh_protocol_server_hash(&server));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_possible_state_is_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(impossible_states_are_not, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("client", tests, NULL, NULL);
}
