/* A flow as JSON. Members: end (done, stuck, broken, cut), why, makespan_s, counted_s (of which shares are:
 * the makespan, the cut, or when nobody went on), wafers, cycle_s, period, per_hour, no_cycle (why there is
 * none), textbook (its cycle beside that, or why none), busiest (who has the least time to spare), may_block
 * (safe is not held), longest_stay_s, path (parts of the critical path, which add up to the makespan, the
 * longest first), gains (what the flow takes if one robot or station takes 10 % less time, and how many stays
 * are beyond windows then: late), waits (robots' by cause, done wafers' by who kept them), windows (by
 * station), gaps (the smallest ones of all), robots
 * and stations (shares of the time by class, which add up to 1; blocked_by by name, s), stays (beyond their
 * windows), lots (with their wafers), visits (each wafer's, by the end of placing; at last those under way,
 * with null for what has not come), doings (pumps, vents, cleans and failures of stations, by their ends),
 * ways (of robots, only where a page or a schedule asks for them). */
#include "record_print.h"

#include <math.h>
#include <stdlib.h>

#include "../flow/textbook.h"
#include "../flow/waits.h"
#include "../text/json.h"

static const char *const ends[] = {"done", "stuck", "broken", "cut"};

static json_t *seconds(int64_t us) {
    return us == WH_FLOW_NEVER ? json_null() : wh_json_real((double)us / 1e6);
}

static json_t *shares(const double times_us[], const char *const names[], size_t count, double all_us) {
    json_t *object = json_object();
    for (size_t i = 0; i < count; ++i) {
        wh_json_put(object, names[i], wh_json_real(all_us > 0 ? times_us[i] / all_us : 0));
    }
    return object;
}

static json_t *robot(const void *subject, size_t r) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_robot_t *of = &figures->tool->robots[r];
    return wh_json_add(
        wh_json_set(json_object(), "name %s begins_at %s begin_assumed %i", of->name,
                    of->at == WH_FLOW_NONE ? NULL : figures->tool->stations[of->at].name, of->is_at_assumed),
        "shares",
        shares(figures->robots[r], wh_flow_robot_class_names, WH_FLOW_ROBOT_CLASSES, (double)figures->end_us),
        NULL);
}

static json_t *blocked_by(const wh_flow_figures_t *figures, size_t s) {
    const wh_flow_tool_t *tool = figures->tool;
    json_t *object = json_object();
    for (size_t r = 0; r < tool->robot_count; ++r) {
        const double us = figures->blocked_by_robot[s * tool->robot_count + r];
        if (us > 0) {
            wh_json_put(object, tool->robots[r].name, wh_json_real(us / 1e6));
        }
    }
    for (size_t other = 0; other < tool->station_count; ++other) {
        const double us = figures->blocked_by_station[s * tool->station_count + other];
        if (us > 0) {
            wh_json_put(object, tool->stations[other].name, wh_json_real(us / 1e6));
        }
    }
    return object;
}

static json_t *station(const void *subject, size_t s) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_station_t *of = &figures->tool->stations[s];
    json_t *object = wh_json_set(json_object(), "name %s slots %d placed %lld", of->name, (int)of->slots,
                                 (long long)figures->placed[s]);
    return wh_json_add(object, "shares blocked_by",
                       shares(figures->stations[s], wh_flow_station_class_names, WH_FLOW_STATION_CLASSES,
                              (double)figures->end_us * of->slots),
                       blocked_by(figures, s), NULL);
}

static json_t *stay(const wh_flow_figures_t *figures, const wh_flow_stay_t *of) {
    return wh_json_set(json_object(), "wafer %s station %s done_s %g stay_s %g window_s %g gap_s %g",
                       figures->plan->wafers[of->wafer].name, figures->tool->stations[of->station].name,
                       (double)of->done_us / 1e6, (double)(of->taken_us - of->done_us) / 1e6,
                       (double)of->window_us / 1e6, (double)wh_flow_gap_us(of) / 1e6);
}

static json_t *late(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    return stay(figures, &figures->stays.late[i]);
}

static json_t *gap(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    return stay(figures, &figures->stays.nearest[i]);
}

static json_t *windows(const wh_flow_figures_t *figures) {
    json_t *list = json_array();
    for (size_t s = 0; s < figures->tool->station_count; ++s) {
        const wh_flow_window_t *of = &figures->stays.windows[s];
        const int64_t window_us = figures->tool->stations[s].window_us;
        if (window_us == WH_FLOW_NEVER) {
            continue;
        }
        json_t *object = wh_json_set(json_object(), "station %s window_s %g stays %lld late %lld",
                                     figures->tool->stations[s].name, (double)window_us / 1e6,
                                     (long long)of->count, (long long)of->late);
        wh_json_put(object, "nearest", of->count > 0 ? stay(figures, &of->nearest) : json_null());
        (void)json_array_append_new(list, object);
    }
    return list;
}

static json_t *lot_wafer(const wh_flow_figures_t *figures, size_t w) {
    const wh_flow_wafer_t *of = &figures->plan->wafers[w];
    const int32_t home = of->home;
    json_t *object = wh_json_set(json_object(), "name %s station %s slot %d", of->name,
                                 figures->tool->stations[figures->tool->place_stations[home]].name,
                                 (int)wh_flow_slot(figures->tool, home));
    wh_json_put(object, "fate", wh_json_text(wh_flow_fate_names[figures->fates[w]]));
    if (figures->tool->recipes.count > 0) {
        wh_json_put(object, "recipe",
                    wh_json_text(of->recipe > 0 ? figures->tool->recipes.names[of->recipe - 1] : NULL));
    }
    wh_json_put(object, "came_s", seconds(figures->came_us ? figures->came_us[w] : WH_FLOW_NEVER));
    return object;
}

static json_t *lot(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_lot_t *of = &figures->plan->lots[i];
    json_t *object = wh_json_set(json_object(), "name %s route %s arrives_s %g priority %d dummy %i",
                                 of->name, figures->plan->routes[of->route].name,
                                 (double)of->arrives_us / 1e6, (int)of->priority, of->is_dummy);
    json_t *list = json_array();
    for (size_t w = of->first_wafer; w < of->first_wafer + of->wafer_count; ++w) {
        (void)json_array_append_new(list, lot_wafer(figures, w));
    }
    wh_json_put(object, "wafers", list);
    return object;
}

static json_t *visit(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_tool_t *tool = figures->tool;
    const wh_flow_visit_t *of = &figures->visits[i];
    const bool is_there = of->place != WH_FLOW_NONE;
    json_t *object = wh_json_set(
        json_object(), "wafer %s step %d robot %s arm %d from %s from_slot %d to %s to_slot %lld",
        figures->plan->wafers[of->wafer].name, (int)of->step, tool->robots[of->robot].name, (int)of->arm + 1,
        tool->stations[tool->place_stations[of->from]].name, (int)wh_flow_slot(tool, of->from),
        is_there ? tool->stations[tool->place_stations[of->place]].name : NULL,
        is_there ? (long long)wh_flow_slot(tool, of->place) : WH_JSON_NONE);
    return wh_json_add(object, "pick_s picked_s place_s placed_s process_s done_s", seconds(of->pick_us),
                       seconds(of->picked_us), seconds(of->place_us), seconds(of->placed_us),
                       seconds(of->process_us), seconds(of->done_us), NULL);
}

static json_t *doing(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_doing_t *of = &figures->doings[i];
    const char *what = of->kind == WH_FLOW_EVENT_CLEAN   ? "clean"
                       : of->kind == WH_FLOW_EVENT_DOWN  ? "down"
                       : of->kind == WH_FLOW_EVENT_OPEN  ? "open"
                       : of->kind == WH_FLOW_EVENT_SHUT  ? "shut"
                       : of->kind == WH_FLOW_EVENT_COMES ? "comes"
                       : of->kind == WH_FLOW_EVENT_GOES  ? "goes"
                       : of->side == WH_FLOW_VACUUM      ? "pump"
                                                         : "vent";
    return wh_json_set(json_object(), "station %s slot %lld what %s begin_s %g end_s %g",
                       figures->tool->stations[of->station].name,
                       of->place == WH_FLOW_NONE ? WH_JSON_NONE
                                                 : (long long)wh_flow_slot(figures->tool, of->place),
                       what, (double)of->begin_us / 1e6, (double)of->end_us / 1e6);
}

static const char *name_of(const wh_flow_tool_t *tool, int32_t robot, int32_t station) {
    return robot != WH_FLOW_NONE     ? tool->robots[robot].name
           : station != WH_FLOW_NONE ? tool->stations[station].name
                                     : NULL;
}

static json_t *part(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_part_t *of = &figures->parts[i];
    return wh_json_set(json_object(), "of %s what %s seconds %g share %g",
                       name_of(figures->tool, of->robot, of->station), wh_flow_path_words[of->word],
                       (double)of->us / 1e6, (double)of->us / (double)figures->end_us);
}

static json_t *way(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_way_t *of = &figures->ways.items[i];
    return wh_json_set(json_object(), "robot %s from %s to %s begin_s %g end_s %g",
                       figures->tool->robots[of->robot].name, figures->tool->stations[of->from].name,
                       figures->tool->stations[of->to].name, (double)of->begin_us / 1e6,
                       (double)of->end_us / 1e6);
}

static json_t *waits(const wh_flow_figures_t *figures) {
    json_t *list = json_array();
    size_t count = 0;
    wh_flow_wait_t *all = wh_flow_waits(figures, &count);
    for (size_t i = 0; i < count; ++i) {
        const wh_flow_wait_t *of = &all[i];
        const char *cause = of->cause ? of->cause : name_of(figures->tool, of->robot, of->station);
        (void)json_array_append_new(list, wh_json_set(json_object(), "who %s cause %s seconds %g",
                                                      of->cause ? "robots" : "wafers", cause, of->us / 1e6));
    }
    free(all);
    return list;
}

/* limits: the robot, or the stations of the step, whose bound it is. */
static json_t *textbook(const wh_flow_figures_t *figures) {
    const wh_flow_textbook_t of = wh_flow_textbook(figures->tool, figures->plan);
    const double cycle_s = of.why ? (double)NAN : of.cycle_us / 1e6;
    json_t *object = wh_json_set(json_object(), "cycle_s %g per_hour %g", cycle_s, 3600 / cycle_s);
    wh_json_put(object, "why", of.why ? wh_json_text(of.why) : json_null());
    json_t *limits = json_array();
    const wh_flow_step_t *step = of.why || of.step == 0 ? NULL : &figures->plan->routes[0].steps[of.step];
    for (size_t k = 0; step && k < step->station_count; ++k) {
        (void)json_array_append_new(limits, wh_json_text(figures->tool->stations[step->stations[k]].name));
    }
    if (!of.why && of.step == 0) {
        (void)json_array_append_new(limits, wh_json_text(figures->tool->robots[0].name));
    }
    wh_json_put(object, "limits", limits);
    return object;
}

static json_t *busiest(const wh_flow_figures_t *figures) {
    const wh_flow_busy_t of = wh_flow_busiest(figures);
    return wh_json_set(json_object(), "of %s share %g", name_of(figures->tool, of.robot, of.station),
                       of.share);
}

static json_t *gain(const void *subject, size_t i) {
    const wh_flow_figures_t *figures = subject;
    const wh_flow_gain_t *of = &figures->gains[i];
    const double cycle_s = of->cycle_us > 0 ? of->cycle_us / 1e6 : (double)NAN;
    return wh_json_set(json_object(), "of %s end %s makespan_s %g cycle_s %g late %lld",
                       name_of(figures->tool, of->robot, of->station), ends[of->end],
                       (double)of->makespan_us / 1e6, cycle_s, (long long)of->late);
}

json_t *wh_flow_to_json(const wh_flow_t *flow) {
    const wh_flow_figures_t *figures = &flow->figures;
    const wh_flow_result_t *result = &figures->result;
    const double cycle_s = result->period > 0 ? (double)result->cycle_us / 1e6 / result->period : (double)NAN;
    json_t *object = wh_json_set(
        json_object(),
        "line %d end %s why %s wafers %lld left %lld makespan_s %g cycle_s %g period %lld per_hour %g",
        flow->line, ends[result->end], result->why, (long long)result->over, (long long)result->left,
        (double)result->makespan_us / 1e6, cycle_s,
        result->period > 0 ? (long long)result->period : WH_JSON_NONE, 3600 / cycle_s);
    if (result->is_steady) {
        wh_json_put(object, "ended_steady", json_true());
    }
    (void)wh_json_set(object, "no_cycle %s may_block %i counted_s %g began_s %g lost %lld skipped %lld",
                      result->no_cycle, result->may_block, (double)figures->end_us / 1e6,
                      (double)flow->began_us / 1e6, (long long)result->lost, (long long)result->skipped);
    const size_t gain_count = figures->gains ? figures->tool->robot_count + figures->tool->station_count : 0;
    (void)wh_json_add(object, "textbook busiest longest_stay_s path gains waits windows gaps",
                      textbook(figures), busiest(figures), seconds(figures->stays.longest_us),
                      wh_json_list(part, figures, figures->part_count),
                      wh_json_list(gain, figures, gain_count), waits(figures), windows(figures),
                      wh_json_list(gap, figures, figures->stays.nearest_count), NULL);
    (void)wh_json_add(object, "robots stations stays lots visits doings",
                      wh_json_list(robot, figures, figures->tool->robot_count),
                      wh_json_list(station, figures, figures->tool->station_count),
                      wh_json_list(late, figures, figures->stays.late_count),
                      wh_json_list(lot, figures, figures->plan->lot_count),
                      wh_json_list(visit, figures, figures->visit_count),
                      wh_json_list(doing, figures, figures->doing_count), NULL);
    if (figures->ways.items) {
        wh_json_put(object, "ways", wh_json_list(way, figures, figures->ways.count));
    }
    return object;
}
