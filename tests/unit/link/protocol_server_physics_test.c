/* The state of a simulator with delayed vacuum, pads and faults: taken over by another in the middle of a run it goes on with
 * the same bits, and none that no simulator could be in is taken over. */
#include "support/server.h"

#include "link/messages.h"
#include "mcs/script_run.h"

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

static void send(const wh_command_t *command) {
    waferhand_command decoded;
    uint8_t bytes[4096];
    const size_t size = encode_command(command, bytes, sizeof bytes);
    assert_true(wh_link_decode_command(bytes, size, &decoded));
    /* Twice, as a network does. */
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
    assert_int_equal(wh_protocol_server_restore(other, &message), WH_SERVER_RESTORED);
    assert_true(wh_protocol_server_hash(other) == wh_protocol_server_hash(server));
    assert_int_equal(other->state.sensors, server->state.sensors);
    (void)waferhand_state_decode_cleanup(&message);
    server = other;
    ++restarts;
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    (void)link;
    send(command);
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
    assert_true(run_with(1, false) == by_call);
}

/* Also in the middle of a scan; and motion control collects the same samples, as the script's expectations show. */
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
    assert_true(run_with(1, false) == by_call);
    script = SCRIPT;
}

/* Also with a latch on its way; and motion control centres by the same crossings. */
static void a_pass_through_beams_goes_on_in_another_server(void **state) {
    (void)state;
    script = BEAMS;
    latched_size = 0;
    const uint64_t by_call = run_with(0, true);
    assert_true(run_with(0, false) == by_call);
    assert_true(latched_size > 0);
    assert_true(run_with(7, false) == by_call);
    assert_true(restarts > 500);
    assert_true(run_with(1, false) == by_call);
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
    /* A count that is not followed by so many samples. */
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

/* What replay makes of the cell's message is the layout's own physics. */
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
    assert_memory_equal(&made->physics.vacuum, &layout->physics.vacuum, sizeof made->physics.vacuum);
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

/* The same with edge sensors and rims; a cell that no layout could have made is refused. */
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

/* The same with beams and the blades that break them. */
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restarted_again_and_again),
        cmocka_unit_test(no_other_condition_is_taken_over),
        cmocka_unit_test(the_cell_tells_it_all),
        cmocka_unit_test(a_scan_goes_on_in_another_server),
        cmocka_unit_test(no_other_scan_is_taken_over),
        cmocka_unit_test(the_cell_tells_what_sensors_see),
        cmocka_unit_test(a_pass_through_beams_goes_on_in_another_server),
        cmocka_unit_test(no_other_latches_are_taken_over),
        cmocka_unit_test(the_cell_tells_what_beams_see),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
