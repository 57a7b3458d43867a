/* The search for the best schedule, in random small tools: the engine plays what it finds to the same end; no rule, with exchanges
 * or without, and no schedule at random is below its bound; where it says that its schedule is optimal, none is better than that. */
#include "flow/best.h"

#include <stdlib.h>

#include "flow/flow.h"
#include "flow/transfer.h"
#include "support/flow.h"

static const char *const routes[] = {"L>A>B>U",   "L>A|B>C>U",   "L>A>B>C>U",  "L>A>B>A>U",
                                     "L>A>C|D>U", "L>A>B>C>D>U", "L>A>B>A>C>U"};

static void open_case(flow_case_t *flow) {
    const bool two = wh_test_below(2) == 1;
    flow_open(flow,
              two                ? wh_test_below(2) ? "R S*2" : "R S"
              : wh_test_below(2) ? "R*2"
                                 : "R",
              "L*5 U*5 A B C D");
    const double handle = 1 + (double)wh_test_below(4), move = (double)wh_test_below(4);
    const double swap = wh_test_below(3) == 0 ? 1 + (double)wh_test_below(4) : 0; /* 0: the usual one */
    flow_robot(flow, "R", two ? "L A B" : "L U A B C D", handle, 1 + (double)wh_test_below(3), move, swap);
    if (two) {
        flow_robot(flow, "S", "A B C D U", 1 + (double)wh_test_below(12), 2, 1, swap);
    }
    for (int32_t s = 2; s < 6; ++s) {
        flow->tool.stations[s].process_us = wh_test_below(4) == 0 ? 0 : (int64_t)wh_test_below(30) * FLOW_S;
        flow->tool.stations[s].slots = 1;
    }
    flow_lot(flow, routes[wh_test_below(two ? 3 : 7)], 2 + (int)wh_test_below(3), 1, 0);
}

/* A carry at random of those that the robot could ever do now; none now and then. */
static int choose(void *context, const wh_flow_state_t *state, int32_t robot, wh_flow_line_t lines[],
                  char **why) {
    int count = 0;
    (void)context;
    (void)why;
    for (int32_t w = 0; w < (int32_t)state->plan->wafer_count && count < WH_FLOW_ANSWERS; ++w) {
        if (wh_flow_may_take(state, robot, w)) {
            const wh_flow_step_t *next = wh_flow_step_of(state->plan, w, state->wafers[w].step + 1);
            const int32_t to = next->stations[wh_test_below((unsigned)next->station_count)];
            wh_flow_line_t line = WH_FLOW_NO_LINE;
            line.from = wh_flow_station_of(state, w);
            line.to = to;
            line.wafer = w;
            if (state->tool->serves[wh_flow_of(state->tool, robot, to)]) {
                const int at = (int)wh_test_below((unsigned)count + 1);
                lines[count++] = lines[at];
                lines[at] = line;
            }
        }
    }
    return count > 1 && wh_test_below(3) == 0 ? 1 : count;
}

/* WH_FLOW_NEVER: it is stuck. */
static int64_t play(flow_case_t *flow, wh_flow_rule_t rule, wh_flow_list_t *lists) {
    wh_flow_plan_t plan = flow->plan;
    wh_flow_result_t result;
    plan.rule = rule;
    plan.lists = lists;
    plan.own = choose;
    wh_flow_play(&flow->tool, &plan, NULL, &result);
    const int64_t us = result.end == WH_FLOW_DONE ? result.makespan_us : WH_FLOW_NEVER;
    wh_flow_result_close(&result);
    return us;
}

typedef struct {
    int optimal, found, played;
} sums_t;

static void compare(flow_case_t *flow, size_t width, sums_t *sums) {
    static const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_SWAPPING, WH_FLOW_FIRST_COME,
                                           WH_FLOW_LONGEST_WAIT};
    wh_flow_best_t best;
    wh_flow_best(&flow->tool, &flow->plan, width, NULL, NULL, &best);
    const bool is_optimal = best.lists && best.makespan_us == best.bound_us;
    assert_true(best.bound_us <= best.makespan_us);
    sums->optimal += is_optimal;
    sums->found += best.lists != NULL;
    if (best.lists) {
        assert_int_equal(play(flow, WH_FLOW_LISTS, best.lists), best.makespan_us);
    }
    for (size_t i = 0; i < sizeof rules / sizeof *rules + 60; ++i) {
        const int64_t us = play(flow, i < sizeof rules / sizeof *rules ? rules[i] : WH_FLOW_OWN, NULL);
        assert_true(us >= best.bound_us);
        sums->played += us != WH_FLOW_NEVER;
    }
    wh_flow_best_close(&best, &flow->tool);
}

static void try_case(bool is_narrow, sums_t *sums) {
    flow_case_t flow;
    open_case(&flow);
    char *problem = wh_flow_plan_finish(&flow.plan, &flow.tool);
    char *why = problem ? NULL : wh_flow_best_refuses(&flow.tool, &flow.plan);
    if (!problem && !why) {
        compare(&flow, is_narrow ? 1 + wh_test_below(5) : 2000, sums);
    }
    free(problem);
    free(why);
    flow_close(&flow);
}

static void no_schedule_is_better(void **unused) {
    (void)unused;
    sums_t sums = {0, 0, 0};
    wh_rounds_t rounds = WH_ROUNDS(60, 3000, 0.5);
    while (wh_round(&rounds)) {
        try_case(false, &sums);
    }
    printf("%d rounds: %d schedules found, %d of them optimal; %d others\n", rounds.made, sums.found,
           sums.optimal, sums.played);
    assert_true(sums.found > rounds.made / 3 && sums.optimal > sums.found / 2 &&
                sums.played > 20 * sums.found);
}

/* With few nodes it may find a worse one, or none; its bound is one all the same. */
static void a_narrow_search_has_a_bound(void **unused) {
    (void)unused;
    sums_t sums = {0, 0, 0};
    wh_rounds_t rounds = WH_ROUNDS(60, 3000, 0.3);
    while (wh_round(&rounds)) {
        try_case(true, &sums);
    }
    assert_true(sums.found > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_schedule_is_better),
                                       cmocka_unit_test(a_narrow_search_has_a_bound)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
