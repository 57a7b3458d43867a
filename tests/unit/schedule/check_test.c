/* Schedules against the rules: cleans, exchanges, locks and routes of a small tool, and what flows write. */
#include "schedule/check.h"

#include "schedule/play.h"
#include "schedule/write.h"
#include "support/flow.h"

/* A schedule from rows such as "R pick W1 A 1 0 2". */
typedef struct {
    wh_schedule_t schedule;
    wh_schedule_report_t report;
} case_t;

static void open_case(case_t *of) {
    memset(of, 0, sizeof *of);
    of->schedule.path = wh_text_copy("case");
    of->schedule.ends_whole = true;
}

static void close_case(case_t *of) {
    wh_schedule_report_close(&of->report);
    wh_schedule_close(&of->schedule);
}

static int32_t number_of(wh_schedule_names_t *names, const char *text) {
    return text && text[0] != '-' ? wh_schedule_name(names, text) : WH_FLOW_NONE;
}

static wh_schedule_row_t *add(case_t *of, const char *robot, wh_schedule_action_t action, const char *wafer,
                              const char *station, double begin_s, double end_s) {
    wh_schedule_t *schedule = &of->schedule;
    schedule->rows =
        wh_array_grow(schedule->rows, schedule->count, &schedule->capacity, sizeof *schedule->rows);
    wh_schedule_row_t *row = &schedule->rows[schedule->count++];
    *row = (wh_schedule_row_t){.begin_us = (int64_t)(begin_s * FLOW_S + 0.5),
                               .end_us = (int64_t)(end_s * FLOW_S + 0.5),
                               .line = schedule->count,
                               .action = action,
                               .robot = number_of(&schedule->robots, robot),
                               .wafer = number_of(&schedule->wafers, wafer),
                               .wafer2 = WH_FLOW_NONE,
                               .station = number_of(&schedule->stations, station),
                               .to = WH_FLOW_NONE,
                               .slot = 1,
                               .side = WH_FLOW_BOTH};
    return row;
}

/* Holds it against the rules; returns those that found something, by their bits. */
static unsigned judge(case_t *of, const wh_flow_tool_t *tool) {
    const wh_schedule_given_t given = {.tool = tool};
    unsigned rules = 0;
    wh_schedule_finish(&of->schedule);
    assert_true(wh_schedule_check(&of->report, &of->schedule, &given));
    for (size_t i = 0; i < of->report.count; ++i) {
        rules |= 1U << of->report.findings[i].rule;
    }
    return rules;
}

static void carry(case_t *of, const char *wafer, const char *from, const char *to, double pick_s,
                  double place_s) {
    (void)add(of, "R", WH_SCHEDULE_PICK, wafer, from, pick_s, pick_s + 1);
    (void)add(of, "R", WH_SCHEDULE_PLACE, wafer, to, place_s, place_s + 1);
}

static void open_tool(flow_case_t *flow) {
    flow_open(flow, "R*2", "A B M");
    flow_robot(flow, "R", "A B M", 1, 1, 1, 0);
}

/* With the wafer inside, a clean is due behind its process, and comes before it leaves. */
static void a_clean_around_the_wafer(void **unused) {
    (void)unused;
    const double picks_s[] = {13.5, 19};
    for (int told = 0; told < 2; ++told) {
        for (int i = 0; i < 2; ++i) {
            flow_case_t flow;
            case_t of;
            open_tool(&flow);
            wh_flow_station_t *station = &flow.tool.stations[wh_flow_station_named(&flow.tool, "M")];
            station->process_us = 10 * FLOW_S;
            station->clean_after = 1;
            station->clean_us = 5 * FLOW_S;
            station->cleans_full = true;
            open_case(&of);
            carry(&of, "W", "A", "M", 0, 2);
            if (told) {
                (void)add(&of, "-", WH_SCHEDULE_CLEAN, "-", "M", 13, 18);
            }
            carry(&of, "W", "M", "B", picks_s[i], picks_s[i] + 2);
            const unsigned wanted = i == 1 ? 0
                                    : told ? 1U << WH_SCHEDULE_RULE_CLEAN
                                           : 1U << WH_SCHEDULE_RULE_PROCESS;
            assert_int_equal(judge(&of, &flow.tool), wanted);
            close_case(&of);
            flow_close(&flow);
        }
    }
}

/* Without a wafer for 20 s, M is cleaned before the next one. A schedule of no clean is judged by time alone, which is
 * said; in one of any clean each that is due needs its row. */
static void a_clean_for_want_of_wafers(void **unused) {
    (void)unused;
    const double places_s[] = {19, 25, 31};
    for (int i = 0; i < 3; ++i) {
        flow_case_t flow;
        case_t of;
        open_tool(&flow);
        wh_flow_station_t *station = &flow.tool.stations[wh_flow_station_named(&flow.tool, "M")];
        station->clean_us = 10 * FLOW_S;
        station->idle_us = 20 * FLOW_S;
        open_case(&of);
        carry(&of, "W", "A", "M", 0, places_s[i]);
        assert_int_equal(judge(&of, &flow.tool), i == 1 ? 1U << WH_SCHEDULE_RULE_CLEAN : 0);
        assert_non_null(strstr(of.report.rules[WH_SCHEDULE_RULE_CLEAN].but, "by time alone"));
        close_case(&of);
        open_case(&of);
        carry(&of, "W", "A", "M", 0, places_s[i]);
        (void)add(&of, "-", WH_SCHEDULE_CLEAN, "-", "B", 1, 2);
        assert_int_equal(judge(&of, &flow.tool), i > 0 ? 1U << WH_SCHEDULE_RULE_CLEAN : 0);
        close_case(&of);
        flow_close(&flow);
    }
}

/* A process that the route says goes before the station's. */
static void a_process_of_the_route(void **unused) {
    (void)unused;
    flow_case_t flow;
    case_t of;
    open_tool(&flow);
    flow.tool.stations[wh_flow_station_named(&flow.tool, "M")].process_us = 100 * FLOW_S;
    flow_lot(&flow, "A>M:10>B", 1, 1, 0);
    flow.tool.routes = flow.plan.routes;
    flow.tool.route_count = flow.plan.route_count;
    open_case(&of);
    carry(&of, "W", "A", "M", 0, 2);
    carry(&of, "W", "M", "B", 13, 15);
    assert_int_equal(judge(&of, &flow.tool), 0);
    assert_true(wh_schedule_is_looked(&of.report));
    close_case(&of);
    flow.tool.routes = NULL;
    flow.tool.route_count = 0;
    open_case(&of);
    carry(&of, "W", "A", "M", 0, 2);
    carry(&of, "W", "M", "B", 13, 15);
    assert_int_equal(judge(&of, &flow.tool), 1U << WH_SCHEDULE_RULE_PROCESS);
    assert_string_equal(wh_schedule_first(&of.report)->text,
                        "begin_s: 13 (expected 103 or later, when the process of W is over)");
    close_case(&of);
    flow_close(&flow);
}

/* Two processes of one stay add up; one elsewhere is a wafer in two places. */
static void processes_of_their_own(void **unused) {
    (void)unused;
    flow_case_t flow;
    case_t of;
    open_tool(&flow);
    flow.tool.stations[wh_flow_station_named(&flow.tool, "M")].process_us = 10 * FLOW_S;
    open_case(&of);
    carry(&of, "W", "A", "M", 0, 2);
    (void)add(&of, "-", WH_SCHEDULE_PROCESS, "W", "M", 3, 7);
    (void)add(&of, "-", WH_SCHEDULE_PROCESS, "W", "M", 8, 14);
    carry(&of, "W", "M", "B", 14, 16);
    assert_int_equal(judge(&of, &flow.tool), 0);
    close_case(&of);
    open_case(&of);
    carry(&of, "W", "A", "M", 0, 2);
    (void)add(&of, "-", WH_SCHEDULE_PROCESS, "W", "B", 3, 13);
    assert_int_equal(judge(&of, &flow.tool),
                     1U << WH_SCHEDULE_RULE_TWO_PLACES | 1U << WH_SCHEDULE_RULE_LEFT); /* it stays in M */
    close_case(&of);
    flow_close(&flow);
}

/* A flow of exchanges is written with swaps, is accepted, and takes as long when a pick and a place stand for
 * each swap. */
static void what_a_flow_writes(void **unused) {
    (void)unused;
    flow_case_t flow;
    wh_flow_figures_t figures;
    char *text = NULL;
    size_t size = 0;
    flow_open(&flow, "R*2", "H*4 M E*4");
    flow_robot(&flow, "R", "H M E", 1, 1, 1, 3);
    flow_lot(&flow, "H>M:20>E", 4, 1, 0);
    flow.plan.rule = WH_FLOW_SWAPPING;
    flow_finish(&flow);
    wh_flow_measure(&flow.tool, &flow.plan, WH_FLOW_VISITS, &figures);
    assert_int_equal(figures.ways.count, 0);
    wh_flow_figures_close(&figures);
    wh_flow_measure(&flow.tool, &flow.plan, WH_FLOW_WAYS, &figures);
    assert_true(figures.ways.count > 0);
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(wh_schedule_write(&figures, out));
    assert_int_equal(fclose(out), 0);
    assert_non_null(strstr(text, "robot,action,wafer,station,slot,begin_s,end_s,arm,wafer2,to,value\n"));
    assert_non_null(strstr(text, "\nR,swap,W2,M,1,"));
    free(text);
    wh_flow_figures_close(&figures);
    flow_close(&flow);
}

/* A schedule with waits is played without them. */
static void play_without_waits(void **unused) {
    (void)unused;
    flow_case_t flow;
    case_t of;
    wh_schedule_play_t play = {.is_played = false};
    open_tool(&flow);
    open_case(&of);
    carry(&of, "W", "A", "M", 5, 8);
    carry(&of, "W", "M", "B", 20, 22);
    assert_int_equal(judge(&of, &flow.tool), 0);
    assert_true(wh_schedule_play(&play, &of.schedule, &flow.tool));
    assert_int_equal(play.makespan_us, 23 * FLOW_S);
    assert_int_equal(play.figures.result.makespan_us, 6 * FLOW_S);
    assert_int_equal(play.actions, 4);
    assert_int_equal(play.differing, 4);
    assert_int_equal(play.first_row, 0);
    assert_int_equal(play.first_us, 0);
    wh_schedule_play_close(&play, &flow.tool);
    close_case(&of);
    flow_close(&flow);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clean_around_the_wafer), cmocka_unit_test(a_clean_for_want_of_wafers),
        cmocka_unit_test(a_process_of_the_route),   cmocka_unit_test(processes_of_their_own),
        cmocka_unit_test(what_a_flow_writes),       cmocka_unit_test(play_without_waits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
