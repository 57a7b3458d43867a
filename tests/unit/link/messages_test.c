/* A run over messages ends with the bits of a run by calls: client and simulation in one process, on memq. Events come
 * with the verdicts that they had. */
#include "support/support.h"

#include "link/protocol_client.h"
#include "link/sim_process.h"
#include "mcs/script_run.h"

static wh_node_t node;
static wh_protocol_client_t client;
static wh_sim_process_t simulation;

static wh_link_t *connect(void *user, wh_mcs_t *mcs) {
    const wh_protocol_client_options_t options = {.rate = 0};
    (void)user;
    assert_int_equal(wh_sim_process_open(&simulation, &node, mcs->layout, true), WH_OK);
    assert_true(wh_protocol_client_open(&client, &node, mcs->layout, &options));
    return &client.link;
}

static uint64_t play(const char *script, bool over_messages) {
    wh_script_run_options_t options = {.script = script, .limits = {.print_to = stderr}};
    wh_script_run_t run;
    if (over_messages) {
        assert_true(wh_node_open(&node, "memq://", NULL));
        options.partners.connect = connect;
    }
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    const uint64_t hash = run.record.hash;
    if (over_messages) {
        assert_true(simulation.server.counters.stepped == (uint64_t)run.record.slices);
        assert_true(simulation.counters.garbage == 0);
        assert_true(client.counters.malformed == 0);
        wh_sim_process_close(&simulation);
        wh_node_close(&node);
    }
    wh_script_run_close(&run);
    return hash;
}

static void examples_have_the_same_hash(void **state) {
    static const char *const scripts[] = {"lua/examples/01_transfer.lua", "lua/examples/02_prealigner.lua",
                                          "lua/examples/03_missed_pick.lua"};
    (void)state;
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; ++i) {
        assert_true(play(scripts[i], true) == play(scripts[i], false));
    }
}

/* A near miss at this height, judged by this limit, over a message. */
static wh_event_t send_near_miss(double height, double limit) {
    static wh_link_state_t room;
    static wh_link_arrays_t arrays;
    static wh_wafer_t wafer;
    static wh_gripper_t gripper;
    static wh_physics_state_t physics;
    const wh_link_identity_t identity = {0};
    const wh_tolerance_t paper = wh_tolerance_paper();
    wh_tolerance_t applied = paper;
    wh_event_t event = {.kind = WH_EVENT_NEAR_MISS, .other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    wh_state_t state = {.wafers = &wafer,
                        .wafer_count = 1,
                        .grippers = &gripper,
                        .gripper_count = 1,
                        .events = &event,
                        .event_count = 1,
                        .physics = &physics};
    wh_state_t got;
    applied.projz = limit;
    gripper.wafer = gripper.approach.wafer = gripper.contest.wafer = WH_NONE;
    event.measured.dr_proj_z = -height;
    event.measured.n1_proj_n2 = 1;
    wh_proximity_judge(&applied, &event.measured);
    wh_link_state_to_message(&state, &identity, 0, 0, &room);
    assert_int_equal(wh_link_state_from_message(&room.message, &paper, &arrays, &got), WH_OK);
    assert_int_equal(got.event_count, 1);
    assert_int_equal(got.events[0].measured.failed, event.measured.failed);
    assert_true(got.events[0].measured.margin_projz == event.measured.margin_projz);
    assert_true(got.events[0].limit == 0);
    return got.events[0];
}

/* Of a swept one 0.998 of the limit counts, also where the message has come. */
static void a_near_miss_keeps_its_verdict(void **state) {
    (void)state;
    const double swept = wh_tolerance_paper().projz * WH_SWEEP_INSIDE;
    assert_false(send_near_miss(0.4998, swept).measured.ready);
    assert_true(send_near_miss(0.4998, 0.5).measured.ready);
    assert_false(send_near_miss(7.3, swept).measured.ready);
    assert_false(send_near_miss(7.3, 0.5).measured.ready);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_have_the_same_hash),
        cmocka_unit_test(a_near_miss_keeps_its_verdict),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
