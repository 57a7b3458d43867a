#include "best_print.h"

#include <math.h>

#include "../text/json.h"

static double seconds(int64_t us) {
    return us == WH_FLOW_NEVER ? (double)NAN : (double)us / 1e6;
}

static bool is_optimal(const wh_flow_best_t *best) {
    return best->lists && best->makespan_us <= best->bound_us;
}

static const char *name_of(const wh_best_result_t *result, int32_t station) {
    return station == WH_FLOW_NONE ? "keep" : result->tool->stations[station].name;
}

static const char *wafer_of(const wh_best_result_t *result, const wh_flow_line_t *line) {
    return result->plan->wafers[line->wafer].name;
}

/* A script takes it over as it stands. */
static void print_lists(const wh_best_result_t *result, FILE *out) {
    fputs("\nrule = { order = {\n", out);
    for (size_t r = 0; r < result->tool->robot_count; ++r) {
        const wh_flow_list_t *list = &result->best->lists[r];
        fprintf(out, "  [\"%s\"] = {", result->tool->robots[r].name);
        for (size_t i = 0; i < list->count; ++i) {
            const wh_flow_line_t *line = &list->lines[i];
            fprintf(out, "%s{ \"%s\", \"%s\", \"%s\" },", i % 4 == 0 ? "\n    " : " ",
                    name_of(result, line->from), name_of(result, line->to), wafer_of(result, line));
        }
        fputs("\n  },\n", out);
    }
    fputs("} }\n", out);
}

int wh_best_print_table(const wh_best_result_t *result, FILE *out, const wh_style_t *style) {
    const wh_flow_best_t *best = result->best;
    wh_style_put(out, result->script);
    fprintf(out, "\n\nthe script's rule  %.10g s\n", seconds(result->rule_us));
    if (best->lists) {
        fprintf(out, "the best found     %.10g s\n", seconds(best->makespan_us));
    }
    fprintf(out, "the bound          %.10g s: no schedule takes less\n", seconds(best->bound_us));
    fprintf(out, "%llu nodes were looked at\n", (unsigned long long)best->nodes);
    if (best->lists) {
        print_lists(result, out);
        fputc('\n', out);
    }
    if (best->lacks_swaps) {
        wh_style_print(style, out, WH_INK_WARN, "! ");
        fputs("swaps are shorter than a pick and a placing: the bound holds with them, the lists have none\n",
              out);
    }
    if (is_optimal(best)) {
        wh_style_print(style, out, WH_INK_GOOD, "optimal");
        fputc('\n', out);
    } else if (best->lists) {
        wh_style_print(style, out, WH_INK_WARN, "! ");
        fprintf(out, "not proved: it may be up to %.2g %% above the best%s\n",
                100 * (seconds(best->makespan_us) / seconds(best->bound_us) - 1),
                best->lacks_swaps ? "" : "; --best with more nodes looks further");
    } else {
        wh_style_print(style, out, WH_INK_BAD, "no schedule was found");
        fputs(": --best with more nodes looks further\n", out);
    }
    return ferror(out) ? -1 : 0;
}

static json_t *order_of(const wh_best_result_t *result) {
    json_t *order = json_object();
    for (size_t r = 0; r < result->tool->robot_count; ++r) {
        json_t *lines = json_array();
        for (size_t i = 0; i < result->best->lists[r].count; ++i) {
            const wh_flow_line_t *line = &result->best->lists[r].lines[i];
            json_t *words = json_array();
            wh_json_append(words, wh_json_text(name_of(result, line->from)));
            wh_json_append(words, wh_json_text(name_of(result, line->to)));
            wh_json_append(words, wh_json_text(wafer_of(result, line)));
            wh_json_append(lines, words);
        }
        wh_json_put(order, result->tool->robots[r].name, lines);
    }
    return order;
}

int wh_best_print_json(const wh_best_result_t *result, FILE *out) {
    const wh_flow_best_t *best = result->best;
    json_t *root =
        wh_json_set(json_object(),
                    "format %d script %s rule_s %g best_s %g bound_s %g optimal %i lacks_swaps %i nodes %lld",
                    1, result->script, seconds(result->rule_us), seconds(best->makespan_us),
                    seconds(best->bound_us), is_optimal(best), best->lacks_swaps, (long long)best->nodes);
    wh_json_put(root, "order", best->lists ? order_of(result) : json_null());
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
