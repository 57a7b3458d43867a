/* A study's trials as a table, a line each. */
#include <math.h>
#include <stdlib.h>

#include "../text/array.h"
#include "print_internal.h"
#include "study_causes.h"

static void put_head(const wh_study_t *study, FILE *out) {
    static const char *const ends[WH_TRIAL_LINE_ENDS] = {"dX mm", "dY mm", "dz mm", "tilt deg"};
    char name[2 * WH_CAUSE_NAME];
    fputs("trial,ok,whole,ended,missed,errors,complaints,elsewhere,off mm", out);
    for (size_t f = 0; study->has_flow && f < WH_FLOW_SUM_FIGURES; ++f) {
        fprintf(out, ",%s", wh_flow_sum_names[f]);
    }
    for (size_t w = 0; w < study->wafer_count; ++w) {
        for (size_t e = 0; e < WH_TRIAL_LINE_ENDS; ++e) {
            (void)snprintf(name, sizeof name, "%.200s %s", study->layout->wafers[study->wafers[w].wafer].name,
                           ends[e]);
            fputc(',', out);
            wh_print_csv_text(name, out);
        }
    }
    for (size_t i = 0; i < study->drawn_count; ++i) {
        char cause[WH_CAUSE_NAME];
        wh_cause_name(&study->drawn[i], study->layout, cause);
        (void)snprintf(name, sizeof name, "drawn %s", cause);
        fputc(',', out);
        wh_print_csv_text(name, out);
    }
    fputc('\n', out);
}

static void put_numbers(const double values[], size_t count, FILE *out) {
    for (size_t i = 0; i < count; ++i) {
        fputc(',', out);
        wh_print_csv_number(values[i], out);
    }
}

int wh_study_print_csv(const wh_study_result_t *result, FILE *out) {
    const wh_study_t *study = result->study;
    const wh_trial_lines_t *lines = &result->tally->lines;
    const size_t width = study->wafer_count * WH_TRIAL_LINE_ENDS;
    double *drawn = wh_array_new(study->drawn_count, sizeof *drawn);
    put_head(study, out);
    for (size_t i = 0; i < lines->count; ++i) {
        const wh_trial_line_t *line = &lines->lines[i];
        const wh_trial_t trial = {study->seed, line->trial};
        fprintf(out, "%llu,%d,%d,%d,%u,%u,%u,%u", (unsigned long long)line->trial, line->met, line->whole,
                line->ended, line->missed, line->errors, line->complaints, line->elsewhere);
        put_numbers(&line->off, 1, out);
        put_numbers(line->flow, study->has_flow ? WH_FLOW_SUM_FIGURES : 0, out);
        put_numbers(&lines->ends[i * width], width, out);
        wh_causes_draw(study->drawn, study->drawn_count, study->layout, &trial, drawn);
        put_numbers(drawn, study->drawn_count, out);
        fputc('\n', out);
    }
    free(drawn);
    return ferror(out) ? -1 : 0;
}
