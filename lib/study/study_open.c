/* What all trials of a study share. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "study.h"

uint64_t wh_study_blocks(const wh_study_t *study) {
    return (study->trials + WH_STUDY_BLOCK - 1) / WH_STUDY_BLOCK;
}

uint64_t wh_study_block_trials(const wh_study_t *study, uint64_t block) {
    const uint64_t left = study->trials - block * WH_STUDY_BLOCK;
    return left < WH_STUDY_BLOCK ? left : WH_STUDY_BLOCK;
}

static bool refuse(const char *path, const char *text) {
    fprintf(stderr, "%s: %s\n", path, text);
    return false;
}

static bool hash_file(const char *path, uint64_t *hash) {
    FILE *file = fopen(path, "r");
    if (!file) {
        return refuse(path, strerror(errno));
    }
    *hash = WH_HASH_START;
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        *hash = wh_hash_word(*hash, (uint64_t)c);
    }
    fclose(file);
    return true;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static bool is_known(const wh_study_t *study, int32_t wafer) {
    bool known = false;
    for (size_t i = 0; i < study->wafer_count; ++i) {
        known = known || study->wafers[i].wafer == wafer;
    }
    return known;
}

/* Those that the run without errors takes, in that order. */
static void choose_wafers(wh_study_t *study) {
    const wh_record_t *record = &study->nominal.record;
    for (size_t i = 0; i < record->event_count && study->wafer_count < WH_STUDY_WAFERS; ++i) {
        const wh_event_t *event = &record->events[i].event;
        if (event->kind == WH_EVENT_PICKED && event->wafer != WH_NONE && !is_known(study, event->wafer)) {
            const wh_wafer_record_t *end = &record->wafers[event->wafer];
            study->wafers[study->wafer_count++] = (wh_study_wafer_t){event->wafer, end->holder, end->place};
        }
    }
}

/* ------------------------------------------------------------------------------------------------ opening */

bool wh_study_open(wh_study_t *study) {
    wh_script_run_options_t options = study->run;
    options.decisions = &study->decisions;
    if (wh_script_run(&study->nominal, &options) == WH_RUN_BAD_INPUT) {
        fprintf(stderr, "%s\n", study->nominal.message);
        return false;
    }
    study->layout = study->nominal.mcs.layout;
    if (!study->layout || !study->nominal.record.wafers) {
        return refuse(study->run.script, "no cell (expected cell \"LAYOUT.lua\")");
    }
    if (!study->layout->errors) {
        return refuse(study->layout->path, "study: nil (expected what is drawn, as study = { placement = { "
                                           "dx = 0.3 } }, here or in the script)");
    }
    study->whole = study->layout->collision ? "collisions are looked for" : study->decisions.unfit;
    choose_wafers(study);
    return hash_file(study->run.script, &study->script_hash) &&
           hash_file(study->layout->path, &study->layout_hash);
}

void wh_study_close(wh_study_t *study) {
    wh_decisions_free(&study->decisions);
    wh_script_run_close(&study->nominal);
}
