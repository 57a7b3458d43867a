#include "play.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

#define NO_ROW SIZE_MAX

/* A wafer's way from one place to the next. */
typedef struct {
    size_t take_row, put_row; /* NO_ROW: not yet */
    int32_t wafer;
    int64_t process_us; /* of its rows where it lies behind it; WH_FLOW_NONE: of none */
} leg_t;

/* A row or a wafer, and its time. */
typedef struct {
    int64_t us, end_us;
    size_t number;
} timed_t;

typedef struct {
    wh_schedule_play_t *play;
    const wh_schedule_t *schedule;
    const wh_flow_tool_t *tool;
    timed_t *order; /* rows by their begin */
    leg_t *legs;    /* by wafer, in their order */
    size_t *first;  /* by wafer, its first leg; one more at the end */
    size_t *done;   /* by wafer: legs so far */
    int64_t *comes_us;
    int32_t *recipes;  /* by wafer: the tool's */
    int32_t *homes;    /* by wafer: a place of the tool, or WH_FLOW_NONE */
    int32_t *numbers;  /* by the schedule's wafer: the plan's, or WH_FLOW_NONE */
    int32_t *accesses; /* by station: rows so far that reach into it */
    bool *has_pumps;   /* by station: rows tell of them */
    wh_schedule_names_t routes;
} maker_t;

static int by_time(const void *a, const void *b) {
    const timed_t *one = a, *other = b;
    if (one->us != other->us) {
        return one->us < other->us ? -1 : 1;
    }
    if (one->end_us != other->end_us) {
        return one->end_us < other->end_us ? -1 : 1;
    }
    return one->number < other->number ? -1 : 1;
}

static int32_t station_of(const maker_t *maker, int32_t station) {
    return wh_flow_station_named(maker->tool, maker->schedule->stations.texts[station]);
}

static int32_t place_of(const maker_t *maker, const wh_schedule_row_t *row) {
    return maker->tool->stations[station_of(maker, row->station)].first_place + row->slot - 1;
}

static bool refuse_row(maker_t *maker, size_t row, const char *what) {
    (void)snprintf(maker->play->message, sizeof maker->play->message, "%.200s:%zu: %s", maker->schedule->path,
                   maker->schedule->rows[row].line, what);
    return false;
}

/* --------------------------------------------------------------------------------------------------- legs */

/* The wafer that a row takes out of a place, and the one that it puts into one. */
static int32_t taken_by(const wh_schedule_row_t *row) {
    return row->action == WH_SCHEDULE_PICK   ? row->wafer
           : row->action == WH_SCHEDULE_SWAP ? row->wafer2
                                             : WH_FLOW_NONE;
}

static int32_t put_by(const wh_schedule_row_t *row) {
    return row->action == WH_SCHEDULE_PLACE || row->action == WH_SCHEDULE_SWAP ? row->wafer : WH_FLOW_NONE;
}

static void open_legs(maker_t *maker) {
    const wh_schedule_t *schedule = maker->schedule;
    const size_t wafers = schedule->wafers.count;
    maker->order = wh_array_new(schedule->count + 1, sizeof *maker->order);
    maker->first = wh_array_new(wafers + 2, sizeof *maker->first);
    maker->done = wh_array_new(wafers + 1, sizeof *maker->done);
    maker->comes_us = wh_array_new(wafers + 1, sizeof *maker->comes_us);
    maker->recipes = wh_array_new(wafers + 1, sizeof *maker->recipes);
    maker->homes = wh_array_new(wafers + 1, sizeof *maker->homes);
    maker->numbers = wh_array_new(wafers + 1, sizeof *maker->numbers);
    maker->accesses = wh_array_new(maker->tool->station_count, sizeof *maker->accesses);
    maker->has_pumps = wh_array_new(maker->tool->station_count, sizeof *maker->has_pumps);
    for (size_t i = 0; i < schedule->count; ++i) {
        const int32_t taken = taken_by(&schedule->rows[i]);
        maker->order[i] = (timed_t){schedule->rows[i].begin_us, schedule->rows[i].end_us, i};
        maker->first[taken == WH_FLOW_NONE ? wafers + 1 : (size_t)taken + 1] += 1;
    }
    maker->first[wafers + 1] = 0;
    for (size_t w = 0; w < wafers; ++w) {
        maker->first[w + 1] += maker->first[w];
        maker->homes[w] = maker->numbers[w] = WH_FLOW_NONE;
    }
    maker->legs = wh_array_new(maker->first[wafers] + 1, sizeof *maker->legs);
    qsort(maker->order, schedule->count, sizeof *maker->order, by_time);
}

static leg_t *last_leg(const maker_t *maker, int32_t wafer) {
    return maker->done[wafer] == 0 ? NULL : &maker->legs[maker->first[wafer] + maker->done[wafer] - 1];
}

/* The wafer comes into the place that its last leg goes to. */
static void end_leg(maker_t *maker, size_t number, int32_t wafer) {
    const wh_schedule_row_t *row = &maker->schedule->rows[number];
    wh_schedule_play_t *play = maker->play;
    if (last_leg(maker, wafer)) {
        last_leg(maker, wafer)->put_row = number;
        play->makespan_us = row->end_us > play->makespan_us ? row->end_us : play->makespan_us;
    }
}

static void begin_leg(maker_t *maker, size_t number, int32_t wafer) {
    if (maker->homes[wafer] == WH_FLOW_NONE) {
        maker->homes[wafer] = place_of(maker, &maker->schedule->rows[number]);
    }
    ++maker->done[wafer];
    *last_leg(maker, wafer) = (leg_t){number, NO_ROW, wafer, WH_FLOW_NONE};
}

static void add_process(leg_t *leg, int64_t us) {
    if (leg) {
        leg->process_us = (leg->process_us == WH_FLOW_NONE ? 0 : leg->process_us) + us;
    }
}

static void take_row(maker_t *maker, size_t number) {
    const wh_schedule_row_t *row = &maker->schedule->rows[number];
    if (row->action == WH_SCHEDULE_START) {
        maker->homes[row->wafer] = place_of(maker, row);
        maker->comes_us[row->wafer] = row->begin_us;
        maker->recipes[row->wafer] =
            row->recipe == 0 ? 0
                             : wh_flow_recipe_named(&maker->tool->recipes,
                                                    maker->schedule->recipes.texts[row->recipe - 1]);
    }
    if (put_by(row) != WH_FLOW_NONE) {
        end_leg(maker, number, put_by(row));
    }
    if (taken_by(row) != WH_FLOW_NONE) {
        begin_leg(maker, number, taken_by(row));
    }
    if (row->action == WH_SCHEDULE_PROCESS && row->wafer != WH_FLOW_NONE) {
        add_process(last_leg(maker, row->wafer), row->end_us - row->begin_us);
    }
    if (row->action == WH_SCHEDULE_PUMP) {
        maker->has_pumps[station_of(maker, row->station)] = true;
    }
    maker->play->actions += wh_schedule_is_access(row->action);
}

/* ------------------------------------------------------------------------------------------------- routes */

/* True if the layout's route leads the wafer through its first places up to leg `k`. */
static bool leads_along(const maker_t *maker, const wh_flow_route_t *route, int32_t wafer, size_t k) {
    for (size_t i = 0; i <= k; ++i) {
        const leg_t *leg = &maker->legs[maker->first[wafer] + i];
        const int32_t station = station_of(maker, maker->schedule->rows[leg->put_row].station);
        if (i + 1 >= route->step_count || !wh_flow_step_has(&route->steps[i + 1], station)) {
            return false;
        }
    }
    return true;
}

/* Where no rows tell of a process it is the layout's: of the shortest route that the wafer may go, else of
 * the station. */
static void find_processes(maker_t *maker, int32_t wafer) {
    for (size_t k = 0; k < maker->done[wafer]; ++k) {
        leg_t *leg = &maker->legs[maker->first[wafer] + k];
        const int32_t station = station_of(maker, maker->schedule->rows[leg->put_row].station);
        int64_t least_us = WH_FLOW_NONE;
        for (size_t r = 0; r < maker->tool->route_count && leg->process_us == WH_FLOW_NONE; ++r) {
            const wh_flow_route_t *route = &maker->tool->routes[r];
            if (leads_along(maker, route, wafer, k)) {
                const int64_t us = wh_flow_step_us(&route->steps[k + 1], &maker->tool->stations[station],
                                                   maker->recipes[wafer]);
                least_us = least_us == WH_FLOW_NONE || us < least_us ? us : least_us;
            }
        }
        leg->process_us = leg->process_us == WH_FLOW_NONE ? least_us : leg->process_us;
    }
}

/* The route's steps as a text, by which equal ones are found. The caller frees it. */
static char *route_text(const maker_t *maker, int32_t wafer) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = wh_memory_need(open_memstream(&text, &size));
    for (size_t i = maker->first[wafer]; i < maker->first[wafer] + maker->done[wafer]; ++i) {
        fprintf(out, "%d:%lld ", (int)maker->schedule->rows[maker->legs[i].put_row].station,
                (long long)maker->legs[i].process_us);
    }
    (void)fclose(out);
    return text;
}

static int32_t add_route(maker_t *maker, int32_t wafer) {
    wh_flow_plan_t *plan = &maker->play->plan;
    char *text = route_text(maker, wafer), name[32];
    const size_t known = maker->routes.count;
    const int32_t number = wh_schedule_name(&maker->routes, text);
    free(text);
    if (maker->routes.count == known) {
        return number;
    }
    plan->routes = wh_memory_need(realloc(plan->routes, (plan->route_count + 1) * sizeof *plan->routes));
    wh_flow_route_t *route = &plan->routes[plan->route_count++];
    (void)snprintf(name, sizeof name, "%d", (int)number + 1);
    *route = (wh_flow_route_t){.name = wh_text_copy(name),
                               .steps = wh_array_new(maker->done[wafer] + 2, sizeof *route->steps),
                               .step_count = maker->done[wafer] + 1};
    for (size_t k = 1; k < route->step_count; ++k) {
        const leg_t *leg = &maker->legs[maker->first[wafer] + k - 1];
        wh_flow_step_t *step = &route->steps[k];
        step->stations = wh_array_new(1, sizeof *step->stations);
        step->stations[0] = station_of(maker, maker->schedule->rows[leg->put_row].station);
        step->station_count = 1;
        step->process_us = k + 1 == route->step_count ? 0 : leg->process_us;
    }
    return number;
}

/* Each wafer that is carried is a lot of its own. */
static bool add_wafers(maker_t *maker) {
    wh_flow_plan_t *plan = &maker->play->plan;
    const size_t count = maker->schedule->wafers.count;
    timed_t *wafers = wh_array_new(count + 1, sizeof *wafers);
    bool good = true;
    for (int32_t w = 0; w < (int32_t)count && good; ++w) {
        const leg_t *last = last_leg(maker, w);
        maker->play->resting += last == NULL;
        if (last && last->put_row == NO_ROW) {
            good =
                refuse_row(maker, last->take_row, "the wafer is left aboard (expected a place for each one)");
        } else if (last) {
            find_processes(maker, w);
            wafers[maker->play->wafers++] = (timed_t){maker->comes_us[w], 0, (size_t)w};
        }
    }
    plan->lots = wh_array_new(maker->play->wafers + 1, sizeof *plan->lots);
    plan->wafers = wh_array_new(maker->play->wafers + 1, sizeof *plan->wafers);
    qsort(wafers, maker->play->wafers, sizeof *wafers, by_time);
    for (size_t i = 0; i < maker->play->wafers && good; ++i) {
        const int32_t w = (int32_t)wafers[i].number;
        plan->lots[i] = (wh_flow_lot_t){.name = wh_text_copy(""),
                                        .route = add_route(maker, w),
                                        .arrives_us = maker->comes_us[w],
                                        .first_wafer = i,
                                        .wafer_count = 1};
        plan->wafers[i] =
            (wh_flow_wafer_t){.name = wh_text_copy(maker->schedule->wafers.texts[w]),
                              .lot = (int32_t)i,
                              .home = maker->homes[w],
                              .back = place_of(maker, &maker->schedule->rows[last_leg(maker, w)->put_row]),
                              .back_station = WH_FLOW_NONE,
                              .recipe = maker->recipes[w]};
        maker->numbers[w] = (int32_t)i;
        plan->lot_count = plan->wafer_count = i + 1;
    }
    free(wafers);
    return good;
}

/* -------------------------------------------------------------------------------------------------- lists */

static void add_line(maker_t *maker, const wh_schedule_row_t *row) {
    const int32_t robot =
        wh_flow_robot_named(maker->tool, wh_schedule_text(&maker->schedule->robots, row->robot));
    wh_flow_list_t *list = &maker->play->plan.lists[robot];
    const int32_t station = station_of(maker, row->station);
    const bool is_pick = row->action == WH_SCHEDULE_PICK;
    list->lines = wh_array_grow(list->lines, list->count, &list->capacity, sizeof *list->lines);
    list->lines[list->count++] =
        (wh_flow_line_t){.what = is_pick                            ? WH_FLOW_KEEP
                                 : row->action == WH_SCHEDULE_PLACE ? WH_FLOW_BRING
                                                                    : WH_FLOW_SWAP,
                         .from = is_pick ? station : WH_FLOW_NONE,
                         .to = is_pick ? WH_FLOW_NONE : station,
                         .wafer = maker->numbers[row->wafer],
                         .out = row->wafer2 == WH_FLOW_NONE ? WH_FLOW_NONE : maker->numbers[row->wafer2],
                         .slot = row->slot,
                         .behind = maker->accesses[station]++,
                         .side = WH_FLOW_BOTH};
}

static void add_turn(maker_t *maker, int32_t lock, wh_flow_side_t side) {
    wh_flow_turns_t *list = &maker->play->plan.turns[lock];
    list->turns = wh_array_grow(list->turns, list->count, &list->capacity, sizeof *list->turns);
    list->turns[list->count++] = (wh_flow_turn_t){side, maker->accesses[lock]};
}

/* A lock without pumps among its rows turns when a robot of the other side comes. */
static void add_turn_before(maker_t *maker, const wh_schedule_row_t *row) {
    const int32_t lock = station_of(maker, row->station);
    const wh_flow_turns_t *list = &maker->play->plan.turns[lock];
    const int32_t robot =
        wh_flow_robot_named(maker->tool, wh_schedule_text(&maker->schedule->robots, row->robot));
    const wh_flow_side_t side = maker->tool->sides[wh_flow_of(maker->tool, robot, lock)];
    const wh_flow_side_t has =
        list->count > 0 ? list->turns[list->count - 1].side : maker->tool->stations[lock].side;
    if (maker->tool->stations[lock].is_lock && !maker->has_pumps[lock] && !wh_flow_sides_agree(side, has)) {
        add_turn(maker, lock, side);
    }
}

/* The rows of a station come one after another, whichever robots they are: so nobody waits in a circle. */
static void add_lists(maker_t *maker) {
    wh_flow_plan_t *plan = &maker->play->plan;
    plan->rule = WH_FLOW_LISTS;
    plan->is_given = true;
    plan->lists = wh_array_new(maker->tool->robot_count, sizeof *plan->lists);
    plan->turns = wh_array_new(maker->tool->station_count, sizeof *plan->turns);
    plan->until_us = WH_FLOW_NEVER;
    for (size_t i = 0; i < maker->schedule->count; ++i) {
        const wh_schedule_row_t *row = &maker->schedule->rows[maker->order[i].number];
        if (wh_schedule_is_access(row->action)) {
            add_turn_before(maker, row);
            add_line(maker, row);
        } else if (row->action == WH_SCHEDULE_PUMP) {
            add_turn(maker, station_of(maker, row->station), row->side);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ compare */

static void compare(wh_schedule_play_t *play, const wh_schedule_t *schedule, size_t row, int64_t played_us) {
    const int64_t begin_us = schedule->rows[row].begin_us;
    const int64_t apart_us = played_us > begin_us ? played_us - begin_us : begin_us - played_us;
    ++play->played;
    if (apart_us <= WH_SCHEDULE_INSTANT_US) {
        return;
    }
    ++play->differing;
    if (play->first_row == NO_ROW || begin_us < schedule->rows[play->first_row].begin_us) {
        play->first_row = row;
        play->first_us = played_us;
    }
    const int64_t widest_us =
        play->widest_row == NO_ROW ? 0 : llabs(play->widest_us - schedule->rows[play->widest_row].begin_us);
    if (apart_us > widest_us) {
        play->widest_row = row;
        play->widest_us = played_us;
    }
}

/* A swap is one row: it is compared where its wafer goes in. */
static void compare_all(const maker_t *maker) {
    wh_schedule_play_t *play = maker->play;
    int32_t *wafers = wh_array_new(play->wafers + 1, sizeof *wafers);
    for (int32_t w = 0; w < (int32_t)maker->schedule->wafers.count; ++w) {
        if (maker->numbers[w] != WH_FLOW_NONE) {
            wafers[maker->numbers[w]] = w;
        }
    }
    for (size_t i = 0; i < play->figures.visit_count; ++i) {
        const wh_flow_visit_t *visit = &play->figures.visits[i];
        const leg_t *leg = &maker->legs[maker->first[wafers[visit->wafer]] + (size_t)visit->step - 1];
        if (maker->schedule->rows[leg->take_row].action == WH_SCHEDULE_PICK) {
            compare(play, maker->schedule, leg->take_row, visit->pick_us);
        }
        if (visit->placed_us != WH_FLOW_NEVER) {
            compare(play, maker->schedule, leg->put_row, visit->place_us);
        }
    }
    free(wafers);
}

/* -------------------------------------------------------------------------------------------------- whole */

static bool make_plan(maker_t *maker) {
    wh_schedule_play_t *play = maker->play;
    open_legs(maker);
    for (size_t i = 0; i < maker->schedule->count; ++i) {
        take_row(maker, maker->order[i].number);
    }
    if (!add_wafers(maker)) {
        return false;
    }
    if (play->wafers == 0) {
        (void)snprintf(play->message, sizeof play->message, "%.200s: no wafer is carried",
                       maker->schedule->path);
        return false;
    }
    add_lists(maker);
    char *problem = wh_flow_plan_finish(&play->plan, maker->tool);
    if (problem) {
        (void)snprintf(play->message, sizeof play->message, "%.200s: %.380s", maker->schedule->path, problem);
        free(problem);
        return false;
    }
    return true;
}

static void close_maker(maker_t *maker) {
    for (size_t i = 0; i < maker->routes.count; ++i) {
        free(maker->routes.texts[i]);
    }
    free(maker->routes.texts);
    free(maker->routes.slots);
    free(maker->order);
    free(maker->legs);
    free(maker->first);
    free(maker->done);
    free(maker->comes_us);
    free(maker->recipes);
    free(maker->homes);
    free(maker->numbers);
    free(maker->accesses);
    free(maker->has_pumps);
}

bool wh_schedule_play(wh_schedule_play_t *play, const wh_schedule_t *schedule, const wh_flow_tool_t *tool) {
    maker_t maker = {.play = play, .schedule = schedule, .tool = tool};
    play->first_row = play->widest_row = NO_ROW;
    const bool good = make_plan(&maker);
    if (good) {
        wh_flow_measure(tool, &play->plan, WH_FLOW_VISITS, &play->figures);
        compare_all(&maker);
        play->is_played = true;
    }
    close_maker(&maker);
    return good;
}

void wh_schedule_play_close(wh_schedule_play_t *play, const wh_flow_tool_t *tool) {
    wh_flow_plan_close(&play->plan, tool);
    wh_flow_figures_close(&play->figures);
}
