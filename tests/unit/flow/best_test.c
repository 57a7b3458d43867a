/* The search for the best schedule: three published flows with their optima; what it finds is what the engine plays; no rule is
 * better, and none is below the bound, which holds for exchanges too. */
#include "flow/best.h"

#include <stdlib.h>

#include "flow/flow.h"
#include "support/flow.h"

static const struct {
    const char *route;
    int64_t optimum_s;
} published[] = {
    {"LLA>PM11:60>PM12:70>BM11:0>PM21:40>PM22:50>PM23:50>PM24:60>BM12:0>PM13:50>PM14:48>LLB", 769},
    {"LLA>PM11|PM12:139>BM11:0>PM21|PM22:131>PM23|PM24:130>BM12:0>PM13|PM14:120>LLB", 833},
    {"LLA>PM11|PM12|PM13:200>BM11:0>PM21:60>PM22:50>PM23|PM24:130>PM22:50>BM12:0>PM14:110>LLB", 1095},
};

static void open_clusters(flow_case_t *flow, const char *route) {
    flow_open(flow, "R1 R2*2", "LLA*5 LLB*5 PM11 PM12 PM13 PM14 BM11 BM12 PM21 PM22 PM23 PM24");
    flow_robot(flow, "R1", "LLA LLB PM11 PM12 PM13 PM14 BM11 BM12", 1, 1, 1, 0);
    flow_robot(flow, "R2", "BM11 BM12 PM21 PM22 PM23 PM24", 1, 1, 1, 0);
    flow_lot(flow, route, 5, 1, 0);
    flow_finish(flow);
}

/* The engine's makespan of a plan with this rule, and these lists if there are any. */
static int64_t play(flow_case_t *flow, wh_flow_rule_t rule, wh_flow_list_t *lists, wh_flow_end_t *end) {
    wh_flow_plan_t plan = flow->plan;
    wh_flow_result_t result;
    plan.rule = rule;
    plan.lists = lists;
    wh_flow_play(&flow->tool, &plan, NULL, &result);
    const int64_t makespan_us = result.makespan_us;
    *end = result.end;
    wh_flow_result_close(&result);
    return makespan_us;
}

static void finds_the_published_optima_and_proves_them(void **unused) {
    (void)unused;
    for (size_t i = 0; i < sizeof published / sizeof *published; ++i) {
        flow_case_t flow;
        wh_flow_best_t best;
        wh_flow_end_t end;
        open_clusters(&flow, published[i].route);
        assert_null(wh_flow_best_refuses(&flow.tool, &flow.plan));
        wh_flow_best(&flow.tool, &flow.plan, 300, NULL, NULL, &best);
        printf("%lld s, at least %lld s, %llu nodes\n", (long long)(best.makespan_us / 1000000),
               (long long)(best.bound_us / 1000000), (unsigned long long)best.nodes);
        assert_int_equal(best.makespan_us, published[i].optimum_s * 1000000);
        assert_int_equal(best.bound_us, best.makespan_us);
        assert_int_equal(play(&flow, WH_FLOW_LISTS, best.lists, &end), best.makespan_us);
        assert_int_equal(end, WH_FLOW_DONE);
        wh_flow_best_close(&best, &flow.tool);
        flow_close(&flow);
    }
}

/* The rule exchanges wafers in less than a pick and a placing, which no list of the search can. */
static void a_bound_holds_for_exchanges_too(void **unused) {
    (void)unused;
    flow_case_t flow;
    wh_flow_best_t best;
    wh_flow_end_t end;
    flow_open(&flow, "R*2", "LP*25 PM1 PM2 OUT*25");
    flow_robot(&flow, "R", "LP PM1 PM2 OUT", 3, 4, 2, 6);
    flow_lot(&flow, "LP>PM1:50>PM2:40>OUT", 3, 1, 0);
    flow_finish(&flow);
    wh_flow_best(&flow.tool, &flow.plan, 1000, NULL, NULL, &best);
    const int64_t by_rule_us = play(&flow, WH_FLOW_SWAPPING, NULL, &end);
    assert_int_equal(by_rule_us, 231 * FLOW_S);
    assert_int_equal(best.makespan_us, 234 * FLOW_S);
    assert_true(best.lacks_swaps && best.bound_us <= by_rule_us);
    assert_int_equal(play(&flow, WH_FLOW_LISTS, best.lists, &end), best.makespan_us);
    wh_flow_best_close(&best, &flow.tool);
    flow_close(&flow);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(finds_the_published_optima_and_proves_them),
                                       cmocka_unit_test(a_bound_holds_for_exchanges_too)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
