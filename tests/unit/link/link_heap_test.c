/* A step of the simulator allocates nothing: from the command's bytes to the bytes of the state and
 * of the proximity values. An update of outputs.txt never asks for memory, whatever it finds.
 * Functions that count replace malloc and its kin. Memory that liblcm takes to receive a datagram
 * is its own and not counted. */
#include "support/heap.h"
#include "support/outputs.h"
#include "support/server.h"

#include "mcs/script_run.h"
#include "wire/messages.h"

static wh_protocol_server_t servers[1];
static unsigned long calls_in_steps;

static void step(const uint8_t *bytes, size_t size) {
    static uint8_t encoded[1024];
    waferhand_command command;
    waferhand_proximity proximity;
    const unsigned long before = heap_calls();
    assert_true(wh_link_decode_command(bytes, size, &command));
    assert_int_not_equal(wh_protocol_server_command(server, &command, NULL), WH_SERVER_IGNORED);
    wh_link_proximity_to_message(&server->state, &server->identity, server->layout, &proximity);
    assert_true(waferhand_proximity_encode(encoded, 0, (int)sizeof encoded, &proximity) > 0);
    calls_in_steps += heap_calls() - before;
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    uint8_t bytes[4096];
    (void)link;
    step(bytes, encode_command(command, bytes, sizeof bytes));
    *state = server->state;
    return state->status;
}

static wh_link_t *connect_server(void *user, wh_mcs_t *mcs) {
    static wh_link_t link = {exchange, hash_of_server, none_missed};
    (void)user;
    server = servers;
    assert_int_equal(wh_protocol_server_open(server, mcs->layout), WH_OK);
    return &link;
}

static void a_step_allocates_nothing(void **state) {
    const wh_script_run_options_t options = {.script = "lua/examples/02_prealigner.lua",
                                             .partners = {.connect = connect_server}};
    wh_script_run_t run;
    (void)state;
#if !defined(WH_TEST_COUNTS_HEAP)
    skip();
#endif
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    assert_true(server->counters.stepped > 10000);
    assert_true(heap_calls() > 0);
    assert_int_equal(calls_in_steps, 0);
    wh_script_run_close(&run);
}

#if defined(WH_TEST_COUNTS_HEAP)

/* Updates now and once the file has settled; only this is counted. */
static unsigned long calls_while_updating(outputs_fixture_t *f) {
    const unsigned long before = calls;
    (void)wh_outputs_update(&f->reader, f->now_us);
    f->now_us += WH_OUTPUTS_SETTLE_US;
    (void)wh_outputs_update(&f->reader, f->now_us);
    return calls - before;
}

static void an_update_allocates_nothing(void **state) {
    (void)state;
    static const char *const texts[] = {"0 1", "", "1", "1 1 1", "garbage", "1 0"};
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 600; ++i) {
        outputs_put(f.path, texts[i % 6]);
        assert_int_equal(calls_while_updating(&f), 0);
    }
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(symlink("outputs.txt", f.path), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(mkdir(f.path, 0777), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(f.reader.counters.reports, 503);
    outputs_teardown(&f);
}

#else

static void an_update_allocates_nothing(void **state) {
    (void)state;
    skip();
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(a_step_allocates_nothing),
        cmocka_unit_test(an_update_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
