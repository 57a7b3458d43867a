#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "best_internal.h"

/* The step by which a node came: a line of a robot's list, and the step before it. */
typedef struct {
    int32_t before, robot;
    wh_flow_line_t line;
} step_t;

typedef struct {
    node_t *nodes;
    size_t count, capacity;
} level_t;

/* A carry is two levels, a keep and what follows it one each: three levels are alive. */
#define LEVELS 3

typedef struct {
    problem_t problem;
    size_t width;
    level_t levels[LEVELS];
    step_t *steps;
    size_t step_count, step_capacity;
    int32_t last; /* step of the best schedule */
    wh_flow_best_t *best;
    int64_t left_out_us; /* the least bound of the nodes that had no room */
    bool is_relaxed;     /* see relax() */
} search_t;

/* -------------------------------------------------------------------------------------------------- nodes */

/* `tool` is the problem's. In stations without places nothing is exchanged. */
static bool is_swap_short(const wh_flow_tool_t *tool, size_t robot, size_t station) {
    const size_t of = wh_flow_of(tool, (int32_t)robot, (int32_t)station);
    return tool->serves[of] && tool->robots[robot].arms > 1 &&
           tool->stations[station].first_place != WH_BEST_PLACES &&
           tool->swap_us[of] < tool->pick_us[of] + tool->place_us[of];
}

/* An exchange with two arms may take less than a pick and a placing. No node has one. If picks and placings
 * are so much shorter that both together take no longer than it, they can stand in for each exchange: then
 * no schedule with exchanges is below the bound either. */
static void relax(wh_flow_tool_t *tool) {
    for (size_t r = 0; r < tool->robot_count; ++r) {
        for (size_t s = 0; s < tool->station_count; ++s) {
            const size_t of = wh_flow_of(tool, (int32_t)r, (int32_t)s);
            const int64_t swap_us = tool->swap_us[of];
            if (is_swap_short(tool, r, s)) {
                tool->place_us[of] = tool->place_us[of] < swap_us ? tool->place_us[of] : swap_us;
                tool->pick_us[of] = swap_us - tool->place_us[of];
            }
        }
    }
}

static bool has_short_swap(const wh_flow_tool_t *tool) {
    bool has = false;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        for (size_t s = 0; s < tool->station_count; ++s) {
            has = has || is_swap_short(tool, r, s);
        }
    }
    return has;
}

/* The node's number of a place of the tool: `places` maps them. */
static void open_problem(problem_t *problem, wh_flow_tool_t *own, const wh_flow_tool_t *tool,
                         const wh_flow_plan_t *plan) {
    *problem = (problem_t){.tool = own,
                           .plan = plan,
                           .wafers = (int32_t)plan->wafer_count,
                           .robots = (int32_t)tool->robot_count};
    bool *used = wh_array_new(tool->station_count, sizeof *used);
    (void)wh_best_places(tool, plan, used);
    wh_flow_tool_copy(own, tool);
    for (size_t s = 0; s < own->station_count; ++s) {
        own->stations[s].first_place = used[s] ? problem->places : WH_BEST_PLACES;
        for (int32_t p = 0; used[s] && p < own->stations[s].slots; ++p) {
            int32_t robot = WH_FLOW_NONE, count = 0;
            for (int32_t r = 0; r < problem->robots; ++r) {
                if (own->serves[wh_flow_of(own, r, (int32_t)s)]) {
                    robot = r;
                    ++count;
                }
            }
            problem->carrier[problem->places++] =
                count == 1 && own->robots[robot].arms == 1 ? robot : WH_FLOW_NONE;
        }
    }
    free(used);
}

static void open_root(const search_t *search, node_t *node) {
    memset(node, 0, sizeof *node);
    node->parent = WH_FLOW_NONE;
    for (int32_t w = 0; w < search->problem.wafers; ++w) {
        node->at[w] = HOME;
    }
    for (int32_t r = 0; r < search->problem.robots; ++r) {
        node->robot_at[r] = (int16_t)search->problem.tool->robots[r].at;
    }
    memset(node->wafer, WH_FLOW_NONE, sizeof node->wafer);
    memset(node->taken_us, 0xff, sizeof node->taken_us);
    wh_best_bound(&search->problem, node);
}

/* --------------------------------------------------------------------------------------------- expanding */

/* One doing of a robot. */
typedef struct {
    int32_t robot, wafer;
    int32_t from, to;       /* stations; `from` WH_FLOW_NONE: from the arm; `to` WH_FLOW_NONE: onto it */
    int32_t place, to_slot; /* of the node, WH_FLOW_NONE for the end; the slot in its station */
    int64_t begin_us;
    bool is_early; /* by its list the robot would begin it before another wafer came into the place */
} doing_t;

static int64_t arrive_us(const problem_t *problem, const node_t *node, int32_t robot, int32_t station) {
    return node->free_us[robot] + wh_flow_move_us(problem->tool, robot, node->robot_at[robot], station);
}

/* Onto the robot's arm, or to its place, or its end. */
static void move_wafer(const problem_t *problem, node_t *node, const doing_t *doing, int64_t placed_us) {
    const int32_t w = doing->wafer;
    if (doing->from != WH_FLOW_NONE && node->at[w] >= 0) {
        const int64_t pick_us = problem->tool->pick_us[wh_flow_of(problem->tool, doing->robot, doing->from)];
        node->wafer[node->at[w]] = WH_FLOW_NONE;
        node->picked_us[node->at[w]] = doing->begin_us;
        node->empty_us[node->at[w]] = doing->begin_us + pick_us;
    }
    if (doing->to == WH_FLOW_NONE) {
        node->at[w] = (int16_t)ON_ARM(doing->robot);
        node->ready_us[w] = placed_us;
        return;
    }
    ++node->step[w];
    node->ready_us[w] = placed_us;
    node->at[w] = OVER;
    if (doing->place != WH_FLOW_NONE) {
        const wh_flow_step_t *step = wh_flow_step_of(problem->plan, w, node->step[w]);
        node->ready_us[w] +=
            wh_flow_step_us(step, &problem->tool->stations[doing->to], problem->plan->wafers[w].recipe);
        node->at[w] = (int16_t)doing->place;
        node->wafer[doing->place] = (int16_t)w;
        node->taken_us[doing->place] = doing->begin_us;
    }
}

static void add_node(search_t *search, size_t level, const node_t *node) {
    level_t *into = &search->levels[level % LEVELS];
    into->nodes = wh_array_grow(into->nodes, into->count, &into->capacity, sizeof *into->nodes);
    into->nodes[into->count++] = *node;
}

static bool is_over(const problem_t *problem, const node_t *node) {
    bool over = true;
    for (int32_t w = 0; w < problem->wafers; ++w) {
        over = over && node->at[w] == OVER;
    }
    return over;
}

static int32_t note_step(search_t *search, const node_t *node, const doing_t *doing) {
    search->steps =
        wh_array_grow(search->steps, search->step_count, &search->step_capacity, sizeof *search->steps);
    step_t *step = &search->steps[search->step_count];
    *step = (step_t){node->parent, doing->robot, WH_FLOW_NO_LINE};
    step->line.what = doing->from == WH_FLOW_NONE ? WH_FLOW_BRING
                      : doing->to == WH_FLOW_NONE ? WH_FLOW_KEEP
                                                  : WH_FLOW_TRANSFER;
    step->line.from = doing->from;
    step->line.to = doing->to;
    step->line.wafer = doing->wafer;
    return (int32_t)search->step_count++;
}

static int64_t end_us(const problem_t *problem, const doing_t *doing) {
    const wh_flow_tool_t *tool = problem->tool;
    int64_t us = doing->begin_us;
    us += doing->from != WH_FLOW_NONE ? tool->pick_us[wh_flow_of(tool, doing->robot, doing->from)] : 0;
    us += doing->from != WH_FLOW_NONE && doing->to != WH_FLOW_NONE
              ? wh_flow_move_us(tool, doing->robot, doing->from, doing->to)
              : 0;
    us += doing->to != WH_FLOW_NONE ? tool->place_us[wh_flow_of(tool, doing->robot, doing->to)] : 0;
    return us;
}

/* Whatever goes on from a node of this bound is not looked at. */
static void leave_out(search_t *search, int64_t bound_us) {
    search->left_out_us = bound_us < search->left_out_us ? bound_us : search->left_out_us;
}

/* A doing that could have begun before the node's last one is in another order of the same schedule. */
static void try_doing(search_t *search, size_t level, const node_t *node, const doing_t *doing) {
    if (doing->begin_us < node->now_us) {
        return;
    }
    node_t next = *node;
    const int64_t over_us = end_us(&search->problem, doing);
    ++search->best->nodes;
    move_wafer(&search->problem, &next, doing, over_us);
    next.now_us = doing->begin_us;
    next.free_us[doing->robot] = over_us;
    next.robot_at[doing->robot] = (int16_t)(doing->to != WH_FLOW_NONE ? doing->to : doing->from);
    wh_best_bound(&search->problem, &next);
    if (next.bound_us >= search->best->makespan_us) {
        return;
    }
    if (doing->is_early) {
        leave_out(search, next.bound_us);
        return;
    }
    next.parent = note_step(search, node, doing);
    next.kind = wh_best_kind(&search->problem, &next);
    if (is_over(&search->problem, &next)) {
        search->best->makespan_us = next.bound_us;
        search->last = next.parent;
        return;
    }
    add_node(search, level + (doing->from != WH_FLOW_NONE && doing->to != WH_FLOW_NONE ? 2 : 1), &next);
}

static int32_t count_on(const problem_t *problem, const node_t *node, int32_t robot) {
    int32_t count = 0;
    for (int32_t w = 0; w < problem->wafers; ++w) {
        count += node->at[w] == ON_ARM(robot) ? 1 : 0;
    }
    return count;
}

/* Into each free place of a station; of those that no wafer ever lay in, the first alone. */
static void try_places(search_t *search, size_t level, const node_t *node, doing_t *doing, int64_t from_us) {
    const problem_t *problem = &search->problem;
    const wh_flow_tool_t *tool = problem->tool;
    const wh_flow_station_t *to = &tool->stations[doing->to];
    const bool is_end = node->step[doing->wafer] + 1 == wh_flow_last_step(problem->plan, doing->wafer);
    const bool brings = doing->from == WH_FLOW_NONE;
    bool fresh = false;
    if (is_end) {
        doing->place = WH_FLOW_NONE;
        doing->begin_us = from_us;
        doing->is_early = false;
        try_doing(search, level, node, doing);
        return;
    }
    const int64_t ahead_us = brings ? 0
                                    : tool->pick_us[wh_flow_of(tool, doing->robot, doing->from)] +
                                          wh_flow_move_us(tool, doing->robot, doing->from, doing->to);
    for (int32_t p = to->first_place; p < to->first_place + to->slots; ++p) {
        const bool is_fresh = node->empty_us[p] == 0;
        if (node->wafer[p] != WH_FLOW_NONE || (is_fresh && fresh)) {
            continue;
        }
        fresh = fresh || is_fresh;
        doing->place = p;
        doing->is_early = from_us <= node->taken_us[p];
        doing->begin_us = later(from_us, brings ? node->empty_us[p]
                                                : later(node->picked_us[p], node->empty_us[p] - ahead_us));
        try_doing(search, level, node, doing);
    }
}

static void try_stations(search_t *search, size_t level, const node_t *node, doing_t *doing,
                         int64_t from_us) {
    const problem_t *problem = &search->problem;
    const wh_flow_step_t *step = wh_flow_step_of(problem->plan, doing->wafer, node->step[doing->wafer] + 1);
    for (size_t i = 0; i < step->station_count; ++i) {
        doing->to = step->stations[i];
        if (problem->tool->serves[wh_flow_of(problem->tool, doing->robot, doing->to)]) {
            const int64_t there_us = doing->from == WH_FLOW_NONE
                                         ? later(from_us, arrive_us(problem, node, doing->robot, doing->to))
                                         : from_us;
            try_places(search, level, node, doing, there_us);
        }
    }
}

static int32_t lies_in(const problem_t *problem, const node_t *node, int32_t w) {
    if (node->at[w] == HOME) {
        return problem->tool->place_stations[problem->plan->wafers[w].home];
    }
    for (int32_t s = 0; s < (int32_t)problem->tool->station_count; ++s) {
        const wh_flow_station_t *station = &problem->tool->stations[s];
        if (node->at[w] >= station->first_place && node->at[w] < station->first_place + station->slots) {
            return s;
        }
    }
    return WH_FLOW_NONE;
}

static void expand_wafer(search_t *search, size_t level, const node_t *node, int32_t robot, int32_t w) {
    const problem_t *problem = &search->problem;
    doing_t doing = {
        .robot = robot, .wafer = w, .from = WH_FLOW_NONE, .to = WH_FLOW_NONE, .place = WH_FLOW_NONE};
    if (node->at[w] == ON_ARM(robot)) {
        try_stations(search, level, node, &doing, node->ready_us[w]);
        return;
    }
    const int32_t from = node->at[w] >= HOME ? lies_in(problem, node, w) : WH_FLOW_NONE;
    const int32_t arms = problem->tool->robots[robot].arms;
    if (from == WH_FLOW_NONE || count_on(problem, node, robot) == arms ||
        !problem->tool->serves[wh_flow_of(problem->tool, robot, from)]) {
        return;
    }
    const int64_t from_us = later(arrive_us(problem, node, robot, from), node->ready_us[w]);
    doing.from = from;
    try_stations(search, level, node, &doing, from_us);
    const wh_flow_step_t *next = wh_flow_step_of(problem->plan, w, node->step[w] + 1);
    if (arms > 1 && wh_flow_step_is_served(problem->tool, next, robot)) {
        doing.to = doing.place = WH_FLOW_NONE;
        doing.is_early = false;
        doing.begin_us = from_us;
        try_doing(search, level, node, &doing);
    }
}

/* True if an earlier wafer of its lot and its recipe waits in its first place, too: that one goes first. */
static bool is_behind(const problem_t *problem, const node_t *node, int32_t w) {
    const wh_flow_wafer_t *wafers = problem->plan->wafers;
    for (int32_t i = w - 1; node->at[w] == HOME && i >= 0 && wafers[i].lot == wafers[w].lot; --i) {
        if (node->at[i] == HOME && wafers[i].recipe == wafers[w].recipe) {
            return true;
        }
    }
    return false;
}

static void expand(search_t *search, size_t level, const node_t *node) {
    for (int32_t r = 0; r < search->problem.robots; ++r) {
        for (int32_t w = 0; w < search->problem.wafers; ++w) {
            if (node->at[w] != OVER && !is_behind(&search->problem, node, w)) {
                expand_wafer(search, level, node, r, w);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------- levels */

/* Keeps the best ones. */
static void thin(search_t *search, level_t *level) {
    level->count = wh_best_drop_beaten(&search->problem, level->nodes, level->count);
    if (level->count > search->width) {
        wh_best_sort(level->nodes, level->count);
        leave_out(search, level->nodes[search->width].bound_us);
        level->count = search->width;
    }
}

static void write_lists(search_t *search, size_t robots) {
    wh_flow_list_t *lists = wh_array_new(robots, sizeof *lists);
    for (int32_t s = search->last; s != WH_FLOW_NONE; s = search->steps[s].before) {
        wh_flow_list_t *list = &lists[search->steps[s].robot];
        list->lines = wh_array_grow(list->lines, list->count, &list->capacity, sizeof *list->lines);
        list->lines[list->count++] = search->steps[s].line;
    }
    for (size_t r = 0; r < robots; ++r) {
        for (size_t i = 0; i < lists[r].count / 2; ++i) {
            const wh_flow_line_t line = lists[r].lines[i];
            lists[r].lines[i] = lists[r].lines[lists[r].count - 1 - i];
            lists[r].lines[lists[r].count - 1 - i] = line;
        }
    }
    search->best->lists = lists;
}

static size_t count_levels(const problem_t *problem) {
    size_t levels = 0;
    for (int32_t w = 0; w < problem->wafers; ++w) {
        levels += 2 * (size_t)wh_flow_last_step(problem->plan, w);
    }
    return levels;
}

static void search_levels(search_t *search, wh_flow_best_progress_t *progress, void *user) {
    const size_t levels = count_levels(&search->problem);
    for (size_t level = 0; level < levels && search->best->makespan_us > search->best->bound_us; ++level) {
        level_t *of = &search->levels[level % LEVELS];
        thin(search, of);
        for (size_t i = 0; i < of->count; ++i) {
            expand(search, level, &of->nodes[i]);
        }
        of->count = 0;
        if (progress) {
            progress(user, (double)(level + 1) / (double)levels);
        }
    }
}

static void search_all(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, search_t *search,
                       wh_flow_best_progress_t *progress, void *user) {
    wh_flow_best_t *best = search->best;
    wh_flow_tool_t own;
    node_t root;
    *best = (wh_flow_best_t){.makespan_us = WH_FLOW_NEVER};
    open_problem(&search->problem, &own, tool, plan);
    best->lacks_swaps = has_short_swap(&own);
    if (search->is_relaxed) {
        relax(&own);
    }
    open_root(search, &root);
    best->bound_us = root.bound_us;
    add_node(search, 0, &root);
    search_levels(search, progress, user);
    const int64_t open_us = search->left_out_us < best->makespan_us ? search->left_out_us : best->makespan_us;
    best->bound_us = open_us != WH_FLOW_NEVER && open_us > best->bound_us ? open_us : best->bound_us;
    if (search->last != WH_FLOW_NONE) {
        write_lists(search, tool->robot_count);
    }
    for (size_t i = 0; i < LEVELS; ++i) {
        free(search->levels[i].nodes);
    }
    free(search->steps);
    wh_flow_tool_close(&own);
}

void wh_flow_best(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, size_t width,
                  wh_flow_best_progress_t *progress, void *user, wh_flow_best_t *best) {
    search_t search = {.width = width, .best = best, .last = WH_FLOW_NONE, .left_out_us = WH_FLOW_NEVER};
    search_all(tool, plan, &search, progress, user);
    if (best->lacks_swaps) {
        wh_flow_best_t relaxed = {0};
        search = (search_t){.width = width,
                            .best = &relaxed,
                            .last = WH_FLOW_NONE,
                            .left_out_us = WH_FLOW_NEVER,
                            .is_relaxed = true};
        search_all(tool, plan, &search, progress, user);
        best->bound_us = relaxed.bound_us;
        best->nodes += relaxed.nodes;
        wh_flow_best_close(&relaxed, tool);
    }
}

void wh_flow_best_close(wh_flow_best_t *best, const wh_flow_tool_t *tool) {
    for (size_t r = 0; best->lists && r < tool->robot_count; ++r) {
        free(best->lists[r].lines);
    }
    free(best->lists);
    memset(best, 0, sizeof *best);
}
