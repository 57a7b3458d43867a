/* A study as one JSON object: the content of its page.
 *
 *   format (1), title, version, command (it plays the study again; with " --trial N" after it, one trial)
 *   result    the output of `study --json` (print/study_print.h), with the 100 worst trials
 *   wafers    for each wafer of the study: limits [{ dx, dy, tolerance }]: boxes that the script
 *             expects it in, at its place in the run without errors (mm); histograms { dx, dy, dz, tilt_deg,
 *             off }: { low, high, counts } (mm, deg; null: no figures)
 *   points    for the trials whose lines are kept: trial [], ok [], off [] (mm; null: a wafer is elsewhere),
 *             ends [[dx, dy of each wafer]] (mm; null: elsewhere); `of`: the number of all trials
 */
#ifndef WH_REPORT_STUDY_DOCUMENT_H
#define WH_REPORT_STUDY_DOCUMENT_H

#include <jansson.h>

#include "../study/tally.h"

typedef struct {
    const wh_study_t *study;
    const wh_tally_t *tally; /* all trials, sorted */
    json_t *result;          /* borrowed */
    const char *command;
} wh_study_document_t;

/* 0, or -1 when `out` does not take it. Ends the program if out of memory. */
int wh_study_document_write(const wh_study_document_t *document, FILE *out);

#endif
