/* A run over messages ends with the bits of a run by calls: client and simulation in one process, on memq. */
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_have_the_same_hash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
