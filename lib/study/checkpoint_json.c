/* A study's progress as JSON: which study, which blocks. */
#include <stdlib.h>
#include <string.h>

#include "../math/config.h"
#include "../text/json.h"
#include "checkpoint_internal.h"

static json_t *hex(uint64_t value) {
    return json_sprintf("%016llx", (unsigned long long)value);
}

static json_t *put_parameters(const wh_script_run_options_t *run) {
    json_t *list = json_array();
    for (size_t i = 0; i < run->parameter_count; ++i) {
        json_array_append_new(list, wh_json_text(run->parameters[i]));
    }
    return list;
}

/* In the order in which a difference is told. */
json_t *wh_checkpoint_identity(const wh_study_t *study) {
    json_t *root = json_object();
    int status = 0;
    status |= json_object_set_new(root, "version", json_string(WH_VERSION));
    status |= json_object_set_new(root, "script", wh_json_text(study->run.script));
    status |= json_object_set_new(root, "layout", wh_json_text(study->layout->path));
    status |= json_object_set_new(root, "seed", hex(study->seed));
    status |= json_object_set_new(root, "trials", json_integer((json_int_t)study->trials));
    status |= json_object_set_new(root, "parameters", put_parameters(&study->run));
    status |= json_object_set_new(root, "script_text", hex(study->script_hash));
    status |= json_object_set_new(root, "layout_text", hex(study->layout_hash));
    status |= json_object_set_new(root, "budget", json_integer((json_int_t)study->run.limits.instructions));
    status |= json_object_set_new(root, "memory", json_integer((json_int_t)study->run.limits.memory_bytes));
    status |= json_object_set_new(root, "run_without_errors", hex(study->nominal.record.hash));
    if (status != 0) {
        json_decref(root);
        return NULL;
    }
    return root;
}

/* ------------------------------------------------------------------------------------------------------- blocks */

static json_t *put_blocks(const wh_progress_t *progress) {
    json_t *list = json_array();
    for (uint64_t block = 0; block < progress->block_count; ++block) {
        const uint64_t first = block;
        while (block < progress->block_count && wh_progress_has(progress, block)) {
            ++block;
        }
        if (block > first) {
            json_array_append_new(list, json_pack("[I, I]", (json_int_t)first, (json_int_t)block - 1));
        }
    }
    return list;
}

static bool take_stretch(const json_t *pair, wh_progress_t *progress) {
    const json_int_t first = json_integer_value(json_array_get(pair, 0));
    const json_int_t last = json_integer_value(json_array_get(pair, 1));
    if (json_array_size(pair) != 2 || first < 0 || last < first || (uint64_t)last >= progress->block_count) {
        return false;
    }
    for (uint64_t block = (uint64_t)first; block <= (uint64_t)last; ++block) {
        wh_progress_note(progress, block);
    }
    return true;
}

static uint64_t trials_of(const wh_study_t *study, const wh_progress_t *progress) {
    uint64_t trials = 0;
    for (uint64_t block = 0; block < progress->block_count; ++block) {
        trials += wh_progress_has(progress, block) ? wh_study_block_trials(study, block) : 0;
    }
    return trials;
}

static bool take_progress(const wh_study_t *study, const json_t *root, wh_progress_t *progress) {
    const json_t *blocks = json_object_get(root, "blocks");
    bool sound = json_is_array(blocks);
    for (size_t i = 0; sound && i < json_array_size(blocks); ++i) {
        sound = take_stretch(json_array_get(blocks, i), progress);
    }
    return sound && wh_checkpoint_take_tally(json_object_get(root, "tally"), &progress->tally) &&
           progress->tally.trials == trials_of(study, progress);
}

/* ------------------------------------------------------------------------------------------------- there and back */

char *wh_checkpoint_text(const wh_study_t *study, const wh_progress_t *progress) {
    json_t *root = json_object();
    const int status = json_object_set_new(root, "format", json_integer(1)) |
                       json_object_set_new(root, "study", wh_checkpoint_identity(study)) |
                       json_object_set_new(root, "blocks", put_blocks(progress)) |
                       json_object_set_new(root, "tally", wh_checkpoint_put_tally(&progress->tally));
    char *text = status == 0 ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(root);
    return text;
}

static void describe(const json_t *value, char *text, size_t size) {
    char *dumped = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
    snprintf(text, size, "%.200s", dumped ? dumped : "nothing");
    free(dumped);
}

/* Whether it is this study's; else the first difference. */
static bool is_same(const json_t *found, json_t *expected, char *message, size_t size) {
    const char *key;
    json_t *value;
    json_object_foreach(expected, key, value) {
        const json_t *other = json_object_get(found, key);
        if (!other || !json_equal(other, value)) {
            char one[256];
            char two[256];
            describe(other, one, sizeof one);
            describe(value, two, sizeof two);
            snprintf(message, size, "of another study: its %s is %s (expected %s)", key, one, two);
            return false;
        }
    }
    return true;
}

static bool take(const wh_study_t *study, const json_t *root, wh_progress_t *progress, char *message,
                 size_t size) {
    json_t *identity = wh_checkpoint_identity(study);
    if (!identity || !json_is_object(root) || json_integer_value(json_object_get(root, "format")) != 1) {
        snprintf(message, size, "damaged (expected a study's state)");
        json_decref(identity);
        return false;
    }
    const bool same = is_same(json_object_get(root, "study"), identity, message, size);
    json_decref(identity);
    if (!same) {
        return false;
    }
    wh_progress_t taken;
    wh_progress_init(&taken, study);
    const bool sound = take_progress(study, root, &taken);
    if (sound) {
        wh_progress_merge(progress, &taken);
    } else {
        snprintf(message, size, "damaged (expected a study's state)");
    }
    wh_progress_free(&taken);
    return sound;
}

bool wh_checkpoint_read(const wh_study_t *study, const char *text, size_t size, wh_progress_t *progress,
                        char *message, size_t message_size) {
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, NULL);
    const bool taken = take(study, root, progress, message, message_size);
    json_decref(root);
    return taken;
}
