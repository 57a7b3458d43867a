/* A step of the simulator allocates nothing: from the command's bytes to the bytes of the state and of the proximity values.
 * malloc and its kin are replaced by ones that count. What liblcm takes to receive a datagram is its own and not in this. */
#include "support.h"
#include "support_heap.h"

#include "link/check.h"
#include "link/proximity_message.h"
#include "link/server.h"
#include "script/run.h"

static wh_server_t server;
static wh_state_t answer;
static unsigned long calls_in_steps;

static unsigned long heap_calls(void) {
#if defined(WH_TEST_COUNTS_HEAP)
    return calls;
#else
    return 0;
#endif
}

static void step(const uint8_t *bytes, size_t size) {
    static uint8_t encoded[1024];
    waferhand_command command;
    waferhand_proximity proximity;
    const unsigned long before = heap_calls();
    assert_true(wh_link_decode_command(bytes, size, &command));
    assert_int_not_equal(wh_server_command(&server, &command, NULL), WH_SERVER_IGNORED);
    wh_link_proximity_to_message(&server.state, &server.identity, &server.layout->grasp.tolerance,
                                 &proximity);
    assert_true(waferhand_proximity_encode(encoded, 0, (int)sizeof encoded, &proximity) > 0);
    calls_in_steps += heap_calls() - before;
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    static const int64_t run = 4711;
    const wh_link_identity_t identity = {run, server.identity.layout_hash};
    waferhand_command message;
    uint8_t bytes[4096];
    (void)link;
    wh_link_command_to_message(command, &identity, true, &message);
    const int size = waferhand_command_encode(bytes, 0, (int)sizeof bytes, &message);
    wh_link_seal(bytes, (size_t)size);
    step(bytes, (size_t)size);
    answer = server.state;
    *state = answer;
    return state->status;
}

static uint64_t hash(wh_link_t *link) {
    (void)link;
    return wh_server_hash(&server);
}

static int64_t missed(wh_link_t *link) {
    (void)link;
    return 0;
}

static wh_link_t *connect_server(void *user, wh_mcs_t *mcs) {
    static wh_link_t link = {exchange, hash, missed};
    (void)user;
    assert_int_equal(wh_server_open(&server, mcs->layout), WH_OK);
    return &link;
}

static void test_a_step_allocates_nothing(void **state) {
    const wh_run_options_t options = {.script = "lua/examples/02_prealigner.lua",
                                      .partners = {.connect = connect_server}};
    wh_run_t run;
    (void)state;
#if !defined(WH_TEST_COUNTS_HEAP)
    skip();
#endif
    assert_int_equal(wh_run_script(&run, &options), WH_RUN_MET);
    assert_true(server.counters.stepped > 10000);
    assert_true(heap_calls() > 0);
    assert_int_equal(calls_in_steps, 0);
    wh_run_close(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(test_a_step_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
