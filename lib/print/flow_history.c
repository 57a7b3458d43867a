#include "flow_history.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/json.h"
#include "print_internal.h"

/* One line. Texts are null where they do not belong. */
typedef struct {
    int64_t us;
    size_t number; /* lines of one time stay in the order in which they were made */
    int32_t wafer; /* or WH_FLOW_NONE: of a module */
    int32_t place, robot, arm;
    const char *location, *processing, *ept;
} line_t;

/* Something of a module begins or ends: a process or a clean keeps it busy; a done wafer, or a failure of its
 * station, blocks it. */
typedef struct {
    int64_t us;
    int32_t place;
    int busy, blocked; /* 1: begins; -1: ends */
} mark_t;

typedef struct {
    const wh_flow_figures_t *figures;
    line_t *lines;
    size_t count, capacity;
    mark_t *marks;
    size_t mark_count, mark_capacity;
} lines_t;

static void add_line(lines_t *lines, const line_t *line) {
    if (line->us == WH_FLOW_NEVER) {
        return;
    }
    lines->lines = wh_array_grow(lines->lines, lines->count, &lines->capacity, sizeof *lines->lines);
    lines->lines[lines->count] = *line;
    lines->lines[lines->count].number = lines->count;
    ++lines->count;
}

/* The last step of the wafer that has a process, as far as it went. */
static int32_t last_process(const wh_flow_figures_t *figures, int32_t wafer) {
    const wh_flow_plan_t *plan = figures->plan;
    for (int32_t k = wh_flow_last_step(plan, wafer) - 1; k > 0; --k) {
        const wh_flow_step_t *step = wh_flow_step_of(plan, wafer, k);
        for (size_t i = 0; i < step->station_count; ++i) {
            if (wh_flow_step_us(step, &figures->tool->stations[step->stations[i]],
                                plan->wafers[wafer].recipe) > 0) {
                return k;
            }
        }
    }
    return 0;
}

static void add_visit(lines_t *lines, const wh_flow_visit_t *visit, const char **processing) {
    const wh_flow_figures_t *figures = lines->figures;
    const bool is_last = visit->is_end;
    line_t line = {.wafer = visit->wafer, .place = WH_FLOW_NONE, .robot = visit->robot, .arm = visit->arm};
    line.us = visit->picked_us;
    line.location = "AtWork";
    line.processing = processing[visit->wafer];
    add_line(lines, &line);
    line.us = visit->placed_us;
    line.place = visit->place;
    line.robot = WH_FLOW_NONE;
    line.location = is_last ? "AtDestination" : "AtWork";
    add_line(lines, &line);
    const bool is_processed = visit->process_us != WH_FLOW_NEVER && visit->done_us > visit->process_us;
    if (!is_processed) {
        return;
    }
    line.us = visit->process_us;
    line.processing = "InProcess";
    add_line(lines, &line);
    line.us = visit->done_us;
    line.processing = visit->step >= last_process(figures, visit->wafer) ? "Processed" : "InProcess";
    processing[visit->wafer] = line.processing;
    add_line(lines, &line);
}

static int by_time(const void *a, const void *b) {
    const line_t *one = a, *other = b;
    if (one->us != other->us) {
        return one->us < other->us ? -1 : 1;
    }
    return one->number < other->number ? -1 : 1;
}

/* ------------------------------------------------------------------------------------------------ modules */

static void add_mark(lines_t *lines, const mark_t *mark) {
    if (mark->us < WH_FLOW_FOR_EVER) {
        lines->marks =
            wh_array_grow(lines->marks, lines->mark_count, &lines->mark_capacity, sizeof *lines->marks);
        lines->marks[lines->mark_count++] = *mark;
    }
}

static void add_span(lines_t *lines, int32_t place, int64_t begin_us, int64_t end_us, bool is_busy) {
    const int busy = is_busy ? 1 : 0;
    add_mark(lines, &(mark_t){begin_us, place, busy, 1 - busy});
    add_mark(lines, &(mark_t){end_us, place, -busy, busy - 1});
}

/* A process, and the stay behind it until the pick begins. */
static void mark_visit(lines_t *lines, const wh_flow_visit_t *visit, int64_t taken_us) {
    if (visit->process_us == WH_FLOW_NEVER || visit->done_us <= visit->process_us) {
        return;
    }
    add_span(lines, visit->place, visit->process_us, visit->done_us, true);
    if (taken_us > visit->done_us) {
        add_span(lines, visit->place, visit->done_us, taken_us, false);
    }
}

static void mark_visits(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    const size_t wafers = figures->plan->wafer_count;
    int64_t *taken_us = wh_array_new(wafers + 1, sizeof *taken_us);
    for (size_t w = 0; w < wafers; ++w) {
        taken_us[w] = WH_FLOW_NEVER;
    }
    for (size_t i = figures->visit_count; i > 0; --i) {
        const wh_flow_visit_t *visit = &figures->visits[i - 1];
        mark_visit(lines, visit, taken_us[visit->wafer]);
        taken_us[visit->wafer] = visit->pick_us;
    }
    free(taken_us);
}

static void mark_down(lines_t *lines, const bool modules[], int32_t station, int64_t begin_us,
                      int64_t end_us) {
    const wh_flow_station_t *of = &lines->figures->tool->stations[station];
    for (int32_t place = of->first_place; place < of->first_place + of->slots; ++place) {
        if (modules[place]) {
            add_span(lines, place, begin_us, end_us, false);
        }
    }
}

/* Failures that have ended are told; others are the plan's. */
static void mark_downs(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    const wh_flow_plan_t *plan = figures->plan;
    bool *modules = wh_array_new(figures->tool->place_count, sizeof *modules);
    for (size_t i = 0; i < lines->mark_count; ++i) {
        modules[lines->marks[i].place] = true;
    }
    for (size_t i = 0; i < figures->doing_count; ++i) {
        const wh_flow_doing_t *doing = &figures->doings[i];
        if (doing->kind == WH_FLOW_EVENT_DOWN) {
            mark_down(lines, modules, doing->station, doing->begin_us, doing->end_us);
        }
    }
    for (size_t i = 0; i < plan->down_count; ++i) {
        const wh_flow_down_t *down = &plan->downs[i];
        if (down->robot == WH_FLOW_NONE && down->at_us <= figures->end_us &&
            down->for_us > figures->end_us - down->at_us) {
            mark_down(lines, modules, down->station, down->at_us, WH_FLOW_NEVER);
        }
    }
    free(modules);
}

static int by_place(const void *a, const void *b) {
    const mark_t *one = a, *other = b;
    if (one->place != other->place) {
        return one->place < other->place ? -1 : 1;
    }
    return (one->us > other->us) - (one->us < other->us);
}

/* True if no other mark of this module is of this time. */
static bool is_last_mark(const lines_t *lines, size_t i) {
    const mark_t *mark = &lines->marks[i];
    return i + 1 == lines->mark_count || mark[1].place != mark->place || mark[1].us != mark->us;
}

/* Lines where a module's state becomes another one. */
static void tell_modules(lines_t *lines) {
    int busy = 0, blocked = 0;
    const char *state = NULL;
    if (lines->mark_count > 0) {
        qsort(lines->marks, lines->mark_count, sizeof *lines->marks, by_place);
    }
    for (size_t i = 0; i < lines->mark_count; ++i) {
        const mark_t *mark = &lines->marks[i];
        if (i == 0 || mark[-1].place != mark->place) {
            busy = blocked = 0;
            state = "IDLE";
        }
        busy += mark->busy;
        blocked += mark->blocked;
        const char *now = busy > 0 ? "BUSY" : blocked > 0 ? "BLOCKED" : "IDLE";
        if (is_last_mark(lines, i) && strcmp(now, state) != 0) {
            const line_t line = {.us = mark->us,
                                 .wafer = WH_FLOW_NONE,
                                 .place = mark->place,
                                 .robot = WH_FLOW_NONE,
                                 .ept = now};
            add_line(lines, &line);
            state = now;
        }
    }
}

static void add_modules(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    mark_visits(lines);
    for (size_t i = 0; i < figures->doing_count; ++i) {
        const wh_flow_doing_t *doing = &figures->doings[i];
        if (doing->kind == WH_FLOW_EVENT_CLEAN) {
            add_span(lines, doing->place, doing->begin_us, doing->end_us, true);
        }
    }
    for (size_t i = 0; i < figures->running.count; ++i) {
        add_span(lines, figures->running.items[i].place, figures->running.items[i].begin_us, WH_FLOW_NEVER,
                 true);
    }
    mark_downs(lines);
    tell_modules(lines);
    free(lines->marks);
}

/* -------------------------------------------------------------------------------------------------- whole */

static void find_lines(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    const wh_flow_plan_t *plan = figures->plan;
    const char **processing = wh_array_new(plan->wafer_count + 1, sizeof *processing);
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        const line_t line = {.us = figures->came_us[w],
                             .wafer = w,
                             .place = plan->wafers[w].home,
                             .robot = WH_FLOW_NONE,
                             .location = "AtSource",
                             .processing = "NeedsProcessing"};
        processing[w] = line.processing;
        add_line(lines, &line);
    }
    for (size_t i = 0; i < figures->visit_count; ++i) {
        add_visit(lines, &figures->visits[i], processing);
    }
    for (size_t i = 0; i < figures->running.count; ++i) {
        const wh_flow_running_t *running = &figures->running.items[i];
        const line_t line = {.us = running->begin_us,
                             .wafer = running->wafer,
                             .place = running->place,
                             .robot = WH_FLOW_NONE,
                             .location = "AtWork",
                             .processing = "InProcess"};
        if (running->wafer != WH_FLOW_NONE) {
            add_line(lines, &line);
        }
    }
    free(processing);
    add_modules(lines);
    if (lines->count > 0) {
        qsort(lines->lines, lines->count, sizeof *lines->lines, by_time);
    }
}

/* "PM1 1", or "R arm 2". */
static void name_place(const wh_flow_tool_t *tool, const line_t *line, char text[], size_t size) {
    if (line->place == WH_FLOW_NONE) {
        (void)snprintf(text, size, "%s arm %d", tool->robots[line->robot].name, (int)line->arm + 1);
    } else {
        (void)snprintf(text, size, "%s %d", tool->stations[tool->place_stations[line->place]].name,
                       (int)wh_flow_slot(tool, line->place));
    }
}

static void write_csv(const char *const texts[], size_t count, double time_s, FILE *out) {
    wh_print_csv_number(time_s, out);
    for (size_t i = 0; i < count; ++i) {
        fputc(',', out);
        if (texts[i]) {
            wh_print_csv_text(texts[i], out);
        }
    }
}

static void write_json(const line_t *line, const char *const texts[], double time_s, FILE *out) {
    json_t *object =
        line->wafer == WH_FLOW_NONE
            ? wh_json_set(json_object(), "time_s %g module %s ept %s", time_s, texts[5], texts[6])
            : wh_json_set(json_object(), "time_s %g wafer %s lot %s place %s location %s processing %s",
                          time_s, texts[0], texts[1], texts[2], texts[3], texts[4]);
    if (texts[7]) {
        wh_json_put(object, "recipe", wh_json_text(texts[7]));
    }
    (void)json_dumpf(object, out, JSON_REAL_PRECISION(17));
    json_decref(object);
}

/* Null: it has none. */
static const char *recipe_of(const wh_flow_figures_t *figures, int32_t wafer) {
    const int32_t recipe = figures->plan->wafers[wafer].recipe;
    return recipe > 0 ? figures->tool->recipes.names[recipe - 1] : NULL;
}

static void write_line(const wh_flow_figures_t *figures, const line_t *line, bool is_csv, FILE *out) {
    char place[200];
    name_place(figures->tool, line, place, sizeof place);
    const bool is_module = line->wafer == WH_FLOW_NONE;
    const wh_flow_wafer_t *wafer = is_module ? NULL : &figures->plan->wafers[line->wafer];
    const char *const texts[] = {is_module ? NULL : wafer->name,
                                 is_module ? NULL : figures->plan->lots[wafer->lot].name,
                                 is_module ? NULL : place,
                                 line->location,
                                 line->processing,
                                 is_module ? place : NULL,
                                 line->ept,
                                 is_module ? NULL : recipe_of(figures, line->wafer)};
    if (is_csv) {
        write_csv(texts, figures->tool->recipes.count > 0 ? 8 : 7, (double)line->us / 1e6, out);
    } else {
        write_json(line, texts, (double)line->us / 1e6, out);
    }
    fputc('\n', out);
}

bool wh_flow_history_write(const wh_flow_figures_t *figures, bool is_csv, FILE *out) {
    lines_t lines = {.figures = figures};
    find_lines(&lines);
    if (is_csv) {
        fputs("time_s,wafer,lot,place,location,processing,module,ept", out);
        fputs(figures->tool->recipes.count > 0 ? ",recipe\n" : "\n", out);
    }
    for (size_t i = 0; i < lines.count; ++i) {
        write_line(figures, &lines.lines[i], is_csv, out);
    }
    free(lines.lines);
    return !ferror(out);
}
