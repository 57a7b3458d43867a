#include "diff_side.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../print/record_print.h"
#include "../text/array.h"
#include "log_arguments.h"

/* The newest of results. */
#define FORMAT 2

const char *const wh_diff_aside[] = {"wall_s",  "script", "layout", "title",      "reproduce",
                                     "version", "source", "log",    "never_came", NULL};

/* There must be something to compare besides the format's number and the fields that are left aside. */
static bool is_result(json_t *root) {
    size_t members = json_object_size(root);
    for (size_t i = 0; wh_diff_aside[i]; ++i) {
        members -= json_object_get(root, wh_diff_aside[i]) ? 1 : 0;
    }
    return json_is_integer(json_object_get(root, "format")) && members > 1;
}

/* The scene of --data is called by the script's path. */
static void leave_path(json_t *root) {
    json_t *scene = json_object_get(root, "scene");
    (void)json_object_del(json_array_get(json_object_get(scene, "scenes"), 0), "name");
}

/* True for the verdict on a log that has the whole of what it tells. */
static bool is_whole(const char *verdict) {
    return strcmp(verdict, wh_reading_word(WH_READING_SAME)) == 0 ||
           strcmp(verdict, wh_reading_word(WH_READING_DIFFERS)) == 0;
}

/* Where a result tells what its log is worth: in the record, in the run of a page's data, or, of `replay`,
 * beside all else. */
static const json_t *find_log(const json_t *root) {
    const json_t *run = json_object_get(root, "run");
    const json_t *log = json_object_get(json_is_object(run) ? run : root, "log");
    return json_is_object(log) || json_is_object(run) ? log : root;
}

/* A result may be that of a log: one that lacks something is never equal to another. */
static bool is_of_whole_log(const wh_diff_side_t *side) {
    const json_t *log = find_log(side->root);
    const char *verdict = json_string_value(json_object_get(log, "verdict"));
    const char *reason = json_string_value(json_object_get(log, "reason"));
    if (verdict && !is_whole(verdict)) {
        fprintf(stderr, "%s: %s: %s (expected the result of a whole log)\n", side->path, verdict,
                reason ? reason : "no reason");
    } else if (json_is_true(json_object_get(log, "is_part"))) {
        fprintf(stderr, "%s: of a part of a recording (expected the result of a whole recording)\n",
                side->path);
        return false;
    }
    return !verdict || is_whole(verdict);
}

static bool read_json(wh_diff_side_t *side, FILE *file) {
    json_error_t error;
    side->root = json_loadf(file, JSON_REJECT_DUPLICATES, &error);
    if (!side->root) {
        fprintf(stderr, "%s: line %d: %s (expected an LCM event log, or what --json or --data made)\n",
                side->path, error.line, error.text);
    } else if (!is_result(side->root)) {
        fprintf(stderr, "%s: no result of ours (expected what --json or --data made)\n", side->path);
    }
    leave_path(side->root);
    const json_int_t format = json_integer_value(json_object_get(side->root, "format"));
    if (side->root && is_result(side->root) && (format < 1 || format > FORMAT)) {
        fprintf(stderr, "%s: format: %lld (expected 1 to %d)\n", side->path, (long long)format, FORMAT);
        return false;
    }
    return side->root && is_result(side->root) && is_of_whole_log(side);
}

bool wh_diff_side_open(wh_diff_side_t *side) {
    static const unsigned char sync[4] = {0xED, 0xA1, 0xDA, 0x01};
    unsigned char begin[8];
    const char *fault = NULL;
    FILE *file = wh_log_file(side->path, &fault);
    if (!file) {
        fprintf(stderr, "%s: %s (expected an LCM event log, or what --json or --data made)\n", side->path,
                fault);
        return false;
    }
    const size_t size = fread(begin, 1, sizeof begin, file);
    side->is_log =
        wh_log_is_packed(begin, size) || (size >= sizeof sync && memcmp(begin, sync, sizeof sync) == 0);
    rewind(file);
    if (size == 0) {
        fprintf(stderr, "%s: empty (expected an LCM event log, or what --json or --data made)\n", side->path);
    }
    const bool read = size > 0 && (side->is_log || read_json(side, file));
    (void)fclose(file);
    return read;
}

static void close_run(wh_diff_side_t *side) {
    wh_log_digests_free(&side->digests);
    if (side->run) {
        wh_log_run_close(side->run);
        free(side->run);
    }
    side->run = NULL;
}

/* With `count` of the given parameters. */
static bool read_run(wh_diff_side_t *side, size_t number, size_t count) {
    wh_log_run_options_t wanted = {
        .path = side->path, .number = number, .layout = {NULL, side->parameters->items, count}};
    side->run = wh_array_new(1, sizeof *side->run);
    return wh_compare_read(side->run, &wanted, &side->digests);
}

/* Both logs may be of one layout's file with other parameters. */
static bool read_with_layout(wh_diff_side_t *side, size_t number) {
    const size_t count = side->parameters->count;
    bool read = read_run(side, number, count);
    if (read && count > 0 && !side->run->cell.is_whole) {
        close_run(side);
        read = read_run(side, number, 0);
    }
    return read;
}

bool wh_diff_side_read(wh_diff_side_t *side, size_t number) {
    if (!read_with_layout(side, number)) {
        fprintf(stderr, "%s\n", side->run->message);
        return false;
    }
    const char *verdict = side->run->worth.verdict;
    if (!is_whole(verdict)) {
        fprintf(stderr, "%s: %s: %s (expected a whole log)\n", side->path, verdict, side->run->worth.reason);
        return false;
    }
    if (side->run->worth.is_part) {
        fprintf(stderr, "%s: part %d of a recording: %s not read (expected a whole recording)\n", side->path,
                (int)side->run->worth.part, wh_log_missing_parts(side->run));
        return false;
    }
    side->root = wh_record_to_json(&side->run->record);
    return true;
}

void wh_diff_side_close(wh_diff_side_t *side) {
    json_decref(side->root);
    close_run(side);
    side->root = NULL;
}

/* A file of --data has the record in a member of its own. */
static bool is_data(const wh_diff_side_t *side) {
    return json_object_get(side->root, "tracks") != NULL;
}

bool wh_diff_sides_are_alike(const wh_diff_side_t sides[2]) {
    if (sides[0].is_log != sides[1].is_log) {
        fprintf(stderr, "%s and %s: one is a log, the other is not (expected two of one kind)\n",
                sides[0].path, sides[1].path);
    } else if (is_data(&sides[0]) != is_data(&sides[1])) {
        fprintf(stderr, "%s and %s: one is of --data, the other is not (expected two of one kind)\n",
                sides[0].path, sides[1].path);
    }
    return sides[0].is_log == sides[1].is_log && is_data(&sides[0]) == is_data(&sides[1]);
}
