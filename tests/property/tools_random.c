/* Random tools, lots, failures and rules, those that answer at random and random lists among them: no wafer is lost
 * or in two places, no window is broken unsaid and no interlock at all, and each flow ends done, STUCK where nobody
 * can go on, or with a named cause. The log is held against the descriptions by support/tool_log.h, which shares no
 * code with the engine. */
#include "flow/failed.h"
#include "support/random_tool.h"
#include "support/stuck_tool.h"
#include "support/tool_log.h"

#define TOOLS 10000
#define LEAST 120

typedef enum { BY_RULE, BY_LISTS, BY_FUNCTION } kind_t;

/* A rule that answers at random: always the same for the same question. */
typedef struct {
    uint64_t seed, asked;
    bool is_bad;    /* it answers now and then what can never be */
    uint32_t stops; /* one of so many problems ends the flow; 0: none does */
    size_t late;    /* stays beyond windows of which it has heard */
} random_rule_t;

static uint32_t below(random_rule_t *rule, uint32_t count) {
    return (uint32_t)((wh_test_splitmix(&rule->seed) >> 32) % count);
}

static wh_flow_line_t any_line(random_rule_t *rule, const wh_flow_tool_t *tool) {
    wh_flow_line_t line = WH_FLOW_NO_LINE;
    const uint32_t stations = (uint32_t)tool->station_count, kind = below(rule, 3);
    line.what = kind == 0 ? WH_FLOW_TRANSFER : kind == 1 ? WH_FLOW_KEEP : WH_FLOW_BRING;
    line.from = kind == 2 ? WH_FLOW_NONE : (int32_t)below(rule, stations);
    line.to = kind == 1 ? WH_FLOW_NONE : (int32_t)below(rule, stations);
    return line;
}

/* A station of the wafer's next step, or WH_FLOW_NONE. */
static int32_t any_next(random_rule_t *rule, const wh_flow_state_t *state, int32_t wafer) {
    const bool rests = state->wafers[wafer].is_over || state->wafers[wafer].is_moving;
    const int32_t step = rests ? WH_FLOW_NONE : wh_flow_next_step(state, wafer);
    const wh_flow_step_t *next = step == WH_FLOW_NONE ? NULL : wh_flow_step_of(state->plan, wafer, step);
    return next ? next->stations[below(rule, (uint32_t)next->station_count)] : WH_FLOW_NONE;
}

static bool has_arm(const wh_flow_state_t *state, int32_t robot) {
    const int32_t *arms = state->robots[robot].arms;
    return arms[0] == WH_FLOW_NONE || (state->tool->robots[robot].arms > 1 && arms[1] == WH_FLOW_NONE);
}

static bool serves(const wh_flow_state_t *state, int32_t robot, int32_t station) {
    return station != WH_FLOW_NONE && state->tool->serves[wh_flow_of(state->tool, robot, station)];
}

/* Something that the robot could do with this wafer, now or later. False: nothing. */
static bool some_line(random_rule_t *rule, const wh_flow_state_t *state, int32_t robot, int32_t wafer,
                      wh_flow_line_t *line) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const bool is_aboard = at->robot == robot;
    const int32_t to = any_next(rule, state, wafer), from = wh_flow_station_of(state, wafer);
    const bool can_take = serves(state, robot, from) && has_arm(state, robot);
    *line = WH_FLOW_NO_LINE;
    if (!serves(state, robot, to) || (!is_aboard && !can_take)) {
        return false;
    }
    line->what = is_aboard ? WH_FLOW_BRING : below(rule, 4) == 0 ? WH_FLOW_KEEP : WH_FLOW_TRANSFER;
    line->from = from;
    line->to = line->what == WH_FLOW_KEEP ? WH_FLOW_NONE : to;
    line->wafer = below(rule, 2) == 0 ? wafer : WH_FLOW_NONE;
    return true;
}

static int answer(void *context, const wh_flow_state_t *state, int32_t robot, wh_flow_line_t lines[],
                  char **why) {
    random_rule_t *rule = context;
    const uint32_t most = 1 + below(rule, WH_FLOW_ANSWERS), wafers = (uint32_t)state->plan->wafer_count;
    const uint32_t first = below(rule, wafers);
    int count = 0;
    ++rule->asked;
    if (rule->is_bad && below(rule, 400) == 0) {
        *why = below(rule, 2) == 0 ? wh_text_copy("it will not") : NULL;
        return -1;
    }
    for (uint32_t i = 0; i < wafers && count < (int)most; ++i) {
        count += some_line(rule, state, robot, (int32_t)((first + i) % wafers), &lines[count]) ? 1 : 0;
    }
    if (rule->is_bad && below(rule, 60) == 0) {
        lines[count < WH_FLOW_ANSWERS ? count++ : 0] = any_line(rule, state->tool);
    }
    return count;
}

static char *hear_problem(void *context, const wh_flow_state_t *state, const wh_flow_problem_t *problem) {
    random_rule_t *rule = context;
    (void)state;
    rule->late += problem->what == WH_FLOW_LATE ? 1 : 0;
    return rule->stops > 0 && below(rule, rule->stops) == 0 ? wh_text_copy("a problem too much") : NULL;
}

/* --------------------------------------------------------------------------------------------------- lists */

/* The lines that a flow by a shipped rule would have. */
typedef struct {
    flow_case_t *flow;
    wh_flow_list_t *lists;
} writer_t;

static void write_line(writer_t *writer, int32_t robot, const wh_flow_line_t *line) {
    wh_flow_list_t *list = &writer->lists[robot];
    list->lines = wh_array_grow(list->lines, list->count, &list->capacity, sizeof *list->lines);
    list->lines[list->count++] = *line;
}

static void write_event(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    writer_t *writer = context;
    wh_flow_line_t line = WH_FLOW_NO_LINE;
    (void)state;
    if (event->kind == WH_FLOW_EVENT_PICK) {
        line.what = WH_FLOW_KEEP;
        line.from = event->station;
        line.wafer = random_in(3) ? event->wafer : WH_FLOW_NONE;
        write_line(writer, event->robot, &line);
    } else if (event->kind == WH_FLOW_EVENT_PLACE) {
        wh_flow_list_t *list = &writer->lists[event->robot];
        wh_flow_line_t *last = list->count > 0 ? &list->lines[list->count - 1] : NULL;
        line.what = WH_FLOW_BRING;
        line.to = event->station;
        if (last && last->what == WH_FLOW_KEEP && !random_in(5)) {
            last->what = WH_FLOW_TRANSFER;
            last->to = event->station;
        } else {
            write_line(writer, event->robot, &line);
        }
    }
}

/* Neighbours change places, lines get lost or come twice, a lock is pumped. */
static void disturb(flow_case_t *flow, wh_flow_list_t *list) {
    const size_t times = random_in(3) ? wh_test_below(4) : 0;
    for (size_t i = 0; i < times && list->count > 1; ++i) {
        const size_t at = wh_test_below((uint32_t)list->count - 1), kind = wh_test_below(4);
        const wh_flow_line_t line = list->lines[at];
        if (kind == 0) {
            list->lines[at] = list->lines[at + 1];
            list->lines[at + 1] = line;
        } else if (kind == 1) {
            memmove(&list->lines[at], &list->lines[at + 1], (list->count - at - 1) * sizeof line);
            --list->count;
        } else if (kind == 2) {
            list->lines[at] = list->lines[at + 1];
        } else {
            const int32_t lock = (int32_t)wh_test_below((uint32_t)flow->tool.station_count);
            if (flow->tool.stations[lock].is_lock) {
                list->lines[at] = WH_FLOW_NO_LINE;
                list->lines[at].what = WH_FLOW_PUMP;
                list->lines[at].to = lock;
                list->lines[at].side = random_in(2) ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE;
            }
        }
    }
}

static void make_lists(flow_case_t *flow) {
    writer_t writer = {flow, wh_array_new(flow->tool.robot_count, sizeof *writer.lists)};
    const wh_flow_listener_t listener = {&writer, write_event, NULL, NULL};
    wh_flow_result_t result;
    flow->plan.rule = random_in(2) ? WH_FLOW_FIRST_COME : WH_FLOW_BACKWARD;
    wh_flow_play(&flow->tool, &flow->plan, &listener, &result);
    wh_flow_result_close(&result);
    for (size_t r = 0; r < flow->tool.robot_count; ++r) {
        disturb(flow, &writer.lists[r]);
    }
    flow->plan.rule = WH_FLOW_LISTS;
    flow->plan.lists = writer.lists;
}

/* -------------------------------------------------------------------------------------------------- hearing */

/* A robot has done something. */
static void hear_robot(tool_log_t *log, const wh_flow_event_t *event) {
    const size_t of = (size_t)event->robot * log->tool->station_count + (size_t)event->station;
    if (event->kind == WH_FLOW_EVENT_MOVE) {
        log_move(log, event);
    } else if (event->kind == WH_FLOW_EVENT_OPEN) {
        log_opening(log, event);
    } else if (event->kind == WH_FLOW_EVENT_PICK) {
        log_take(log, event, log_enter(log, event, log->tool->pick_us[of], "pick"), event->arm);
    } else if (event->kind == WH_FLOW_EVENT_PLACE) {
        log_put(log, event, log_enter(log, event, log->tool->place_us[of], "place"), event->wafer);
    } else if (event->kind == WH_FLOW_EVENT_SWAP) {
        const int64_t begin_us = log_enter(log, event, log->tool->swap_us[of], "swap");
        log_take(log, event, begin_us, 1 - event->arm);
        log_put(log, event, begin_us, event->other);
    }
}

/* Something has happened without one. */
static void hear_station(tool_log_t *log, const wh_flow_event_t *event) {
    if (event->kind == WH_FLOW_EVENT_STAY && log->wafers[event->wafer].is_born) {
        log->wafers[event->wafer].stay_us = event->end_us;
    } else if (event->kind == WH_FLOW_EVENT_PROCESS) {
        log_process(log, event);
    } else if (event->kind == WH_FLOW_EVENT_CLEAN) {
        log_clean(log, event);
    } else if (event->kind == WH_FLOW_EVENT_PUMP) {
        log_pump(log, event);
    } else if (event->kind == WH_FLOW_EVENT_ENDS) {
        log_end_of_route(log, event);
    }
}

/* The begin of a pick is told with it; the end of a process with the clean around its wafer. */
static void hear(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    tool_log_t *log = context;
    (void)state;
    const bool is_beside = event->kind == WH_FLOW_EVENT_STAY || event->kind == WH_FLOW_EVENT_PROCESS;
    log_holds(log, event->begin_us <= event->end_us || is_beside, "event %d ends before it begins",
              (int)event->kind);
    log_holds(log, is_beside || event->end_us >= log->now_us,
              "event %d is told in another order than that of the ends", (int)event->kind);
    log->now_us = is_beside ? log->now_us : event->end_us;
    if (event->robot >= 0 && event->kind != WH_FLOW_EVENT_STAY) {
        hear_robot(log, event);
    } else {
        hear_station(log, event);
    }
}

/* A lot that has come into the slot of a wafer at its end has not begun to leave it. */
static bool has_made_room(const log_wafer_t *wafer, const wh_flow_state_t *state,
                          const wh_flow_wafer_state_t *at) {
    return wafer->is_over && at->place < 0 && wafer->place >= 0 && state->places[wafer->place].wafer >= 0;
}

/* The wafer is where the log has it. */
static void compare_wafer(tool_log_t *log, const wh_flow_state_t *state, int32_t w) {
    const log_wafer_t *wafer = &log->wafers[w];
    const wh_flow_wafer_state_t *at = &state->wafers[w];
    const bool is_here = !wafer->is_born || at->place == wafer->place || has_made_room(wafer, state, at);
    log_holds(log, is_here && at->robot == wafer->robot, "%s is elsewhere than told", log_wafer_name(log, w));
    log_holds(log, at->place < 0 || state->places[at->place].wafer == w, "%s is not in its place",
              log_wafer_name(log, w));
    log_holds(log, !wafer->is_born || at->is_over == wafer->is_over || at->is_lost, "%s is over, and is not",
              log_wafer_name(log, w));
}

/* A stay that goes on is judged, too. */
static void judge_stay(tool_log_t *log, const wh_flow_state_t *state, int32_t w) {
    const log_wafer_t *wafer = &log->wafers[w];
    if (!wafer->is_born || wafer->place < 0 || wafer->is_over || wafer->step == 0) {
        return;
    }
    const int32_t station = log->tool->place_stations[wafer->place];
    if (wafer->done_us >= 0 && wafer->done_us <= state->now_us) {
        log_stay(log, w, station, wafer->stay_us >= 0 ? wafer->stay_us : state->now_us);
    } else {
        log->untold += log->tool->stations[station].cleans_full ? 1 : 0;
    }
}

static void hear_end(void *context, const wh_flow_state_t *state) {
    tool_log_t *log = context;
    for (int32_t w = 0; w < (int32_t)log->plan->wafer_count; ++w) {
        compare_wafer(log, state, w);
        judge_stay(log, state, w);
    }
    stuck_look(log, state);
}

/* --------------------------------------------------------------------------------------------------- claims */

typedef struct {
    size_t ends[4], refused, lost, late, swaps;
} tally_t;

static void check_counts(tool_log_t *log, const wh_flow_result_t *result) {
    size_t over = 0, lost = 0, left = 0;
    for (size_t w = 0; w < log->plan->wafer_count; ++w) {
        const bool is_dummy = log->plan->lots[log->plan->wafers[w].lot].is_dummy;
        over += log->wafers[w].is_over && !log->wafers[w].is_lost && !is_dummy ? 1 : 0;
        lost += log->wafers[w].is_lost ? 1 : 0;
        left += log->wafers[w].is_over ? 0 : 1;
    }
    log_holds(log, result->lost >= lost, "%zu wafers are lost, told are %zu", lost, result->lost);
    log_holds(log, left >= result->left && left - result->left == result->lost - lost,
              "%zu wafers are left, told are %zu, and %zu lost ones aboard", left, result->left,
              result->lost - lost);
    log_holds(log, result->over == over, "%zu wafers are at their ends, told are %zu", over, result->over);
}

/* Each end has its cause, and nobody could go on who is STUCK. */
static void check_end(tool_log_t *log, const wh_flow_result_t *result, kind_t kind,
                      const random_rule_t *rule) {
    const bool is_good = result->end == WH_FLOW_DONE || result->end == WH_FLOW_CUT;
    const char *why = result->why ? result->why : "";
    check_counts(log, result);
    log_holds(log, result->end != WH_FLOW_DONE || result->left == 0, "done, and wafers are left");
    log_holds(log, is_good == !result->why, "a cause of a good end, or none of a bad one: %s", why);
    log_holds(log, result->end != WH_FLOW_CUT || log->plan->until_us != WH_FLOW_NEVER,
              "cut without `until_s`");
    if (result->end == WH_FLOW_BROKEN) {
        log_holds(log, kind != BY_RULE || rule->stops > 0, "a shipped rule broke: %s", why);
    } else if (result->end == WH_FLOW_STUCK) {
        log_holds(log, kind == BY_FUNCTION || !log->goes_on, "STUCK, though %s: %.150s", log->going, why);
    }
}

/* Plays it once more, with figures: the same flow, whose late stays are those of the log, and whose classes add up. */
static void check_figures(tool_log_t *log, const flow_case_t *flow, const wh_flow_result_t *result) {
    wh_flow_figures_t figures;
    wh_flow_measure(&flow->tool, &flow->plan, WH_FLOW_SUMS, &figures);
    log_holds(log, figures.result.end == result->end && figures.result.makespan_us == result->makespan_us,
              "another end when played again");
    const size_t told = figures.stays.late_count;
    log_holds(log, told >= log->late && told <= log->late + log->untold,
              "%zu stays beyond windows, told are %zu", log->late, told);
    for (size_t r = 0; r < flow->tool.robot_count; ++r) {
        int64_t sum_us = 0;
        for (size_t i = 0; i < WH_FLOW_ROBOT_CLASSES; ++i) {
            sum_us += (int64_t)figures.robots[r][i];
        }
        log_holds(log, sum_us == figures.end_us, "the classes of %s add up to another time",
                  flow->tool.robots[r].name);
    }
    for (size_t s = 0; s < flow->tool.station_count; ++s) {
        int64_t sum_us = 0;
        for (size_t i = 0; i < WH_FLOW_STATION_CLASSES; ++i) {
            sum_us += (int64_t)figures.stations[s][i];
        }
        log_holds(log, sum_us == figures.end_us * flow->tool.stations[s].slots,
                  "the classes of %s add up to another time", flow->tool.stations[s].name);
    }
    wh_flow_figures_close(&figures);
}

static void play_tool(random_tool_t *random, tally_t *tally) {
    flow_case_t *flow = &random->flow;
    const kind_t kind = random_in(3) ? BY_FUNCTION : random_in(3) ? BY_LISTS : BY_RULE;
    random_rule_t rule = {.seed = wh_test_random(), .is_bad = random_in(3), .stops = random_in(6) ? 4 : 0};
    static tool_log_t log;
    if (kind == BY_LISTS) {
        make_lists(flow);
    } else if (kind == BY_FUNCTION) {
        flow->plan.rule = WH_FLOW_OWN;
        flow->plan.own = answer;
        flow->plan.until_us =
            flow->plan.until_us == WH_FLOW_NEVER ? INT64_C(20000) * FLOW_S : flow->plan.until_us;
    }
    flow->plan.on_problem = hear_problem;
    flow->plan.own_context = &rule;
    const random_rule_t before = rule;
    const wh_flow_listener_t listener = {&log, hear, NULL, hear_end};
    wh_flow_result_t result;
    log_open(&log, flow);
    wh_flow_play(&flow->tool, &flow->plan, &listener, &result);
    const random_rule_t after = rule;
    rule = before;
    check_end(&log, &result, kind, &after);
    check_figures(&log, flow, &result);
    if (log.has_failed) {
        print_message("%s\n%s\n", log.text, result.why ? result.why : "");
        random_tell(flow);
    }
    assert_false(log.has_failed);
    ++tally->ends[result.end];
    tally->lost += result.lost;
    tally->late += log.late;
    wh_flow_result_close(&result);
}

static void nothing_breaks_and_all_is_told(void **unused) {
    (void)unused;
    tally_t tally = {.refused = 0};
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TOOLS, 1);
    while (wh_round(&rounds)) {
        random_tool_t random;
        random_open(&random);
        while (!random_plan(&random)) {
            flow_close(&random.flow);
            random_open(&random);
            ++tally.refused;
        }
        play_tool(&random, &tally);
        flow_close(&random.flow);
    }
    print_message("%d tools: %zu done, %zu stuck, %zu broken, %zu cut (%zu plans refused); %zu wafers lost, "
                  "%zu stays too long\n",
                  rounds.made, tally.ends[WH_FLOW_DONE], tally.ends[WH_FLOW_STUCK],
                  tally.ends[WH_FLOW_BROKEN], tally.ends[WH_FLOW_CUT], tally.refused, tally.lost, tally.late);
    assert_true(tally.ends[WH_FLOW_DONE] > (size_t)rounds.made / 3);
    assert_true(tally.ends[WH_FLOW_STUCK] > 0 && tally.ends[WH_FLOW_BROKEN] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_breaks_and_all_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
