#include "flow_history.h"

#include <stdlib.h>

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

typedef struct {
    const wh_flow_figures_t *figures;
    line_t *lines;
    size_t count, capacity;
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

/* A process's begin and end, and the pick that follows it. */
static void add_module(lines_t *lines, const wh_flow_visit_t *visit, int64_t taken_us) {
    line_t line = {
        .us = visit->process_us, .wafer = WH_FLOW_NONE, .place = visit->place, .robot = WH_FLOW_NONE};
    if (visit->process_us == WH_FLOW_NEVER || visit->done_us <= visit->process_us) {
        return;
    }
    line.ept = "BUSY";
    add_line(lines, &line);
    if (taken_us > visit->done_us) {
        line.us = visit->done_us;
        line.ept = "BLOCKED";
        add_line(lines, &line);
    }
    line.us = taken_us;
    line.ept = "IDLE";
    add_line(lines, &line);
}

static int by_time(const void *a, const void *b) {
    const line_t *one = a, *other = b;
    if (one->us != other->us) {
        return one->us < other->us ? -1 : 1;
    }
    return one->number < other->number ? -1 : 1;
}

static void find_lines(lines_t *lines) {
    const wh_flow_figures_t *figures = lines->figures;
    const wh_flow_plan_t *plan = figures->plan;
    const char **processing = wh_array_new(plan->wafer_count + 1, sizeof *processing);
    int64_t *taken_us = wh_array_new(plan->wafer_count + 1, sizeof *taken_us);
    for (int32_t w = 0; w < (int32_t)plan->wafer_count; ++w) {
        const line_t line = {.us = figures->came_us[w],
                             .wafer = w,
                             .place = plan->wafers[w].home,
                             .robot = WH_FLOW_NONE,
                             .location = "AtSource",
                             .processing = "NeedsProcessing"};
        processing[w] = line.processing;
        taken_us[w] = WH_FLOW_NEVER;
        add_line(lines, &line);
    }
    for (size_t i = 0; i < figures->visit_count; ++i) {
        add_visit(lines, &figures->visits[i], processing);
    }
    for (size_t i = figures->visit_count; i > 0; --i) {
        const wh_flow_visit_t *visit = &figures->visits[i - 1];
        add_module(lines, visit, taken_us[visit->wafer]);
        taken_us[visit->wafer] = visit->pick_us;
    }
    free(processing);
    free(taken_us);
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
