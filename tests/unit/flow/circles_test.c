/* Wafers that could block each other, and what is known of a pick that has begun. */
#include "flow/flow.h"
#include "support/flow.h"

/* The first wafer ends in the place in which the second one would wait for the first to leave. */
static void a_way_back_closes_a_circle(void **unused) {
    (void)unused;
    const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_FIRST_COME, WH_FLOW_LONGEST_WAIT};
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i) {
        flow_case_t flow;
        flow_open(&flow, "R", "H*2 X*2 M");
        flow_robot(&flow, "R", "H X M", 1, 1, 1, 0);
        flow_lot(&flow, "H>X:0>M:50", 2, 1, 0);
        const int32_t first = flow.tool.stations[wh_flow_station_named(&flow.tool, "X")].first_place;
        flow.plan.wafers[0].back = first + 1;
        flow.plan.wafers[1].back = first;
        flow.plan.rule = rules[i];
        flow_finish(&flow);
        wh_flow_result_t result;
        wh_flow_play(&flow.tool, &flow.plan, NULL, &result);
        assert_int_equal(result.end, WH_FLOW_DONE);
        wh_flow_result_close(&result);
        flow_close(&flow);
    }
}

static void look_at_picks(void *context, const wh_flow_state_t *state, int64_t to_us) {
    (void)to_us;
    for (size_t p = 0; p < state->tool->place_count; ++p) {
        const int32_t station = state->tool->place_stations[p];
        if (state->places[p].leaving_us != WH_FLOW_NEVER) {
            const size_t of = wh_flow_of(state->tool, state->stations[station].user, station);
            assert_int_equal(state->places[p].leaving_us + state->tool->doors[of].close_us,
                             state->stations[station].busy_us);
            ++*(size_t *)context;
        }
    }
}

/* By a robot that exchanges, through a door: the place will be empty when the blade is out. */
static void a_pick_ends_behind_its_door(void **unused) {
    (void)unused;
    flow_case_t flow;
    size_t seen = 0;
    flow_open(&flow, "R*2", "H*4 M E*4");
    flow_robot(&flow, "R", "H M E", 1, 1, 1, 3);
    flow.tool.doors[wh_flow_of(&flow.tool, 0, wh_flow_station_named(&flow.tool, "M"))] =
        (wh_flow_door_t){2 * FLOW_S, 1 * FLOW_S};
    flow_lot(&flow, "H>M:20>E", 4, 1, 0);
    flow.plan.rule = WH_FLOW_SWAPPING;
    flow_finish(&flow);
    const wh_flow_listener_t listener = {&seen, NULL, look_at_picks, NULL};
    wh_flow_result_t result;
    wh_flow_play(&flow.tool, &flow.plan, &listener, &result);
    assert_int_equal(result.end, WH_FLOW_DONE);
    assert_true(seen >= 8);
    wh_flow_result_close(&result);
    flow_close(&flow);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_way_back_closes_a_circle),
                                       cmocka_unit_test(a_pick_ends_behind_its_door)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
