/* The view's part of a step allocates nothing, even if everything is sent after each step: the
 * bodies, and their places. The places are the simulator's, slice by slice, and its bits are the
 * same as without a view. */
#include "support/heap.h"
#include "support/server.h"

#include "mcs/script_run.h"
#include "view/view.h"

static wh_protocol_server_t servers[1];
static wh_viewer_t view;
static unsigned long calls_in_views;

static void look(void) {
    view.last_draw_us -= WH_VIEW_DRAW_US;
    view.last_load_us -= server->seq % 100 == 0 ? WH_VIEW_LOAD_US : 0;
    const unsigned long before = heap_calls();
    wh_viewer_tick(&view, server);
    calls_in_views += heap_calls() - before;
}

static void compare(size_t body, const wh_pose_t *pose) {
    const double mm[] = {pose->r.x, pose->r.y, pose->r.z};
    for (size_t i = 0; i < 3; ++i) {
        assert_near(view.cell.bodies.draw.position[body][i], mm[i] / 1000, 2e-7);
    }
}

static void compare_all(void) {
    for (size_t w = 0; w < server->state.wafer_count; ++w) {
        compare(view.cell.wafers + w, &server->state.wafers[w].base_from_wafer);
    }
    for (size_t g = 0; g < server->state.gripper_count; ++g) {
        const int32_t wafer = server->state.grippers[g].wafer;
        compare(view.cell.grippers + g, &server->state.grippers[g].base_from_gripper);
        if (wafer != WH_NONE) {
            compare(view.cell.covers + g, &server->state.wafers[wafer].base_from_wafer);
        }
    }
}

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    const waferhand_command message = message_of(command);
    (void)link;
    assert_int_not_equal(wh_protocol_server_command(server, &message, NULL), WH_SERVER_IGNORED);
    look();
    compare_all();
    *state = server->state;
    return state->status;
}

static wh_link_t *connect_server(void *user, wh_mcs_t *mcs) {
    static wh_link_t link = {exchange, hash_of_server, none_missed};
    (void)user;
    server = servers;
    assert_int_equal(wh_protocol_server_open(server, mcs->layout), WH_OK);
    assert_int_equal(wh_viewer_open(&view, NULL, mcs->layout), WH_OK);
    look();
    return &link;
}

static void a_view_allocates_and_changes_nothing(void **state) {
    wh_script_run_options_t options = {.script = "lua/examples/02_prealigner.lua"};
    wh_script_run_t plain, run;
    (void)state;
    assert_int_equal(wh_script_run(&plain, &options), WH_RUN_MET);
    options.partners.connect = connect_server;
    assert_int_equal(wh_script_run(&run, &options), WH_RUN_MET);
    assert_true(view.draws == server->counters.stepped + 1 && view.draws > 10000);
    assert_true(view.loads > 100 && view.unsent == 0);
    assert_int_equal(calls_in_views, 0);
    assert_true(wh_protocol_server_hash(server) == plain.record.hash);
    wh_viewer_close(&view);
    wh_protocol_server_close(server);
    wh_script_run_close(&run);
    wh_script_run_close(&plain);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(a_view_allocates_and_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
