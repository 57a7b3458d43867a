/* Two linked clusters with three published flows and their optimal sequences; a wafer that is exchanged between two
 * stations; steady cycles against published formulas. */
#include "flow/flow.h"
#include "support/flow.h"

static const char *const routes[3] = {
    "LLA>PM11:60>PM12:70>BM11:0>PM21:40>PM22:50>PM23:50>PM24:60>BM12:0>PM13:50>PM14:48>LLB",
    "LLA>PM11|PM12:139>BM11:0>PM21|PM22:131>PM23|PM24:130>BM12:0>PM13|PM14:120>LLB",
    "LLA>PM11|PM12|PM13:200>BM11:0>PM21:60>PM22:50>PM23|PM24:130>PM22:50>BM12:0>PM14:110>LLB",
};

/* The serial flow: moves of both robots, by their numbers along the route, in rounds. */
static const char serial[] = "1 0,2 0,1 0,3 0,0 4,0 5,2 0,1 0,3 0,0 4,0 6,0 5,0 7,2 0,1 0,3 0,0 4,0 6,0 5,0 "
                             "8,0 7,2 0,1 0,9 0,3 0,0 4,0 6,0 "
                             "5,0 8,0 7,2 0,10 0,9 0,3 0,0 4,0 6,0 5,0 8,0 7,0 6,11 0,10 0,9 0,0 8,0 7,11 "
                             "0,10 0,9 0,0 8,11 0,10 0,9 0,11 "
                             "0,10 0,11 0";
static const char *const serial_places[] = {"LLA",  "PM11", "PM12", "BM11", "PM21", "PM22",
                                            "PM23", "PM24", "BM12", "PM13", "PM14", "LLB"};

/* The others: from and to of both robots, by places; 100 is the arm. */
static const char parallel[] = "1 2 0 0,1 3 0 0,2 4 0 0,0 0 4 5,1 2 0 0,3 4 0 0,0 0 4 6,1 3 0 0,0 0 5 7,0 0 "
                               "6 8,2 4 0 0,0 0 4 5,1 2 0 0,3 4 0 "
                               "0,0 0 4 6,0 0 7 9,9 10 0 0,0 0 8 9,9 11 0 0,0 0 5 7,2 4 0 0,0 0 6 8,0 0 4 "
                               "5,10 12 0 0,11 12 0 0,0 0 7 9,9 10 0 "
                               "0,0 0 8 9,9 11 0 0,0 0 5 7,0 0 7 9,10 12 0 0,11 12 0 0,9 10 0 0,10 12 0 0";
static const char *const parallel_places[] = {"",     "LLA",  "PM11", "PM12", "BM11", "PM21", "PM22",
                                              "PM23", "PM24", "BM12", "PM13", "PM14", "LLB"};
static const char reentrant[] = "1 2 0 0,1 3 0 0,1 4 0 0,2 5 0 0,0 0 5 6,3 5 0 0,0 0 5 100,1 2 0 0,1 3 0 0,4 "
                                "5 0 0,0 0 6 7,0 0 100 6,0 0 5 "
                                "100,0 0 7 8,0 0 6 7,0 0 100 6,0 0 7 9,0 0 6 7,2 5 0 0,0 0 5 6,3 5 0 0,0 0 7 "
                                "100,0 0 8 7,0 0 100 8,0 0 6 100,0 0 "
                                "5 6,0 0 7 10,10 11 0 0,0 0 100 7,0 0 9 100,0 0 7 9,0 0 100 7,0 0 7 10,0 0 6 "
                                "7,11 12 0 0,0 0 8 100,10 11 0 0,0 0 "
                                "7 8,0 0 100 7,0 0 7 10,0 0 9 7,11 12 0 0,10 11 0 0,0 0 7 10,0 0 8 7,11 12 0 "
                                "0,0 0 7 10,10 11 0 0,11 12 0 0,10 "
                                "11 0 0,11 12 0 0";
static const char *const reentrant_places[] = {"",     "LLA",  "PM11", "PM12", "PM13", "BM11", "PM21",
                                               "PM22", "PM23", "PM24", "BM12", "PM14", "LLB"};

static const char *const robots[2] = {"R1", "R2"};

static void open_clusters(flow_case_t *flow, int which) {
    flow_open(flow, "R1 R2*2", "LLA*5 LLB*5 PM11 PM12 PM13 PM14 BM11 BM12 PM21 PM22 PM23 PM24");
    flow_robot(flow, "R1", "LLA LLB PM11 PM12 PM13 PM14 BM11 BM12", 1, 1, 1, 0);
    flow_robot(flow, "R2", "BM11 BM12 PM21 PM22 PM23 PM24", 1, 1, 1, 0);
    flow_lot(flow, routes[which], 5, 1, 0);
    flow_finish(flow);
}

static const char *place_name(const char *const places[], int number) {
    return number == 100 ? "keep" : places[number];
}

/* A move of the serial flow is one number: from that place along the route to the next. */
static void add_serial(flow_case_t *flow, const int moves[]) {
    for (int r = 0; r < 2; ++r) {
        if (moves[r] > 0) {
            flow_line(flow, robots[r], serial_places[moves[r] - 1], serial_places[moves[r]]);
        }
    }
}

static void add_pair(flow_case_t *flow, const char *const places[], const int moves[]) {
    for (int r = 0; r < 2; ++r) {
        if (moves[2 * r] > 0) {
            flow_line(flow, robots[r], place_name(places, moves[2 * r]),
                      place_name(places, moves[2 * r + 1]));
        }
    }
}

static void read_lists(flow_case_t *flow, int which) {
    static const char *const rounds[3] = {serial, parallel, reentrant};
    char text[2000], *rest = NULL;
    (void)snprintf(text, sizeof text, "%s", rounds[which]);
    for (char *round = strtok_r(text, ",", &rest); round; round = strtok_r(NULL, ",", &rest)) {
        int moves[4] = {0, 0, 0, 0};
        const int count = sscanf(round, "%d %d %d %d", &moves[0], &moves[1], &moves[2], &moves[3]);
        assert_int_equal(count, which == 0 ? 2 : 4);
        if (which == 0) {
            add_serial(flow, moves);
        } else {
            add_pair(flow, which == 1 ? parallel_places : reentrant_places, moves);
        }
    }
}

static int64_t play(flow_case_t *flow, wh_flow_end_t wanted) {
    wh_flow_result_t result;
    wh_flow_play(&flow->tool, &flow->plan, NULL, &result);
    if (result.end != wanted) {
        print_message("end %d: %s\n", (int)result.end, result.why ? result.why : "");
    }
    assert_int_equal(result.end, wanted);
    const int64_t makespan_us = result.makespan_us;
    wh_flow_result_close(&result);
    return makespan_us;
}

static void published_sequences_take_their_time(void **state) {
    (void)state;
    static const int64_t wanted[3] = {769, 833, 1095};
    for (int i = 0; i < 3; ++i) {
        flow_case_t flow;
        open_clusters(&flow, i);
        read_lists(&flow, i);
        assert_int_equal(play(&flow, WH_FLOW_DONE), wanted[i] * FLOW_S);
        flow_close(&flow);
    }
}

static void rules_come_near(void **state) {
    (void)state;
    static const int64_t best[3] = {769, 833, 1095};
    static const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_SWAPPING, WH_FLOW_FIRST_COME,
                                           WH_FLOW_LONGEST_WAIT};
    for (int i = 0; i < 3; ++i) {
        int64_t least = INT64_MAX;
        for (size_t k = 0; k < 4; ++k) {
            flow_case_t flow;
            open_clusters(&flow, i);
            flow.plan.rule = rules[k];
            const int64_t took = play(&flow, WH_FLOW_DONE);
            print_message("flow %d, rule %d: %.3f s\n", i, (int)rules[k], (double)took / FLOW_S);
            assert_true(took >= best[i] * FLOW_S && took <= best[i] * FLOW_S * 115 / 100);
            least = took < least ? took : least;
            flow_close(&flow);
        }
        assert_true(least <= best[i] * FLOW_S * 102 / 100);
    }
}

/* Two robots exchange wafers between two full places only if neither waits until the other has placed. */
static void a_place_that_will_be_empty_is_enough(void **state) {
    (void)state;
    flow_case_t flow;
    flow_open(&flow, "R1 R2", "X B Y");
    flow_robot(&flow, "R1", "X B", 3, 3, 2, 0);
    flow_robot(&flow, "R2", "B Y", 3, 3, 2, 0);
    flow_lot(&flow, "B>Y", 1, 1, 0);
    flow_lot(&flow, "X>B", 1, 1, 0);
    flow_finish(&flow);
    assert_int_equal(play(&flow, WH_FLOW_DONE), 8 * FLOW_S);
    flow_close(&flow);
}

typedef struct {
    const char *route;
    int arms;
    double wait, move, clean[3];
    int partial[3];
    double cycle;
} row_t;

static const row_t rows[] = {
    {"I>A:60>O", 1, 3, 2, {0}, {0}, 78},
    {"I>A:60>B:70>O", 1, 3, 2, {0}, {0}, 88},
    {"I>A|B:100>C:90>D|E:100>O", 1, 3, 2, {0}, {0}, 108},
    {"I>A|B|C:200>D:60>E|F:130>O", 1, 5, 2, {0}, {0}, 86},
    {"I>A:60>B:70>O", 1, 3, 2, {30, 30}, {0, 0}, 106},
    {"I>A|B:100>C|D:100>O", 1, 3, 2, {40, 40}, {1, 0}, 118},
    {"I>A|B|C:120>D|E:90>F|G|H:150>O", 1, 3, 2, {60, 30, 60}, {1, 0, 1}, 84},
    {"I>A:60>O", 2, 8, 2, {0}, {0}, 68},
    {"I>A:60>B:70>O", 2, 8, 2, {0}, {0}, 78},
    {"I>A:82>B:92>C:100>O", 2, 4, 1, {0}, {0}, 104},
};

static void open_row(flow_case_t *flow, const row_t *row) {
    flow_open(flow, row->arms == 2 ? "R*2" : "R", "I*200 O*200 A B C D E F G H");
    const double wait = row->arms == 2 ? (row->wait - row->move) / 2 : row->wait;
    flow_robot(flow, "R", "I O A B C D E F G H", wait, wait, row->move, 0);
    flow_lot(flow, row->route, 200, 1, 0);
    wh_flow_route_t *route = &flow->plan.routes[0];
    for (size_t k = 1; k + 1 < route->step_count; ++k) {
        route->steps[k].kept_empty = row->partial[k - 1];
        for (size_t i = 0; i < route->steps[k].station_count; ++i) {
            wh_flow_station_t *station = &flow->tool.stations[route->steps[k].stations[i]];
            station->clean_us = (int64_t)(row->clean[k - 1] * FLOW_S);
            station->clean_after = row->clean[k - 1] > 0 ? 1 : 0;
        }
    }
    flow->plan.rule = row->arms == 2 ? WH_FLOW_SWAPPING : WH_FLOW_BACKWARD;
    flow_finish(flow);
}

static void cycles_are_the_published_ones(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        flow_case_t flow;
        wh_flow_result_t result;
        open_row(&flow, &rows[i]);
        wh_flow_play(&flow.tool, &flow.plan, NULL, &result);
        assert_int_equal(result.end, WH_FLOW_DONE);
        assert_true(result.period > 0);
        const double cycle = (double)result.cycle_us / FLOW_S / result.period;
        print_message("%s: %.6f s over %d, published %.0f\n", rows[i].route, cycle, (int)result.period,
                      rows[i].cycle);
        assert_true(cycle > rows[i].cycle - 1e-6 && cycle < rows[i].cycle + 1e-6);
        wh_flow_result_close(&result);
        flow_close(&flow);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(published_sequences_take_their_time),
        cmocka_unit_test(rules_come_near),
        cmocka_unit_test(a_place_that_will_be_empty_is_enough),
        cmocka_unit_test(cycles_are_the_published_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
