/* The simulator's side of the protocol: which messages are stepped, repeated, ignored, refused or
 * taken over. */
#include "support/support.h"

#include "layout/layout.h"
#include "link/protocol_server.h"
#include "mcs/script_run.h"
#include "reading/layout_read.h"
#include "support/server.h"
#include "wire/messages.h"

static wh_sandbox_t *sandbox;
static const wh_layout_t *paper;
static wh_protocol_server_t protocol;
static wh_protocol_server_t restarted;

static int set_up(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(NULL);
    paper = wh_layout_load(sandbox, "lua/layouts/paper.lua", &result);
    return paper && wh_protocol_server_open(&protocol, paper) == WH_OK &&
                   wh_protocol_server_open(&restarted, paper) == WH_OK
               ? 0
               : -1;
}

static int tear_down(void **state) {
    (void)state;
    wh_sandbox_free(sandbox);
    return 0;
}

/* The end-effector rises a little in each slice, with everything closed. */
static waferhand_command command(int64_t run, int64_t seq) {
    waferhand_command message;
    memset(&message, 0, sizeof message);
    message.run = run;
    message.seq = seq;
    message.utime = 1000 * seq;
    message.layout_hash = (int64_t)protocol.identity.layout_hash;
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
    assert_true(wh_link_decode_state(protocol.encoded, protocol.encoded_size, &message));
    if (change) {
        change(&message);
    }
    const wh_protocol_server_result_t result = wh_protocol_server_restore(&restarted, &message);
    (void)waferhand_state_decode_cleanup(&message);
    return result;
}

static void each_slice_once(void **state) {
    (void)state;
    assert_int_equal(send(&protocol, 7, 1), WH_SERVER_NEW_RUN);
    assert_int_equal(send(&protocol, 7, 2), WH_SERVER_STEPPED);
    const uint64_t hash = wh_protocol_server_hash(&protocol);
    assert_int_equal(send(&protocol, 7, 2), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_OK);
    assert_int_equal(send(&protocol, 7, 1), WH_SERVER_IGNORED);
    assert_true(wh_protocol_server_hash(&protocol) == hash);
    assert_int_equal(protocol.counters.stepped, 2);
    assert_int_equal(protocol.counters.repeated, 1);
    assert_int_equal(protocol.counters.stale, 1);
}

static void gaps(void **state) {
    (void)state;
    send(&protocol, 7, 1);
    assert_int_equal(send(&protocol, 7, 3), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_STATUS_UNKNOWN_RUN);
    waferhand_command free_running = command(7, 4);
    free_running.lockstep = 0;
    assert_int_equal(wh_protocol_server_command(&protocol, &free_running, NULL), WH_SERVER_STEPPED);
    assert_int_equal(protocol.missed, 2);
}

static void runs_and_layouts(void **state) {
    (void)state;
    send(&protocol, 7, 1);
    assert_int_equal(send(&protocol, 8, 5), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_STATUS_UNKNOWN_RUN);
    assert_int_equal(send(&protocol, 8, 1), WH_SERVER_NEW_RUN);
    assert_int_equal(send(&protocol, 7, 2), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_STATUS_RUN_OVER);
    waferhand_command other = command(8, 2);
    other.layout_hash += 1;
    assert_int_equal(wh_protocol_server_command(&protocol, &other, NULL), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_STATUS_OTHER_LAYOUT);
    assert_int_equal(send(&protocol, 0, 1), WH_SERVER_IGNORED);
    assert_int_equal(send(&protocol, 8, 0), WH_SERVER_IGNORED);
    assert_int_equal(protocol.counters.commands,
                     protocol.counters.stepped + protocol.counters.unknown_run + protocol.counters.run_over +
                         protocol.counters.other_layout + protocol.counters.malformed);
}

static void a_refused_command_changes_nothing(void **state) {
    (void)state;
    send(&protocol, 7, 1);
    const uint64_t hash = wh_protocol_server_hash(&protocol);
    waferhand_command bad = command(7, 2);
    bad.valve[1] = 2;
    assert_int_equal(wh_protocol_server_command(&protocol, &bad, NULL), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&protocol), WH_STATUS_BAD_VALVE);
    assert_true(wh_protocol_server_hash(&protocol) == hash);
    assert_int_equal(send(&protocol, 7, 1), WH_SERVER_ANSWERED);
    assert_int_equal(protocol.room.message.event_count, 0);
    assert_int_equal(send(&protocol, 7, 2), WH_SERVER_STEPPED);
}

static void valves_from_outside(void **state) {
    static const int32_t open[WH_GRIPPERS] = {0, 0};
    (void)state;
    const waferhand_command message = command(7, 1);
    assert_int_equal(wh_protocol_server_command(&protocol, &message, open), WH_SERVER_NEW_RUN);
    assert_int_equal(protocol.state.grippers[0].valve, 0);
}

static void a_restarted_simulator_goes_on(void **state) {
    (void)state;
    for (int64_t seq = 1; seq <= 5; ++seq) {
        send(&protocol, 7, seq);
    }
    assert_int_equal(send(&restarted, 7, 6), WH_SERVER_ANSWERED);
    assert_int_equal(answered_status(&restarted), WH_STATUS_UNKNOWN_RUN);
    assert_int_equal(hand_over_state(NULL), WH_SERVER_RESTORED);
    assert_int_equal(hand_over_state(NULL), WH_SERVER_IGNORED);
    assert_int_equal(send(&restarted, 7, 6), WH_SERVER_STEPPED);
    send(&protocol, 7, 6);
    assert_true(wh_protocol_server_hash(&restarted) == wh_protocol_server_hash(&protocol));
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
    send(&protocol, 7, 1);
    const uint64_t hash = wh_protocol_server_hash(&restarted);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        assert_int_equal(hand_over_state(changes[i]), WH_SERVER_IGNORED);
        assert_true(wh_protocol_server_hash(&restarted) == hash);
    }
}

/* Only the bits of a sealed message pass; a message that is cut short does not pass either. */
static void flipped_bits_are_seen(void **state) {
    (void)state;
    uint8_t bytes[4096];
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

/* ---------------------------------------------------------------------------------------------- taking over */

/* The state of a simulator with delayed vacuum, pads and faults. Another simulator takes it over in
 * the middle of a run and goes on with the same bits. A state that no simulator can be in is
 * refused. */

#define SCRIPT "tests/end_to_end/data/delayed.lua"
#define EDGE "lua/examples/09_edge_scan.lua"
#define BEAMS "lua/examples/13_centring.lua"

static wh_protocol_server_t servers[2];
static int64_t restart_every;
static size_t restarts, faults_seen, slips_seen;
static const char *script = SCRIPT;
static uint8_t sampled[WH_LINK_DATAGRAM]; /* the first state that has samples */
static size_t sampled_size;
static uint8_t latched[WH_LINK_DATAGRAM]; /* the first state with a latch to come */
static size_t latched_size;

static void send_physics(const wh_command_t *command) {
    waferhand_command decoded;
    uint8_t bytes[4096];
    const size_t size = encode_command(command, bytes, sizeof bytes);
    assert_true(wh_link_decode_command(bytes, size, &decoded));
    /* Twice, as a network may deliver it. */
    const wh_protocol_server_result_t result = wh_protocol_server_command(server, &decoded, NULL);
    assert_true(result == WH_SERVER_STEPPED || result == WH_SERVER_NEW_RUN);
    assert_int_equal(wh_protocol_server_command(server, &decoded, NULL), WH_SERVER_ANSWERED);
}

/* Another server, which knows nothing, gets the state as it was published. */
static void restart(const wh_layout_t *layout) {
    wh_protocol_server_t *other = server == servers ? servers + 1 : servers;
    waferhand_state message;
    assert_true(wh_link_decode_state(server->encoded, server->encoded_size, &message));
    assert_int_equal(wh_protocol_server_open(other, layout), WH_OK);
    const int64_t run = message.run;
    message.run = 0; /* the number of no run */
    assert_int_equal(wh_protocol_server_restore(other, &message), WH_SERVER_IGNORED);
    message.run = 1; /* any number of a run will do */
    assert_int_equal(wh_protocol_server_restore(other, &message), WH_SERVER_RESTORED);
    assert_int_equal(wh_protocol_server_open(other, layout), WH_OK);
    message.run = run;
    assert_int_equal(wh_protocol_server_restore(other, &message), WH_SERVER_RESTORED);
    assert_true(wh_protocol_server_hash(other) == wh_protocol_server_hash(server));
    assert_int_equal(other->state.sensors, server->state.sensors);
    (void)waferhand_state_decode_cleanup(&message);
    server = other;
    ++restarts;
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    (void)link;
    send_physics(command);
    *state = server->state;
    for (size_t i = 0; i < state->event_count; ++i) {
        faults_seen += state->events[i].kind == WH_EVENT_FAULT_ARMED ? 1 : 0;
        slips_seen += state->events[i].kind == WH_EVENT_SLIPPED ? 1 : 0;
    }
    if (state->physics->scan.sample_count > 0 && sampled_size == 0) {
        sampled_size = server->encoded_size;
        memcpy(sampled, server->encoded, sampled_size);
    }
    if (state->physics->latches.waiting_count > 0 && latched_size == 0) {
        latched_size = server->encoded_size;
        memcpy(latched, server->encoded, latched_size);
    }
    if (restart_every > 0 && command->seq % restart_every == 0) {
        restart(server->layout);
    }
    return state->status;
}

static wh_link_t *connect_server(void *user, wh_mcs_t *mcs) {
    static wh_link_t link = {exchange, hash_of_server, none_missed};
    (void)user;
    server = servers;
    assert_int_equal(wh_protocol_server_open(server, mcs->layout), WH_OK);
    return &link;
}

static uint64_t run_with(int64_t every, bool by_call) {
    wh_script_run_options_t options = {.script = script};
    wh_script_run_t run;
    options.partners.connect = by_call ? NULL : connect_server;
    restart_every = every;
    restarts = faults_seen = slips_seen = 0;
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
    const uint64_t last = run.record.hash;
    wh_script_run_close(&run);
    return last;
}

static void restarted_again_and_again(void **state) {
    (void)state;
    const uint64_t by_call = run_with(0, true);
    assert_true(run_with(0, false) == by_call);
    assert_int_equal(faults_seen, 7);
    assert_int_equal(slips_seen, 1);
    assert_true(run_with(7, false) == by_call);
    assert_true(restarts > 1000);
    assert_int_equal(faults_seen, 7);
    assert_int_equal(slips_seen, 1);
    assert_true(WH_TEST_SHARE > 1 || run_with(1, false) == by_call);
}

/* Also in the middle of a scan: motion control collects the same samples, as the script's
 * expectations show. */
static void a_scan_goes_on_in_another_server(void **state) {
    (void)state;
    script = EDGE;
    sampled_size = 0;
    const uint64_t by_call = run_with(0, true);
    assert_true(by_call == UINT64_C(0xd25fb1a84344f4de));
    assert_true(run_with(0, false) == by_call);
    assert_true(sampled_size > 0);
    assert_true(run_with(7, false) == by_call);
    assert_true(restarts > 500);
    assert_true(WH_TEST_SHARE > 1 || run_with(1, false) == by_call);
    script = SCRIPT;
}

/* Also while a latch is on its way: motion control centres by the same crossings. */
static void a_pass_through_beams_goes_on_in_another_server(void **state) {
    (void)state;
    script = BEAMS;
    latched_size = 0;
    const uint64_t by_call = run_with(0, true);
    assert_true(run_with(0, false) == by_call);
    assert_true(latched_size > 0);
    assert_true(run_with(7, false) == by_call);
    assert_true(restarts > 500);
    assert_true(WH_TEST_SHARE > 1 || run_with(1, false) == by_call);
    script = SCRIPT;
}

/* ---------------------------------------------------------------------------------------------- what is refused */

static void other_sample(waferhand_state *message) {
    message->samples[0] += 1;
}

static void more_taken(waferhand_state *message) {
    message->scan_taken += 1;
}

static void no_gripper(waferhand_state *message) {
    message->scan_gripper = 2;
}

static void no_turn(waferhand_state *message) {
    message->scan_turn = (double)NAN;
}

static void other_turn(waferhand_state *message) {
    message->scan_turn += 1e-9;
}

static void no_scan(waferhand_state *message) {
    message->scan_number = 0;
}

static void no_other_scan_is_taken_over(void **state) {
    static void (*const changes[])(waferhand_state * message) = {other_sample, more_taken, no_gripper,
                                                                 no_turn,      other_turn, no_scan};
    static wh_protocol_server_t fresh;
    wh_script_run_options_t options = {.script = EDGE, .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
    restart_every = 0;
    sampled_size = 0;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    assert_int_equal(wh_protocol_server_open(&fresh, server->layout), WH_OK);
    for (size_t i = 0; i <= sizeof changes / sizeof changes[0]; ++i) {
        const bool changed = i < sizeof changes / sizeof changes[0];
        waferhand_state message;
        assert_true(wh_link_decode_state(sampled, sampled_size, &message));
        if (changed) {
            changes[i](&message);
        }
        assert_int_equal(wh_protocol_server_restore(&fresh, &message),
                         changed ? WH_SERVER_IGNORED : WH_SERVER_RESTORED);
        (void)waferhand_state_decode_cleanup(&message);
    }
    /* A count that is larger than the number of samples that follow. */
    for (size_t cut = 1; cut < sampled_size; cut += 7) {
        waferhand_state message;
        assert_false(wh_link_decode_state(sampled, sampled_size - cut, &message));
    }
    wh_script_run_close(&run);
}

static void other_latch(waferhand_state *message) {
    message->latching.waiting[0].part += 1e-9;
}

static void latch_of_no_beam(waferhand_state *message) {
    message->latching.waiting[0].beam = 7;
}

static void no_edge(waferhand_state *message) {
    message->latching.waiting[0].edge = 2;
}

static void no_part(waferhand_state *message) {
    message->latching.waiting[0].part = (double)NAN;
}

static void latch_of_the_past(waferhand_state *message) {
    message->latching.waiting[0].slice = 1;
}

static void never_armed(waferhand_state *message) {
    message->latching.number = 0;
}

static void no_beams(waferhand_state *message) {
    message->latching.beams = 0;
}

static void other_broken(waferhand_state *message) {
    message->latching.broken ^= 1;
}

static void no_other_latches_are_taken_over(void **state) {
    static void (*const changes[])(waferhand_state * message) = {other_latch, latch_of_no_beam,  no_edge,
                                                                 no_part,     latch_of_the_past, never_armed,
                                                                 no_beams,    other_broken};
    static wh_protocol_server_t fresh;
    wh_script_run_options_t options = {.script = BEAMS, .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
    restart_every = 0;
    latched_size = 0;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    assert_int_equal(wh_protocol_server_open(&fresh, server->layout), WH_OK);
    for (size_t i = 0; i <= sizeof changes / sizeof changes[0]; ++i) {
        const bool changed = i < sizeof changes / sizeof changes[0];
        waferhand_state message;
        assert_true(wh_link_decode_state(latched, latched_size, &message));
        if (changed) {
            changes[i](&message);
        }
        assert_int_equal(wh_protocol_server_restore(&fresh, &message),
                         changed ? WH_SERVER_IGNORED : WH_SERVER_RESTORED);
        (void)waferhand_state_decode_cleanup(&message);
    }
    for (size_t cut = 1; cut < latched_size; cut += 7) {
        waferhand_state message;
        assert_false(wh_link_decode_state(latched, latched_size - cut, &message));
    }
    wh_script_run_close(&run);
}

static void no_level(waferhand_state *message) {
    message->grippers[0].vacuum_level = 2;
}

static void no_number(waferhand_state *message) {
    message->grippers[0].vacuum_level = (double)NAN;
}

static void no_command(waferhand_state *message) {
    message->grippers[0].valve_command = 2;
}

static void no_fault(waferhand_state *message) {
    message->faults[0].it.kind = -1;
}

static void no_phase(waferhand_state *message) {
    message->faults[1].phase = 5;
}

static void other_level(waferhand_state *message) {
    message->grippers[0].vacuum_level += 1e-9;
}

static void other_fault(waferhand_state *message) {
    message->faults[0].it.until_seq += 1;
}

static void other_position(waferhand_state *message) {
    message->grippers[0].wafer_before[1][2] += 1e-9;
}

static void no_other_condition_is_taken_over(void **state) {
    static void (*const changes[])(waferhand_state * message) = {
        no_level, no_number, no_command, no_fault, no_phase, other_level, other_fault, other_position};
    static wh_protocol_server_t fresh;
    (void)state;
    wh_script_run_options_t options = {.script = SCRIPT};
    wh_script_run_t run;
    options.partners.connect = connect_server;
    restart_every = 0;
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
    assert_int_equal(wh_protocol_server_open(&fresh, server->layout), WH_OK);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        waferhand_state message;
        assert_true(wh_link_decode_state(server->encoded, server->encoded_size, &message));
        message.grippers[0].positions_known = 2;
        changes[i](&message);
        assert_int_equal(wh_protocol_server_restore(&fresh, &message), WH_SERVER_IGNORED);
        (void)waferhand_state_decode_cleanup(&message);
    }
    assert_int_equal(fresh.counters.restore_refused, sizeof changes / sizeof changes[0]);
    wh_script_run_close(&run);
}

/* replay builds the layout's own physics from the cell's message. */
static void the_cell_tells_it_all(void **state) {
    wh_script_run_options_t options = {.script = SCRIPT};
    wh_script_run_t run;
    static wh_link_cell_t cell;
    (void)state;
    options.partners.connect = connect_server;
    restart_every = 0;
    assert_int_not_equal(wh_script_run(&run, &options), WH_RUN_BAD_INPUT);
    const wh_layout_t *layout = server->layout;
    const wh_link_identity_t identity = {1, wh_layout_hash(layout)};
    assert_true(wh_link_cell_from_layout(layout, &identity, &cell));
    wh_layout_t *made = wh_link_layout_from_cell(&cell.message);
    assert_non_null(made);
    assert_int_equal(made->physics.fault_count, 4);
    assert_memory_equal(&made->physics.vacuum, &layout->physics.vacuum,
                        offsetof(wh_vacuum_config_t, debounce));
    assert_int_equal(made->physics.vacuum.debounce, layout->physics.vacuum.debounce);
    assert_memory_equal(&made->physics.pads, &layout->physics.pads, sizeof made->physics.pads);
    assert_true(made->physics.slice_s == layout->physics.slice_s);
    assert_int_equal(wh_protocol_server_open(&servers[0], layout), WH_OK);
    assert_int_equal(wh_protocol_server_open(&servers[1], made), WH_OK);
    assert_true(wh_protocol_server_hash(&servers[0]) == wh_protocol_server_hash(&servers[1]));
    wh_link_layout_free(made);
    cell.message.vacuum_sensor_on = 0;
    assert_null(wh_link_layout_from_cell(&cell.message));
    wh_script_run_close(&run);
}

/* Edge sensors and rims are taken over, too; a cell that no layout could have made is refused. */
static void the_cell_tells_what_sensors_see(void **state) {
    static wh_link_cell_t cell;
    static uint8_t bytes[WH_LINK_DATAGRAM];
    wh_script_run_options_t options = {.script = EDGE, .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
    restart_every = 0;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    wh_layout_t layout = *server->layout;
    layout.scanners[0].sensor.hidden_count = 1;
    layout.scanners[0].sensor.hidden[0] = (wh_arc_t){1, 0.5};
    const wh_link_identity_t identity = {1, wh_layout_hash(&layout)};
    assert_true(wh_link_cell_from_layout(&layout, &identity, &cell));
    assert_int_equal(cell.message.rim_count, 2);
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &cell.message);
    waferhand_cell message;
    assert_true(size > 0);
    for (size_t cut = 1; cut < (size_t)size; cut += 7) {
        assert_false(wh_link_decode_cell(bytes, (size_t)size - cut, &message));
    }
    assert_true(wh_link_decode_cell(bytes, (size_t)size, &message));
    wh_layout_t *made = wh_link_layout_from_cell(&message);
    assert_non_null(made);
    const wh_scanning_t before = wh_layout_scanning(&layout);
    const wh_scanning_t after = wh_layout_scanning(made);
    assert_true(wh_scanning_hash(&before, 1, 0) == wh_scanning_hash(&after, 1, 0));
    wh_link_layout_free(made);
    message.rims[1].wafer = 1;
    assert_null(wh_link_layout_from_cell(&message));
    message.rims[1].wafer = 0;
    message.rims[1].chip_depth[0] = 40;
    assert_null(wh_link_layout_from_cell(&message));
    message.rims[1].chip_depth[0] = 0.1;
    message.sensors[0].gripper = 0; /* no chuck */
    assert_null(wh_link_layout_from_cell(&message));
    message.sensors[0].gripper = 1;
    message.sensors[0].samples = 10;
    assert_null(wh_link_layout_from_cell(&message));
    (void)waferhand_cell_decode_cleanup(&message);
    wh_script_run_close(&run);
}

/* Beams and the blades that break them are taken over, too. */
static void the_cell_tells_what_beams_see(void **state) {
    static wh_link_cell_t cell;
    static uint8_t bytes[WH_LINK_DATAGRAM];
    wh_script_run_options_t options = {.script = BEAMS, .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
    restart_every = 0;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    const wh_layout_t *layout = server->layout;
    const wh_link_identity_t identity = {1, wh_layout_hash(layout)};
    assert_true(wh_link_cell_from_layout(layout, &identity, &cell));
    assert_int_equal(cell.message.beam_count, 4);
    assert_int_equal(cell.message.outline_count, 1);
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &cell.message);
    waferhand_cell message;
    for (size_t cut = 1; cut < (size_t)size; cut += 7) {
        assert_false(wh_link_decode_cell(bytes, (size_t)size - cut, &message));
    }
    assert_true(wh_link_decode_cell(bytes, (size_t)size, &message));
    wh_layout_t *made = wh_link_layout_from_cell(&message);
    assert_non_null(made);
    const wh_latching_t before = wh_layout_latching(layout);
    const wh_latching_t after = wh_layout_latching(made);
    assert_true(wh_latching_hash(&before, 1, 3, 0) == wh_latching_hash(&after, 1, 3, 0));
    wh_link_layout_free(made);
    message.beams[0].station = 7;
    assert_null(wh_link_layout_from_cell(&message));
    message.beams[0].station = cell.message.beams[0].station;
    message.beams[1].direction[2] = 0.5;
    assert_null(wh_link_layout_from_cell(&message));
    message.beams[1].direction[2] = 1;
    message.outlines[0].count = 2;
    assert_null(wh_link_layout_from_cell(&message));
    message.outlines[0].count = cell.message.outlines[0].count;
    message.outline_count = 0;
    assert_null(wh_link_layout_from_cell(&message));
    message.outline_count = 1;
    (void)waferhand_cell_decode_cleanup(&message);
    wh_script_run_close(&run);
}

/* The faces that a probe touches are taken over, too. */
static void the_cell_tells_what_a_probe_touches(void **state) {
    static wh_link_cell_t cell;
    static uint8_t bytes[WH_LINK_DATAGRAM];
    wh_script_run_options_t options = {.script = "lua/examples/30_touch.lua",
                                       .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
    restart_every = 0;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    const wh_layout_t *layout = server->layout;
    const wh_link_identity_t identity = {1, wh_layout_hash(layout)};
    assert_true(wh_link_cell_from_layout(layout, &identity, &cell));
    assert_int_equal(cell.message.beam_count, WH_BLOCK_FACES);
    const int size = waferhand_cell_encode(bytes, 0, (int)sizeof bytes, &cell.message);
    waferhand_cell message;
    assert_true(wh_link_decode_cell(bytes, (size_t)size, &message));
    wh_layout_t *made = wh_link_layout_from_cell(&message);
    assert_non_null(made);
    const wh_latching_t before = wh_layout_latching(layout);
    const wh_latching_t after = wh_layout_latching(made);
    assert_true(wh_latching_hash(&before, 1, 1, 0) == wh_latching_hash(&after, 1, 1, 0));
    wh_link_layout_free(made);
    message.beams[1].gripper = 1;
    assert_null(wh_link_layout_from_cell(&message));
    message.beams[1].gripper = WH_NONE; /* a beam behind a face */
    assert_null(wh_link_layout_from_cell(&message));
    message.beams[1].gripper = 0;
    message.beams[2].reach[1] = 0;
    assert_null(wh_link_layout_from_cell(&message));
    (void)waferhand_cell_decode_cleanup(&message);
    wh_script_run_close(&run);
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
        cmocka_unit_test(restarted_again_and_again),
        cmocka_unit_test(no_other_condition_is_taken_over),
        cmocka_unit_test(the_cell_tells_it_all),
        cmocka_unit_test(a_scan_goes_on_in_another_server),
        cmocka_unit_test(no_other_scan_is_taken_over),
        cmocka_unit_test(the_cell_tells_what_sensors_see),
        cmocka_unit_test(a_pass_through_beams_goes_on_in_another_server),
        cmocka_unit_test(no_other_latches_are_taken_over),
        cmocka_unit_test(the_cell_tells_what_beams_see),
        cmocka_unit_test(the_cell_tells_what_a_probe_touches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
