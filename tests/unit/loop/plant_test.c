/* A cell driven from outside: what is taken, refused and told, and that the cell is the one that motion control
 * would have: the same slices give the same hash. */
#include "support/support.h"

#include "loop/plant.h"
#include "mcs/script_run.h"
#include "reading/layout_read.h"

static wh_sandbox_t *sandbox;
static const wh_layout_t *cell;
static wh_node_t node;
static wh_sim_process_t simulation, other;
static wh_plant_t plant;
static char text[WH_PLANT_TEXT];
static int heard, complaints;

static void hear(void *user, int64_t utime, const char *said, bool is_complaint) {
    (void)user;
    assert_true(utime == 1000 * wh_plant_slice(&plant) && said[0] != '\0');
    ++heard;
    complaints += is_complaint ? 1 : 0;
}

static int set_up(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(NULL);
    cell = wh_layout_load(sandbox, "tests/firmware/cell.lua", &result);
    if (!cell || !wh_node_open(&node, "memq://", NULL) ||
        wh_sim_process_open(&simulation, &node, cell, false) != WH_OK) {
        return -1;
    }
    wh_plant_open(&plant, &simulation);
    plant.heard = hear;
    heard = complaints = 0;
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    wh_sim_process_close(&simulation);
    wh_node_close(&node);
    wh_sandbox_free(sandbox);
    return 0;
}

static wh_status_t drive(double theta, double r, double z, uint32_t valves) {
    const double axes[4] = {theta, r, z, 0};
    return wh_plant_drive(&plant, axes, valves, text);
}

static void before_the_first_numbers_it_is_at_home(void **state) {
    (void)state;
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_true(simulation.server.axes[1] == 300 && simulation.server.axes[2] == 850);
    assert_int_equal(wh_plant_slice(&plant), 1);
}

static void numbers_that_no_axis_can_have_are_refused_by_name(void **state) {
    (void)state;
    assert_int_equal(drive(0, 400, 880, 0), WH_OK);
    assert_string_equal(text, "");
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_int_equal(drive(0, 751, 880, 1), WH_STATUS_OUT_OF_REACH);
    assert_non_null(strstr(text, "axis 2, R: 751 mm: "));
    assert_int_equal(drive(0, 400, (double)NAN, 1), WH_STATUS_NOT_FINITE);
    assert_non_null(strstr(text, "axis 3, Z: nan mm: "));
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_true(simulation.server.axes[1] == 400 && simulation.server.axes[2] == 880);
    assert_true(plant.found.refused == 2 && plant.found.jumps == 0);
}

/* The first numbers say where the axes are; from then on each goes at most as far as its speed lets it, in all
 * the slices since. */
static void a_jump_is_told_and_taken(void **state) {
    (void)state;
    assert_int_equal(drive(90, 700, 900, 0), WH_OK);
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_int_equal(drive(90, 699, 900.3, 0), WH_OK);
    assert_string_equal(text, "");
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_int_equal(drive(90.2, 699, 900.3, 0), WH_OK);
    assert_string_equal(text, "axis 1, theta, jumps by 0.2 degrees (expected at most 0.181)");
    assert_int_equal(wh_plant_step(&plant), WH_OK);
    assert_int_equal(wh_plant_step(&plant), WH_OK); /* held */
    assert_int_equal(drive(90.5, 699, 900.3, 0), WH_OK);
    assert_string_equal(text, "");
    assert_true(plant.found.jumps == 1);
}

/* Up through slot 1 with the vacuum on, then off over nothing. */
static void carry(void) {
    for (int slice = 0; slice < 800; ++slice) {
        assert_int_equal(drive(0, 700, 895 + 0.02 * slice, slice < 700 ? 1 : 0), WH_OK);
        assert_int_equal(wh_plant_step(&plant), WH_OK);
    }
}

static void events_are_told_in_words(void **state) {
    (void)state;
    carry();
    assert_true(plant.found.events[WH_EVENT_PICKED] == 1 && plant.found.events[WH_EVENT_RELEASED] == 1);
    assert_true(heard > 2 && complaints > 0 && plant.found.complaints == (uint64_t)complaints);
}

/* Anybody else may give these slices as commands. */
static void the_cell_is_the_one_of_commands(void **state) {
    (void)state;
    const wh_link_identity_t identity = {4711, simulation.server.identity.layout_hash};
    wh_command_t command = {.gripper_count = 1, .axis_count = 4};
    carry();
    assert_int_equal(wh_sim_process_open(&other, &node, cell, false), WH_OK);
    for (int slice = 0; slice < 800; ++slice) {
        waferhand_command message;
        wh_state_t answer;
        command.seq = slice + 1;
        command.utime = 1000 * command.seq;
        command.axes[1] = 700;
        command.axes[2] = 895 + 0.02 * slice;
        wh_machine_grippers(&cell->machine, command.axes, &command.grippers[0].base_from_gripper);
        command.grippers[0].valve = slice < 700 ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
        wh_link_command_to_message(&command, &identity, true, &message);
        assert_int_equal(wh_sim_process_step(&other, &message, &answer), WH_OK);
    }
    assert_true(wh_protocol_server_hash(&other.server) == wh_protocol_server_hash(&simulation.server));
    wh_sim_process_close(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(before_the_first_numbers_it_is_at_home, set_up, tear_down),
        cmocka_unit_test_setup_teardown(numbers_that_no_axis_can_have_are_refused_by_name, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_jump_is_told_and_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(events_are_told_in_words, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_cell_is_the_one_of_commands, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
