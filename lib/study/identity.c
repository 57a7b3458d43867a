#include "identity.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/json.h"
#include "../text/output.h"

/* ------------------------------------------------------------------------------------------------- places */

/* Where a file is, or would be, without links and dots. If its folder is not there, as it was typed. */
static void find_place(const char *path, char place[PATH_MAX]) {
    if (!realpath(path, place) && !wh_output_resolve(path, place)) {
        (void)snprintf(place, PATH_MAX, "%s", path);
    }
}

/* The path from the folder of `from`; both are places. */
static void tell_way(const char *from, const char *to, char way[PATH_MAX]) {
    size_t same = 0;
    for (size_t i = 0; from[i] != '\0' && from[i] == to[i]; ++i) {
        same = from[i] == '/' ? i + 1 : same;
    }
    size_t length = 0;
    for (const char *c = from + same; *c != '\0' && length + 4 < PATH_MAX; ++c) {
        if (*c == '/') {
            length += (size_t)snprintf(way + length, PATH_MAX - length, "../");
        }
    }
    (void)snprintf(way + length, PATH_MAX - length, "%s", to + same);
}

/* ----------------------------------------------------------------------------------------------- identity */

static json_t *parameter(const void *subject, size_t i) {
    return wh_json_text(((const wh_script_run_options_t *)subject)->parameters[i]);
}

static uint64_t hash_of(const wh_study_t *study, const char *path) {
    uint64_t hash = 0;
    for (size_t i = 0; i < study->input_count; ++i) {
        hash = strcmp(study->inputs[i].path, path) == 0 ? study->inputs[i].hash : hash;
    }
    return hash;
}

/* The hash of each file that was read but the script, by its way from there. */
static json_t *files_of(const wh_study_t *study) {
    char script[PATH_MAX];
    json_t *files = json_object();
    find_place(study->run.script, script);
    for (size_t i = 0; i < study->input_count; ++i) {
        char place[PATH_MAX];
        char way[PATH_MAX];
        find_place(study->inputs[i].path, place);
        tell_way(script, place, way);
        if (strcmp(place, script) != 0) {
            wh_json_put(files, way, wh_json_hash(study->inputs[i].hash));
        }
    }
    return files;
}

/* In the order in which a difference is told. */
json_t *wh_study_identity(const wh_study_t *study) {
    const wh_script_run_options_t *run = &study->run;
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:I, s:I, s:o}", "version", WH_VERSION, "script",
                     wh_json_hash(hash_of(study, run->script)), "seed", wh_json_hash(study->seed),
                     "parameters", wh_json_list(parameter, run, run->parameter_count), "files",
                     files_of(study), "budget", (json_int_t)run->limits.instructions, "memory",
                     (json_int_t)run->limits.memory_bytes, "run_without_errors",
                     wh_json_hash(study->nominal.record.hash));
}

/* --------------------------------------------------------------------------------------------- difference */

/* The first file that differs between the two; null: none. */
static const char *find_changed(json_t *found, json_t *expected) {
    json_t *const both[2] = {expected, found};
    for (int i = 0; i < 2; ++i) {
        const char *path;
        json_t *hash;
        json_object_foreach(both[i], path, hash) {
            if (!json_equal(hash, json_object_get(both[1 - i], path))) {
                return path;
            }
        }
    }
    return NULL;
}

static void tell_difference(const char *key, json_t *found, json_t *expected, char *message, size_t size) {
    const char *changed =
        json_is_object(expected) && json_is_object(found) ? find_changed(found, expected) : NULL;
    char *one = found ? json_dumps(found, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
    char *two = json_dumps(expected, JSON_ENCODE_ANY | JSON_COMPACT);
    if (changed) {
        snprintf(message, size, "of another study: %.900s has changed since (expected the same files)",
                 changed);
    } else if (strcmp(key, "script") == 0) {
        snprintf(message, size,
                 "of another study: its script is another one, or has changed since: its hash is %.200s "
                 "(expected %.200s)",
                 one ? one : "nothing", two);
    } else {
        snprintf(message, size, "of another study: its %s is %.200s (expected %.200s)", key,
                 one ? one : "nothing", two);
    }
    free(one);
    free(two);
}

bool wh_study_is_same(const json_t *found, const wh_study_t *study, char *message, size_t size) {
    json_t *expected = wh_study_identity(study);
    const char *key;
    json_t *value;
    bool same = true;
    json_object_foreach(expected, key, value) {
        json_t *other = json_object_get(found, key);
        if (same && !json_equal(other, value)) {
            tell_difference(key, other, value, message, size);
            same = false;
        }
    }
    json_decref(expected);
    return same;
}
