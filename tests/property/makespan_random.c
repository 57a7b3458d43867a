/* Random tools: each part of a critical path against what the makespan does when those times alone become
 * a microsecond shorter or longer. Where both say the same, the part must be of that size. */
#include "flow/figures.h"
#include "support/flow.h"

#define TOOLS 3000
#define LEAST 60

/* A kind of time, and whose. */
typedef struct {
    wh_flow_path_word_t word;
    int32_t robot, station;
} doing_t;

static int64_t random_us(bool is_round, double least_s, double most_s) {
    return is_round ? FLOW_S * (int64_t)wh_test_uniform(least_s, most_s + 1)
                    : (int64_t)(FLOW_S * wh_test_uniform(least_s, most_s));
}

/* One time for all that the robot serves: a part is so many of them. */
static void draw_robot(wh_flow_tool_t *tool, int32_t robot, bool is_round) {
    const int64_t pick_us = random_us(is_round, 1, 6), place_us = random_us(is_round, 1, 6),
                  move_us = random_us(is_round, 1, 5), swap_us = random_us(is_round, 3, 12);
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, robot, s);
        tool->pick_us[of] = pick_us;
        tool->place_us[of] = place_us;
        tool->swap_us[of] = swap_us;
        for (size_t to = 0; to < tool->station_count; ++to) {
            tool->move_us[of * tool->station_count + to] = move_us;
        }
    }
}

static void draw_module(wh_flow_tool_t *tool, int32_t s, bool is_round) {
    wh_flow_station_t *station = &tool->stations[s];
    station->process_us = wh_test_below(8) == 0 ? 0 : random_us(is_round, 5, 90);
    station->clean_us = random_us(is_round, 3, 60);
    station->clean_after = (int32_t)wh_test_below(4);
    station->cleans_full = wh_test_below(3) == 0;
}

static void draw_doors(wh_flow_tool_t *tool, int32_t s, bool is_round) {
    const int64_t close_us = random_us(is_round, 1, 3);
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        tool->doors[wh_flow_of(tool, r, s)] = (wh_flow_door_t){tool->pick_us[0] / 2 + 7 + r, close_us};
    }
}

static void draw_lock(wh_flow_tool_t *tool, int32_t s, bool is_round) {
    wh_flow_station_t *station = &tool->stations[s];
    const int64_t us = random_us(is_round, 2, 40);
    station->is_lock = true;
    for (int i = 0; i < 2; ++i) {
        station->pump_us[i] = station->empty_pump_us[i] = us;
    }
    tool->sides[wh_flow_of(tool, 0, s)] = WH_FLOW_ATMOSPHERE;
    tool->sides[wh_flow_of(tool, 1, s)] = WH_FLOW_VACUUM;
}

static void draw_stations(wh_flow_tool_t *tool, bool is_round) {
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        wh_flow_station_t *station = &tool->stations[s];
        station->window_us = station->idle_us = WH_FLOW_NEVER;
        if (station->name[0] == 'P') {
            draw_module(tool, s, is_round);
        }
        if (station->name[0] == 'L') {
            draw_lock(tool, s, is_round);
        }
        if (station->name[0] != 'O' && wh_test_below(3) == 0) {
            draw_doors(tool, s, is_round);
        }
    }
}

/* One robot between load port, modules and the end, or two with locks between them. */
static void draw_tool(flow_case_t *flow, bool is_round) {
    const bool has_locks = wh_test_below(2) == 0, has_two = wh_test_below(2) == 0;
    if (has_locks) {
        flow_open(flow, has_two ? "A V*2" : "A V", "H*30 O*30 LA LB P1 P2 P3");
        flow_robot(flow, "A", "H O LA LB", 1, 1, 1, 0);
        flow_robot(flow, "V", "LA LB P1 P2 P3", 1, 1, 1, 0);
    } else {
        flow_open(flow, has_two ? "A*2" : "A", "H*30 O*30 P1 P2 P3");
        flow_robot(flow, "A", "H O P1 P2 P3", 1, 1, 1, 0);
    }
    wh_flow_tool_t *tool = &flow->tool;
    for (size_t i = 0; i < tool->place_count; ++i) {
        tool->slot_sides[i] = WH_FLOW_BOTH;
    }
    for (size_t i = 0; i < tool->robot_count * tool->station_count; ++i) {
        tool->sides[i] = WH_FLOW_BOTH;
    }
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        draw_robot(tool, r, is_round);
    }
    draw_stations(tool, is_round);
}

static void draw_plan(flow_case_t *flow, bool is_round) {
    static const char *const inner[] = {"P1", "P1>P2", "P1|P2>P3", "P1|P2|P3", "P1>P2|P3"};
    static const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_SWAPPING, WH_FLOW_FIRST_COME,
                                           WH_FLOW_LONGEST_WAIT};
    const bool has_locks = flow->tool.robot_count > 1;
    char route[100];
    (void)snprintf(route, sizeof route, "H>%s%s%s>O", has_locks ? "LA|LB>" : "", inner[wh_test_below(5)],
                   has_locks ? ">LA|LB" : "");
    flow_lot(flow, route, 1 + (int32_t)wh_test_below(9), 1, 0);
    if (wh_test_below(3) == 0) {
        flow_lot(flow, route, 1 + (int32_t)wh_test_below(5), 11, 0);
        flow->plan.lots[1].arrives_us = random_us(is_round, 20, 600);
    }
    flow->plan.rule = rules[wh_test_below(4)];
    flow->plan.takt_us = wh_test_below(3) == 0 ? random_us(is_round, 20, 200) : 0;
    if (wh_test_below(4) == 0) {
        flow->plan.downs = wh_array_new(1, sizeof *flow->plan.downs);
        flow->plan.down_count = 1;
        flow->plan.downs[0] =
            (wh_flow_down_t){.station = (int32_t)flow->tool.station_count - 1 - (int32_t)wh_test_below(3),
                             .at_us = random_us(is_round, 10, 300),
                             .for_us = random_us(is_round, 10, 200),
                             .robot = WH_FLOW_NONE};
    }
    flow_finish(flow);
}

/* ----------------------------------------------------------------------------------------- one more or less */

static void change_robot(wh_flow_tool_t *tool, const doing_t *doing, int64_t by_us) {
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const size_t of = wh_flow_of(tool, doing->robot, s);
        tool->pick_us[of] += doing->word == WH_FLOW_PATH_PICK ? by_us : 0;
        tool->place_us[of] += doing->word == WH_FLOW_PATH_PLACE ? by_us : 0;
        tool->swap_us[of] += doing->word == WH_FLOW_PATH_SWAP ? by_us : 0;
        tool->doors[of].open_us +=
            doing->word == WH_FLOW_PATH_DOOR && tool->doors[of].open_us > 0 ? by_us : 0;
        for (size_t to = 0; to < tool->station_count; ++to) {
            tool->move_us[of * tool->station_count + to] += doing->word == WH_FLOW_PATH_MOVE ? by_us : 0;
        }
    }
}

static void change_station(wh_flow_tool_t *tool, const doing_t *doing, int64_t by_us) {
    wh_flow_station_t *station = &tool->stations[doing->station];
    station->process_us += doing->word == WH_FLOW_PATH_PROCESS ? by_us : 0;
    station->clean_us += doing->word == WH_FLOW_PATH_CLEAN ? by_us : 0;
    for (int i = 0; i < 2; ++i) {
        station->pump_us[i] += doing->word == WH_FLOW_PATH_PUMP ? by_us : 0;
        station->empty_pump_us[i] += doing->word == WH_FLOW_PATH_PUMP ? by_us : 0;
    }
    for (int32_t r = 0; r < (int32_t)tool->robot_count && doing->word == WH_FLOW_PATH_DOOR; ++r) {
        tool->doors[wh_flow_of(tool, r, doing->station)].close_us += by_us;
    }
}

static void change(flow_case_t *flow, const doing_t *doing, int64_t by_us) {
    if (doing->robot != WH_FLOW_NONE) {
        change_robot(&flow->tool, doing, by_us);
    } else if (doing->word == WH_FLOW_PATH_TAKT) {
        flow->plan.takt_us += by_us;
    } else if (doing->word == WH_FLOW_PATH_LOT) {
        flow->plan.lots[1].arrives_us += by_us;
    } else if (doing->word == WH_FLOW_PATH_WAIT) {
        flow->plan.downs[0].at_us += by_us;
    } else if (doing->word == WH_FLOW_PATH_DOWN) {
        flow->plan.downs[0].for_us += by_us;
    } else {
        change_station(&flow->tool, doing, by_us);
    }
}

static int64_t makespan_with(flow_case_t *flow, const doing_t *doing, int64_t by_us) {
    wh_flow_result_t result;
    change(flow, doing, by_us);
    wh_flow_play(&flow->tool, &flow->plan, NULL, &result);
    change(flow, doing, -by_us);
    const int64_t makespan_us = result.end == WH_FLOW_DONE ? result.makespan_us : -1;
    wh_flow_result_close(&result);
    return makespan_us;
}

static int64_t opening_us(const wh_flow_tool_t *tool, int32_t robot) {
    int64_t open_us = 0;
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        const int64_t us = tool->doors[wh_flow_of(tool, robot, s)].open_us;
        open_us = us > open_us ? us : open_us;
    }
    return open_us;
}

/* How long one of them is; 0: there is none in this tool. */
static int64_t length_of_robot_us(const wh_flow_tool_t *tool, const doing_t *doing) {
    const size_t of = wh_flow_of(tool, doing->robot, 0);
    return doing->word == WH_FLOW_PATH_MOVE    ? tool->move_us[of * tool->station_count + 1]
           : doing->word == WH_FLOW_PATH_PICK  ? tool->pick_us[of]
           : doing->word == WH_FLOW_PATH_PLACE ? tool->place_us[of]
           : doing->word == WH_FLOW_PATH_SWAP  ? tool->swap_us[of]
                                               : opening_us(tool, doing->robot);
}

static int64_t length_of_station_us(const flow_case_t *flow, const doing_t *doing) {
    const wh_flow_station_t *station = &flow->tool.stations[doing->station];
    const bool fails = flow->plan.down_count > 0 && flow->plan.downs[0].station == doing->station;
    return doing->word == WH_FLOW_PATH_PROCESS ? station->process_us
           : doing->word == WH_FLOW_PATH_CLEAN ? station->clean_us
           : doing->word == WH_FLOW_PATH_PUMP  ? station->pump_us[0]
           : doing->word == WH_FLOW_PATH_DOOR
               ? flow->tool.doors[wh_flow_of(&flow->tool, 0, doing->station)].close_us
           : fails ? flow->plan.downs[0].for_us
                   : 0;
}

static int64_t length_us(const flow_case_t *flow, const doing_t *doing) {
    const wh_flow_plan_t *plan = &flow->plan;
    if (doing->robot != WH_FLOW_NONE) {
        return length_of_robot_us(&flow->tool, doing);
    }
    if (doing->station != WH_FLOW_NONE) {
        return length_of_station_us(flow, doing);
    }
    if (doing->word == WH_FLOW_PATH_TAKT) {
        return plan->takt_us;
    }
    const bool is_lot = doing->word == WH_FLOW_PATH_LOT;
    return is_lot && plan->lot_count > 1     ? plan->lots[1].arrives_us
           : !is_lot && plan->down_count > 0 ? plan->downs[0].at_us
                                             : 0;
}

static int64_t part_us(const wh_flow_figures_t *figures, const doing_t *doing) {
    for (size_t i = 0; i < figures->part_count; ++i) {
        const wh_flow_part_t *part = &figures->parts[i];
        if (part->word == doing->word && part->robot == doing->robot && part->station == doing->station) {
            return part->us;
        }
    }
    return 0;
}

/* In whole seconds much ends at one instant, and which of it was needed is told by what came next alone. */
typedef struct {
    bool has_ties;
    size_t compared, off;
} tally_t;

static void compare(flow_case_t *flow, const wh_flow_figures_t *figures, const doing_t *doing,
                    tally_t *tally) {
    const int64_t each_us = length_us(flow, doing), us = part_us(figures, doing);
    if (each_us == 0) {
        assert_int_equal(us, 0);
        return;
    }
    const int64_t less_us = makespan_with(flow, doing, -1), more_us = makespan_with(flow, doing, 1),
                  makespan_us = figures->result.makespan_us;
    const int64_t down = makespan_us - less_us, up = more_us - makespan_us;
    if (less_us < 0 || more_us < 0) {
        return;
    }
    const int64_t least = down < up ? down : up, most = down < up ? up : down;
    const bool is_between = us >= least * each_us && us <= most * each_us;
    ++tally->compared;
    if (!tally->has_ties) {
        assert_int_equal(down, up);
        assert_int_equal(us, down * each_us);
    }
    tally->off += !is_between;
}

static void compare_all(flow_case_t *flow, const wh_flow_figures_t *figures, tally_t *tally) {
    static const wh_flow_path_word_t of_robots[] = {WH_FLOW_PATH_MOVE, WH_FLOW_PATH_PICK, WH_FLOW_PATH_PLACE,
                                                    WH_FLOW_PATH_SWAP, WH_FLOW_PATH_DOOR};
    static const wh_flow_path_word_t of_stations[] = {
        WH_FLOW_PATH_PROCESS, WH_FLOW_PATH_CLEAN, WH_FLOW_PATH_PUMP, WH_FLOW_PATH_DOOR, WH_FLOW_PATH_DOWN};
    static const wh_flow_path_word_t of_none[] = {WH_FLOW_PATH_TAKT, WH_FLOW_PATH_LOT, WH_FLOW_PATH_WAIT};
    for (int32_t r = 0; r < (int32_t)flow->tool.robot_count; ++r) {
        for (size_t i = 0; i < 5; ++i) {
            compare(flow, figures, &(doing_t){of_robots[i], r, WH_FLOW_NONE}, tally);
        }
    }
    for (int32_t s = 0; s < (int32_t)flow->tool.station_count; ++s) {
        for (size_t i = 0; i < 5; ++i) {
            compare(flow, figures, &(doing_t){of_stations[i], WH_FLOW_NONE, s}, tally);
        }
    }
    for (size_t i = 0; i < 3; ++i) {
        compare(flow, figures, &(doing_t){of_none[i], WH_FLOW_NONE, WH_FLOW_NONE}, tally);
    }
}

static void a_part_is_what_its_time_is_worth(void **unused) {
    (void)unused;
    tally_t tallies[2] = {{false, 0, 0}, {true, 0, 0}};
    size_t done = 0;
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TOOLS, 0.8);
    while (wh_round(&rounds)) {
        const bool is_round = wh_test_below(2) == 0;
        flow_case_t flow;
        wh_flow_figures_t figures;
        draw_tool(&flow, is_round);
        draw_plan(&flow, is_round);
        wh_flow_measure(&flow.tool, &flow.plan, WH_FLOW_VISITS, &figures);
        if (figures.result.end == WH_FLOW_DONE) {
            int64_t sum_us = 0;
            for (size_t i = 0; i < figures.part_count; ++i) {
                sum_us += figures.parts[i].us;
            }
            assert_int_equal(sum_us, figures.result.makespan_us);
            compare_all(&flow, &figures, &tallies[is_round]);
            ++done;
        }
        wh_flow_figures_close(&figures);
        flow_close(&flow);
    }
    assert_true(tallies[1].off * 100 <= tallies[1].compared);
    assert_true(done > (size_t)rounds.made / 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_part_is_what_its_time_is_worth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
