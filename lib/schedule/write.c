#include "write.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "schedule.h"

/* One line; numbers are the tool's and the plan's, or WH_FLOW_NONE. */
typedef struct {
    int64_t begin_us, end_us;
    size_t number; /* lines that begin at one time stay in the order in which they were made */
    wh_schedule_action_t action;
    int32_t robot, arm, wafer, wafer2, station, slot, to;
    wh_flow_side_t side;
    int32_t recipe; /* the tool's; 0: none */
} line_t;

typedef struct {
    const wh_flow_figures_t *figures;
    line_t *lines;
    size_t count, capacity;
    const wh_flow_visit_t **by_pick; /* visits by the place that they come from, then by their pick */
} lines_t;

static line_t *add_line(lines_t *lines, wh_schedule_action_t action, int64_t begin_us, int64_t end_us) {
    lines->lines = wh_array_grow(lines->lines, lines->count, &lines->capacity, sizeof *lines->lines);
    line_t *line = &lines->lines[lines->count];
    *line = (line_t){begin_us,     end_us,       lines->count, action,       WH_FLOW_NONE, 0, WH_FLOW_NONE,
                     WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_BOTH, 0};
    ++lines->count;
    return line;
}

static void put_place(const lines_t *lines, line_t *line, int32_t place) {
    const wh_flow_tool_t *tool = lines->figures->tool;
    line->station = tool->place_stations[place];
    line->slot = wh_flow_slot(tool, place);
}

/* ------------------------------------------------------------------------------------------------- visits */

/* A blade in a place, its door before and behind it. */
static void add_access(lines_t *lines, wh_schedule_action_t action, const wh_flow_visit_t *visit,
                       int32_t place, int32_t wafer2) {
    const bool is_pick = action == WH_SCHEDULE_PICK;
    const int64_t begin_us = is_pick ? visit->pick_us : visit->place_us;
    const int64_t end_us = is_pick ? visit->picked_us : visit->placed_us;
    const wh_flow_tool_t *tool = lines->figures->tool;
    const int32_t station = tool->place_stations[place];
    const wh_flow_door_t *door = &tool->doors[wh_flow_of(tool, visit->robot, station)];
    const bool has_door = !door->is_real && (door->open_us > 0 || door->close_us > 0);
    if (has_door) {
        line_t *open = add_line(lines, WH_SCHEDULE_OPEN, begin_us - door->open_us, begin_us);
        open->robot = visit->robot;
        open->station = station;
    }
    line_t *line = add_line(lines, action, begin_us, end_us);
    line->robot = visit->robot;
    line->arm = visit->arm + 1;
    line->wafer = visit->wafer;
    line->wafer2 = wafer2;
    put_place(lines, line, place);
    if (has_door) {
        line_t *shut = add_line(lines, WH_SCHEDULE_CLOSE, end_us, end_us + door->close_us);
        shut->robot = visit->robot;
        shut->station = station;
    }
}

static int by_pick(const void *a, const void *b) {
    const wh_flow_visit_t *const *one = a, *const *other = b;
    if ((*one)->from != (*other)->from) {
        return (*one)->from < (*other)->from ? -1 : 1;
    }
    return (*one)->pick_us < (*other)->pick_us ? -1 : (*one)->pick_us > (*other)->pick_us;
}

/* The visit whose wafer came out when this one's went in, by one exchange; null: it was no exchange. */
static const wh_flow_visit_t *find_swap(const lines_t *lines, const wh_flow_visit_t *visit) {
    if (visit->placed_us == WH_FLOW_NEVER || visit->placed_us == visit->place_us) {
        return NULL;
    }
    const wh_flow_visit_t key = {.from = visit->place, .pick_us = visit->place_us};
    const wh_flow_visit_t *const wanted = &key;
    const wh_flow_visit_t **found =
        bsearch(&wanted, lines->by_pick, lines->figures->visit_count, sizeof wanted, by_pick);
    return found && (*found)->robot == visit->robot && (*found)->picked_us == visit->placed_us ? *found
                                                                                               : NULL;
}

static void add_visit(lines_t *lines, const wh_flow_visit_t *visit, bool is_swapped_out) {
    const wh_flow_visit_t *out = find_swap(lines, visit);
    if (visit->picked_us != WH_FLOW_NEVER && !is_swapped_out) {
        add_access(lines, WH_SCHEDULE_PICK, visit, visit->from, WH_FLOW_NONE);
    }
    if (visit->placed_us != WH_FLOW_NEVER) {
        add_access(lines, out ? WH_SCHEDULE_SWAP : WH_SCHEDULE_PLACE, visit, visit->place,
                   out ? out->wafer : WH_FLOW_NONE);
    }
    if (visit->process_us != WH_FLOW_NEVER && visit->done_us > visit->process_us) {
        line_t *line = add_line(lines, WH_SCHEDULE_PROCESS, visit->process_us, visit->done_us);
        line->wafer = visit->wafer;
        line->recipe = wh_flow_recipe_of(lines->figures->plan, visit->wafer, visit->step);
        put_place(lines, line, visit->place);
    }
}

static void add_visits(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    bool *swapped = wh_array_new(figures->visit_count + 1, sizeof *swapped);
    for (size_t i = 0; i < figures->visit_count; ++i) {
        const wh_flow_visit_t *out = find_swap(lines, &figures->visits[i]);
        if (out) {
            swapped[out - figures->visits] = true;
        }
    }
    for (size_t i = 0; i < figures->visit_count; ++i) {
        add_visit(lines, &figures->visits[i], swapped[i]);
    }
    free(swapped);
}

static void sort_by_pick(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    lines->by_pick = wh_array_new(figures->visit_count + 1, sizeof *lines->by_pick);
    for (size_t i = 0; i < figures->visit_count; ++i) {
        lines->by_pick[i] = &figures->visits[i];
    }
    if (figures->visit_count > 0) {
        qsort(lines->by_pick, figures->visit_count, sizeof *lines->by_pick, by_pick);
    }
}

/* ------------------------------------------------------------------------------------------------- others */

static void add_starts(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    for (size_t w = 0; w < figures->plan->wafer_count; ++w) {
        if (figures->came_us[w] != WH_FLOW_NEVER) {
            line_t *line = add_line(lines, WH_SCHEDULE_START, figures->came_us[w], figures->came_us[w]);
            line->wafer = (int32_t)w;
            line->recipe = figures->plan->wafers[w].recipe;
            put_place(lines, line, figures->plan->wafers[w].home);
        }
    }
}

static void add_doings(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    for (size_t i = 0; i < figures->ways.count; ++i) {
        const wh_flow_way_t *way = &figures->ways.items[i];
        line_t *line = add_line(lines, WH_SCHEDULE_MOVE, way->begin_us, way->end_us);
        line->robot = way->robot;
        line->station = way->from;
        line->to = way->to;
    }
    for (size_t i = 0; i < figures->doing_count; ++i) {
        const wh_flow_doing_t *doing = &figures->doings[i];
        if (doing->kind == WH_FLOW_EVENT_CLEAN) {
            put_place(lines, add_line(lines, WH_SCHEDULE_CLEAN, doing->begin_us, doing->end_us),
                      doing->place);
        } else if (doing->kind == WH_FLOW_EVENT_PUMP) {
            line_t *line = add_line(lines, WH_SCHEDULE_PUMP, doing->begin_us, doing->end_us);
            line->station = doing->station;
            line->side = doing->side;
        } else if (doing->kind != WH_FLOW_EVENT_DOWN && doing->robot != WH_FLOW_NONE) {
            const bool opens = doing->kind == WH_FLOW_EVENT_OPEN;
            line_t *line =
                add_line(lines, opens ? WH_SCHEDULE_OPEN : WH_SCHEDULE_CLOSE, doing->begin_us, doing->end_us);
            line->robot = doing->robot;
            line->station = doing->station;
            line->side = figures->tool->sides[wh_flow_of(figures->tool, doing->robot, doing->station)];
        }
    }
}

/* Where the wafer lay at this time, before its carrier went: a place, or WH_FLOW_NONE. `is_past`: what came
 * at this very time counts. */
static int32_t lay_in(const wh_flow_figures_t *figures, int32_t wafer, int64_t at_us, bool is_past) {
    int32_t place = WH_FLOW_NONE;
    const int64_t came_us = figures->came_us[wafer];
    if (came_us == WH_FLOW_NEVER || came_us > at_us || (came_us == at_us && !is_past)) {
        return WH_FLOW_NONE;
    }
    place = figures->plan->wafers[wafer].home;
    for (size_t i = 0; i < figures->visit_count; ++i) {
        const wh_flow_visit_t *visit = &figures->visits[i];
        if (visit->wafer == wafer && visit->picked_us <= at_us) {
            place = visit->placed_us <= at_us ? visit->place : WH_FLOW_NONE;
        }
    }
    return place;
}

/* The wafers that went with a carrier: none of them goes twice. */
static void add_leaves(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    bool *is_gone = wh_array_new(figures->plan->wafer_count + 1, sizeof *is_gone);
    for (size_t i = 0; i < figures->doing_count; ++i) {
        const wh_flow_doing_t *doing = &figures->doings[i];
        const bool goes = doing->kind == WH_FLOW_EVENT_GOES;
        for (int32_t w = 0;
             (goes || doing->kind == WH_FLOW_EVENT_COMES) && w < (int32_t)figures->plan->wafer_count; ++w) {
            const int32_t place = is_gone[w] ? WH_FLOW_NONE : lay_in(figures, w, doing->end_us, goes);
            if (place != WH_FLOW_NONE && figures->tool->place_stations[place] == doing->station) {
                line_t *line = add_line(lines, WH_SCHEDULE_LEAVE, doing->end_us, doing->end_us);
                line->wafer = w;
                put_place(lines, line, place);
                is_gone[w] = true;
            }
        }
    }
    free(is_gone);
}

/* ------------------------------------------------------------------------------------------------ writing */

static int by_begin(const void *a, const void *b) {
    const line_t *one = a, *other = b;
    if (one->begin_us != other->begin_us) {
        return one->begin_us < other->begin_us ? -1 : 1;
    }
    return one->number < other->number ? -1 : 1;
}

/* Seconds with the decimals that there are. */
static void write_time(int64_t us, FILE *out) {
    char text[32];
    size_t length = (size_t)snprintf(text, sizeof text, "%" PRId64 ".%06" PRId64, us / 1000000, us % 1000000);
    while (text[length - 1] == '0') {
        --length;
    }
    length -= text[length - 1] == '.' ? 1 : 0;
    fprintf(out, ",%.*s", (int)length, text);
}

/* A name as a cell. */
static void write_name(const char *name, FILE *out) {
    const size_t length = strlen(name);
    const bool is_plain =
        name[strcspn(name, ",\"#\t")] == '\0' && name[0] != ' ' && (length == 0 || name[length - 1] != ' ');
    if (is_plain) {
        fputs(name, out);
        return;
    }
    fputc('"', out);
    for (; *name != '\0'; ++name) {
        fputs(*name == '"' ? "\"" : "", out);
        fputc((unsigned char)*name, out);
    }
    fputc('"', out);
}

static void write_number(int32_t number, FILE *out) {
    fputc(',', out);
    if (number > 0) {
        fprintf(out, "%d", (int)number);
    }
}

static void write_line(const lines_t *lines, const line_t *line, FILE *out) {
    const wh_flow_tool_t *tool = lines->figures->tool;
    const wh_flow_wafer_t *wafers = lines->figures->plan->wafers;
    write_name(line->robot == WH_FLOW_NONE ? "" : tool->robots[line->robot].name, out);
    fprintf(out, ",%s,", wh_schedule_words[line->action]);
    write_name(line->wafer == WH_FLOW_NONE ? "" : wafers[line->wafer].name, out);
    fputc(',', out);
    write_name(tool->stations[line->station].name, out);
    write_number(line->slot, out);
    write_time(line->begin_us, out);
    write_time(line->end_us, out);
    write_number(line->arm, out);
    fputc(',', out);
    write_name(line->wafer2 == WH_FLOW_NONE ? "" : wafers[line->wafer2].name, out);
    fputc(',', out);
    write_name(line->to == WH_FLOW_NONE ? "" : tool->stations[line->to].name, out);
    fputc(',', out);
    write_name(line->recipe > 0             ? tool->recipes.names[line->recipe - 1]
               : line->side == WH_FLOW_BOTH ? ""
                                            : wh_flow_side_words[line->side],
               out);
    fputc('\n', out);
}

bool wh_schedule_write(const wh_flow_figures_t *figures, FILE *out) {
    lines_t lines = {.figures = figures};
    sort_by_pick(&lines);
    add_starts(&lines);
    add_visits(&lines);
    add_doings(&lines);
    add_leaves(&lines);
    if (lines.count > 0) {
        qsort(lines.lines, lines.count, sizeof *lines.lines, by_begin);
    }
    fputs("robot,action,wafer,station,slot,begin_s,end_s,arm,wafer2,to,value\n", out);
    for (size_t i = 0; i < lines.count; ++i) {
        write_line(&lines, &lines.lines[i], out);
    }
    free(lines.lines);
    free(lines.by_pick);
    return !ferror(out);
}
