/* Real robots in random tools. If each action takes just as long as that of a timed robot, all that is
 * told is the same to the last microsecond. If actions and doors take as long as they like, no place ever
 * has two wafers, none is taken before it is done, no two blades are in one station, and each flow ends
 * done or STUCK. Requests that hold robots change nothing of that, and the time for which these stand is told. */
#include "flow/figures.h"
#include "flow/held.h"
#include "flow/outside.h"
#include "support/flow.h"

#define TOOLS 4000
#define LEAST 100

/* ------------------------------------------------------------------------------------------------ tools */

static int64_t random_us(double least_s, double most_s) {
    return FLOW_S * (int64_t)wh_test_uniform(least_s, most_s + 1);
}

/* Without pressures both robots may want a buffer at once. */
static void draw_stations(wh_flow_tool_t *tool, bool has_doors, bool has_pressures) {
    for (int32_t s = 0; s < (int32_t)tool->station_count; ++s) {
        wh_flow_station_t *station = &tool->stations[s];
        if (station->name[0] == 'P') {
            station->process_us = random_us(0, 60);
            station->clean_us = random_us(3, 40);
            station->clean_after = (int32_t)wh_test_below(4);
        }
        if (station->name[0] == 'L' && has_pressures) {
            station->is_lock = true;
            for (int i = 0; i < 2; ++i) {
                station->pump_us[i] = random_us(2, 30);
                station->empty_pump_us[i] = random_us(1, 30);
            }
            tool->sides[wh_flow_of(tool, 0, s)] = WH_FLOW_ATMOSPHERE;
            tool->sides[wh_flow_of(tool, 1, s)] = WH_FLOW_VACUUM;
        }
        for (int32_t r = 0; has_doors && r < (int32_t)tool->robot_count; ++r) {
            tool->doors[wh_flow_of(tool, r, s)] = (wh_flow_door_t){random_us(1, 3), random_us(1, 3), false};
        }
    }
}

static void draw_flow(flow_case_t *flow) {
    static const char *const inner[] = {"P1", "P1>P2", "P1|P2>P3", "P1|P2|P3", "P1>P2|P3", "P1>P2>P1"};
    static const wh_flow_rule_t rules[] = {WH_FLOW_BACKWARD, WH_FLOW_SWAPPING, WH_FLOW_FIRST_COME,
                                           WH_FLOW_LONGEST_WAIT};
    const bool has_locks = wh_test_below(2) == 0, has_two = wh_test_below(2) == 0;
    char route[100];
    if (has_locks) {
        flow_open(flow, has_two ? "A V*2" : "A V", "H*30 O*30 LA*2 LB P1 P2 P3");
    } else {
        flow_open(flow, has_two ? "A*2" : "A", "H*30 O*30 P1 P2 P3");
    }
    for (size_t i = 0; i < flow->tool.robot_count; ++i) {
        const bool is_inside = i == 1;
        flow_robot(flow, flow->tool.robots[i].name,
                   is_inside   ? "LA LB P1 P2 P3"
                   : has_locks ? "H O LA LB"
                               : "H O P1 P2 P3",
                   (double)(1 + wh_test_below(5)), (double)(1 + wh_test_below(5)),
                   (double)(1 + wh_test_below(4)), 0);
    }
    draw_stations(&flow->tool, wh_test_below(2) == 0, wh_test_below(2) == 0);
    (void)snprintf(route, sizeof route, "H>%s%s%s>O", has_locks ? "LA|LB>" : "", inner[wh_test_below(6)],
                   has_locks ? ">LA|LB" : "");
    flow_lot(flow, route, 1 + (int32_t)wh_test_below(9), 1, 0);
    flow->plan.rule = rules[wh_test_below(4)];
    flow->plan.takt_us = wh_test_below(3) == 0 ? random_us(20, 200) : 0;
    flow_finish(flow);
}

/* ---------------------------------------------------------------------------------------------- playing */

/* The player of what is real: when each robot's action ends, and each station's door is shut. */
typedef struct {
    wh_flow_engine_t *engine;
    bool is_free; /* actions take as long as they like */
    int64_t ends_us[2], shut_us[16];
} player_t;

/* A request that holds a robot: when the next one comes or ends; when the robot stands within its
 * action, whose rest is to come then; and for how long it has done nothing for it. */
typedef struct {
    bool is_on, stands;
    int64_t change_us, stands_us, left_us, waited_us;
} hold_t;

static void hear_nothing(void *context, wh_flow_state_t *state) {
    (void)context;
    (void)state;
}

static int64_t length_of(const player_t *player, const wh_flow_tool_t *timed, int32_t robot) {
    const wh_flow_robot_state_t *at = &player->engine->state.robots[robot];
    const size_t of = wh_flow_of(timed, robot, at->station);
    if (player->is_free) {
        return (int64_t)wh_test_below(8000000);
    }
    switch (at->action) {
    case WH_FLOW_MOVING:
    case WH_FLOW_CARRYING:
        return wh_flow_move_us(timed, robot, at->from, at->station);
    case WH_FLOW_OPENING:
        return timed->doors[of].open_us;
    case WH_FLOW_PICKING:
        return timed->pick_us[of];
    case WH_FLOW_PLACING:
        return timed->place_us[of];
    case WH_FLOW_SWAPS:
        return timed->swap_us[of];
    case WH_FLOW_IDLE:
    case WH_FLOW_WAITING:
    default:
        return 0;
    }
}

/* Takes up what has begun. */
static void take_up(player_t *player, const wh_flow_tool_t *timed) {
    wh_flow_state_t *state = &player->engine->state;
    for (int32_t r = 0; r < (int32_t)timed->robot_count; ++r) {
        wh_flow_robot_state_t *at = &state->robots[r];
        if (at->is_begun && at->action != WH_FLOW_IDLE && at->action != WH_FLOW_WAITING) {
            at->is_begun = false;
            player->ends_us[r] = state->now_us + length_of(player, timed, r);
        }
    }
    for (size_t s = 0; s < timed->station_count; ++s) {
        if (state->stations[s].real.is_shutting && player->shut_us[s] == WH_FLOW_NEVER) {
            player->shut_us[s] = state->now_us + (int64_t)wh_test_below(3000000);
        }
    }
}

static int64_t sooner(int64_t a_us, int64_t b_us) {
    return a_us < b_us ? a_us : b_us;
}

/* ---------------------------------------------------------------------------------------------- holding */

/* The rest of its action comes after the request. */
static void stand(player_t *player, hold_t *hold, int32_t robot, int64_t now_us) {
    hold->stands = true;
    hold->stands_us = WH_FLOW_NEVER;
    hold->left_us = player->ends_us[robot] - now_us;
    player->ends_us[robot] = WH_FLOW_NEVER;
    wh_flow_tell_standing(&player->engine->state, robot);
}

/* A robot that is held ends its segment, which is a part of its action. */
static void begin_hold(const player_t *player, hold_t *hold, int32_t robot, int64_t now_us) {
    const int64_t ends_us = player->ends_us[robot];
    hold->is_on = true;
    hold->stands_us = ends_us > now_us && ends_us < WH_FLOW_FOR_EVER
                          ? now_us + (int64_t)wh_test_below((uint32_t)(ends_us - now_us))
                          : WH_FLOW_NEVER;
    hold->change_us = now_us + 1 + (int64_t)wh_test_below(30000000);
    wh_flow_tell_hold(&player->engine->state, robot, true);
}

static void end_hold(player_t *player, hold_t *hold, int32_t robot, int64_t now_us) {
    if (hold->stands) {
        player->ends_us[robot] = now_us + hold->left_us;
    }
    hold->is_on = hold->stands = false;
    hold->stands_us = WH_FLOW_NEVER;
    hold->change_us = now_us + 1 + (int64_t)wh_test_below(200000000);
    wh_flow_tell_hold(&player->engine->state, robot, false);
}

/* Requests come and end at this time, unless nothing is to come any more. */
static void hold_robots(player_t *player, hold_t holds[2], size_t robots, int64_t now_us) {
    for (int32_t r = 0; now_us != WH_FLOW_NEVER && r < (int32_t)robots; ++r) {
        if (holds[r].change_us == now_us && holds[r].is_on) {
            end_hold(player, &holds[r], r, now_us);
        } else if (holds[r].change_us == now_us) {
            begin_hold(player, &holds[r], r, now_us);
        }
        if (holds[r].stands_us == now_us) {
            stand(player, &holds[r], r, now_us);
        }
    }
}

/* An action that has begun while its robot is held stands at once; the flow hears of it at this instant. */
static bool stand_at_once(player_t *player, hold_t holds[2], size_t robots, int64_t now_us) {
    bool is_any = false;
    for (int32_t r = 0; r < (int32_t)robots; ++r) {
        const bool has_begun = player->ends_us[r] != WH_FLOW_NEVER;
        const bool opens = player->engine->state.robots[r].action == WH_FLOW_OPENING;
        if (holds[r].is_on && has_begun && !opens && holds[r].stands_us == WH_FLOW_NEVER) {
            stand(player, &holds[r], r, now_us);
            is_any = true;
        }
    }
    return is_any;
}

static void count_waits(const player_t *player, hold_t holds[2], size_t robots, int64_t us) {
    for (size_t r = 0; r < robots; ++r) {
        const wh_flow_action_t action = player->engine->state.robots[r].action;
        const bool rests = action == WH_FLOW_IDLE || action == WH_FLOW_WAITING;
        holds[r].waited_us += holds[r].is_on && (rests || holds[r].stands) ? us : 0;
    }
}

/* ----------------------------------------------------------------------------------------- to the end */

/* Tells all that ends at this time. */
static void tell_ends(player_t *player, const wh_flow_tool_t *timed, int64_t now_us) {
    for (int32_t r = 0; r < (int32_t)timed->robot_count; ++r) {
        if (player->ends_us[r] == now_us) {
            player->ends_us[r] = WH_FLOW_NEVER;
            wh_flow_tell_end(&player->engine->state, r);
        }
    }
    for (int32_t s = 0; s < (int32_t)timed->station_count; ++s) {
        if (player->shut_us[s] == now_us) {
            player->shut_us[s] = WH_FLOW_NEVER;
            wh_flow_tell_shut(&player->engine->state, s);
        }
    }
}

/* When something ends, the engine's next instant is, or a request comes. None comes to a flow that nobody goes on with. */
static int64_t next_of(const player_t *player, const hold_t holds[2], const wh_flow_tool_t *timed,
                       int64_t next_us) {
    int64_t change_us = WH_FLOW_NEVER;
    bool is_any_on = false;
    for (size_t i = 0; i < timed->robot_count; ++i) {
        next_us = sooner(next_us, player->ends_us[i]);
        next_us = sooner(next_us, holds[i].stands_us);
        change_us = sooner(change_us, holds[i].change_us);
        is_any_on = is_any_on || holds[i].is_on;
    }
    for (size_t s = 0; s < timed->station_count; ++s) {
        next_us = sooner(next_us, player->shut_us[s]);
    }
    return is_any_on || next_us < WH_FLOW_FOR_EVER ? sooner(next_us, change_us) : next_us;
}

/* To the flow's end; an action of no time ends at its instant. */
static void play(player_t *player, const wh_flow_tool_t *timed, hold_t holds[2]) {
    int64_t now_us = 0;
    for (size_t i = 0; i < 2; ++i) {
        player->ends_us[i] = WH_FLOW_NEVER;
    }
    for (size_t s = 0; s < 16; ++s) {
        player->shut_us[s] = WH_FLOW_NEVER;
    }
    while (!player->engine->is_over) {
        int64_t next_us = wh_flow_engine_step(player->engine, now_us);
        take_up(player, timed);
        if (!player->engine->is_over && stand_at_once(player, holds, timed->robot_count, now_us)) {
            continue;
        }
        next_us = next_of(player, holds, timed, next_us);
        assert_true(player->engine->is_over || next_us < WH_FLOW_FOR_EVER);
        count_waits(player, holds, timed->robot_count, player->engine->is_over ? 0 : next_us - now_us);
        now_us = next_us;
        tell_ends(player, timed, now_us);
        hold_robots(player, holds, timed->robot_count, now_us);
    }
}

/* A tool alike, whose robots are real; with `is_free` its doors are, too, and nothing is known of its
 * times. */
static void make_real(wh_flow_tool_t *real, const wh_flow_tool_t *timed, bool is_free) {
    wh_flow_tool_copy(real, timed);
    for (size_t r = 0; r < real->robot_count; ++r) {
        real->robots[r].is_real = true;
    }
    const size_t pairs = real->robot_count * real->station_count;
    for (size_t i = 0; i < pairs && is_free; ++i) {
        real->doors[i] = (wh_flow_door_t){0, 0, real->doors[i].open_us > 0};
        real->pick_us[i] = real->place_us[i] = real->swap_us[i] = 0;
    }
    for (size_t i = 0; i < pairs * real->station_count && is_free; ++i) {
        real->move_us[i] = 0;
    }
}

/* ----------------------------------------------------------------------------------------------- claims */

#define NO_HOLD                                                                                              \
    { false, false, WH_FLOW_NEVER, WH_FLOW_NEVER, 0, 0 }

static hold_t draw_hold(void) {
    hold_t hold = NO_HOLD;
    hold.change_us = wh_test_below(2) == 0 ? (int64_t)wh_test_below(100000000) + 1 : WH_FLOW_NEVER;
    return hold;
}

static void real_robots_do_as_timed_ones(void **unused) {
    (void)unused;
    size_t done = 0;
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TOOLS, 0.8);
    while (wh_round(&rounds)) {
        flow_case_t flow;
        wh_flow_figures_t timed, real;
        wh_flow_tool_t tool;
        draw_flow(&flow);
        wh_flow_measure(&flow.tool, &flow.plan, WH_FLOW_VISITS, &timed);
        make_real(&tool, &flow.tool, false);
        const wh_flow_outside_t outside = {NULL, hear_nothing, hear_nothing, NULL, NULL, &tool, 1};
        wh_flow_measure_t *measure = wh_flow_measure_open(&tool, &flow.plan, WH_FLOW_VISITS, &outside, &real);
        player_t player = {wh_flow_measure_engine(measure), false, {0}, {0}};
        hold_t none[2] = {NO_HOLD, NO_HOLD};
        play(&player, &flow.tool, none);
        wh_flow_measure_close(measure);
        assert_int_equal(timed.result.end, real.result.end);
        assert_int_equal(timed.result.makespan_us, real.result.makespan_us);
        assert_int_equal(timed.hash, real.hash);
        done += timed.result.end == WH_FLOW_DONE;
        wh_flow_figures_close(&timed);
        wh_flow_figures_close(&real);
        wh_flow_tool_close(&tool);
        flow_close(&flow);
    }
    assert_true(done > (size_t)rounds.made / 2);
}

/* Wafers and blades, by what is told alone. */
typedef struct {
    int32_t wafers[100];  /* by place */
    int64_t done_us[100]; /* by wafer: the end of its process */
    int64_t free_us[16];  /* by station: the end of the last blade's stay */
    size_t placed;
} seen_t;

static bool takes(const wh_flow_event_t *event) {
    return event->kind == WH_FLOW_EVENT_PICK || event->kind == WH_FLOW_EVENT_SWAP;
}

/* The wafer lies there and is done; those in their first places are not told. */
static void hear_taking(seen_t *seen, const wh_flow_event_t *event) {
    assert_int_equal(seen->wafers[event->place], event->step == 0 ? WH_FLOW_NONE : event->wafer);
    assert_true(seen->done_us[event->wafer] <= event->begin_us);
    seen->wafers[event->place] = WH_FLOW_NONE;
}

static void hear_placing(seen_t *seen, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    const int32_t wafer = event->kind == WH_FLOW_EVENT_SWAP ? event->other : event->wafer;
    const int64_t process_us = state->tool->stations[event->station].process_us;
    assert_int_equal(seen->wafers[event->place], WH_FLOW_NONE);
    seen->wafers[event->place] = wafer;
    seen->done_us[wafer] = process_us > 0 ? WH_FLOW_NEVER : 0;
    ++seen->placed;
}

static void hear(void *context, const wh_flow_state_t *state, const wh_flow_event_t *event) {
    seen_t *seen = context;
    const bool brings = event->kind == WH_FLOW_EVENT_PLACE || event->kind == WH_FLOW_EVENT_SWAP;
    assert_true(event->kind == WH_FLOW_EVENT_STAY || event->end_us <= state->now_us);
    if (event->kind == WH_FLOW_EVENT_PROCESS) {
        seen->done_us[event->wafer] = event->end_us;
    }
    if (takes(event) || brings) {
        assert_true(event->begin_us >= seen->free_us[event->station]);
        seen->free_us[event->station] = event->end_us;
    }
    if (takes(event)) {
        hear_taking(seen, event);
    }
    if (brings) {
        hear_placing(seen, state, event);
    }
}

static void real_robots_break_nothing(void **unused) {
    (void)unused;
    size_t done = 0;
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TOOLS, 0.8);
    while (wh_round(&rounds)) {
        flow_case_t flow;
        wh_flow_tool_t tool;
        wh_flow_engine_t engine;
        wh_flow_result_t result;
        seen_t seen = {.placed = 0};
        for (size_t i = 0; i < 100; ++i) {
            seen.wafers[i] = WH_FLOW_NONE;
        }
        draw_flow(&flow);
        make_real(&tool, &flow.tool, true);
        const wh_flow_outside_t outside = {NULL, hear_nothing, hear_nothing, NULL, NULL, &tool, 1};
        const wh_flow_listener_t listener = {&seen, hear, NULL, NULL};
        wh_flow_engine_open(&engine, &tool, &flow.plan, &listener, &outside);
        player_t player = {&engine, true, {0}, {0}};
        hold_t holds[2] = {draw_hold(), draw_hold()};
        play(&player, &flow.tool, holds);
        wh_flow_engine_result(&engine, &result);
        assert_true(result.end == WH_FLOW_DONE || result.end == WH_FLOW_STUCK);
        if (result.end == WH_FLOW_DONE) {
            assert_int_equal(seen.placed, flow.plan.wafer_count * (flow.plan.routes[0].step_count - 1));
            ++done;
        }
        wh_flow_result_close(&result);
        wh_flow_engine_close(&engine);
        wh_flow_tool_close(&tool);
        flow_close(&flow);
    }
    assert_true(done > (size_t)rounds.made / 2);
}

/* All time of a robot is told, and so is each part of the critical path; a robot that is held waits for nothing
 * else. */
static void time_of_robots_that_are_held_is_told(void **unused) {
    (void)unused;
    int64_t waited_us = 0;
    wh_rounds_t rounds = WH_ROUNDS(LEAST, TOOLS, 0.8);
    while (wh_round(&rounds)) {
        flow_case_t flow;
        wh_flow_tool_t tool;
        wh_flow_figures_t figures;
        draw_flow(&flow);
        make_real(&tool, &flow.tool, true);
        const wh_flow_outside_t outside = {NULL, hear_nothing, hear_nothing, NULL, NULL, &tool, 1};
        wh_flow_measure_t *measure =
            wh_flow_measure_open(&tool, &flow.plan, WH_FLOW_VISITS, &outside, &figures);
        player_t player = {wh_flow_measure_engine(measure), true, {0}, {0}};
        hold_t holds[2] = {draw_hold(), draw_hold()};
        play(&player, &flow.tool, holds);
        wh_flow_measure_close(measure);
        int64_t parts_us = 0;
        for (size_t i = 0; i < figures.part_count; ++i) {
            assert_true(figures.parts[i].us > 0);
            parts_us += figures.parts[i].us;
        }
        assert_int_equal(parts_us, figures.part_count > 0 ? figures.result.makespan_us : 0);
        for (size_t r = 0; r < tool.robot_count; ++r) {
            int64_t all_us = 0;
            for (size_t i = 0; i < WH_FLOW_ROBOT_CLASSES; ++i) {
                all_us += (int64_t)figures.robots[r][i];
            }
            assert_int_equal(all_us, figures.end_us);
            assert_int_equal((int64_t)figures.robots[r][WH_FLOW_ROBOT_WAITS_DOWN], holds[r].waited_us);
            waited_us += holds[r].waited_us;
        }
        wh_flow_figures_close(&figures);
        wh_flow_tool_close(&tool);
        flow_close(&flow);
    }
    assert_true(waited_us > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(real_robots_do_as_timed_ones),
                                       cmocka_unit_test(real_robots_break_nothing),
                                       cmocka_unit_test(time_of_robots_that_are_held_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
