/* waferhand diff A B */
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "../log/compare.h"
#include "../print/record_print.h"
#include "../text/array.h"
#include "../text/json.h"
#include "../text/json_compare.h"
#include "../text/options.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "log_arguments.h"

/* The newest of results. */
#define FORMAT 2

/* The most differences at the end that are told one by one. */
#define MOST_TOLD 20

typedef struct {
    wh_option_list_t paths, parameters;
    bool json;
} arguments_t;

static const wh_option_t options[] = {
    {"json", 0, NULL, "Print the result as one JSON object", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, json)},
    {"set", 0, "NAME=VALUE",
     "Hand the layout of a log that was recorded with it a parameter, params.NAME: a number if VALUE is one, "
     "true, false or text",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, parameters)},
    {0}};

static void check(const void *given, struct argp_state *state) {
    if (((const arguments_t *)given)->paths.count != 2) {
        argp_error(state, "with what is %s compared? (expected two files)",
                   ((const arguments_t *)given)->paths.items[0]);
    }
}

static const wh_option_table_t tables[] = {{options, 0, NULL, check}, {0}};

static const wh_command_line_t command_line = {
    .name = "diff",
    .synopsis = "A B",
    .about =
        "Compares two runs: two LCM event logs, two results of --json, or two files of --data. Names the "
        "first slice and field that differ, and what differs at the end.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "file",
    .operand_variable = offsetof(arguments_t, paths),
    .operands = 2};

/* The fields that do not belong to the run itself: how long it took, where files lie, which program made
 * it, and what motion control alone knows. */
static const char *const aside[] = {"wall_s",  "script", "layout", "title",      "reproduce",
                                    "version", "source", "log",    "never_came", NULL};

/* The first difference, and those at the end. */
typedef struct {
    int64_t slice; /* 0: it has none */
    double time_s; /* NaN: none differs in time */
    char *field, *values[2];
    json_t *end;                        /* a list of differences without a certain time: field, a, b */
    size_t end_count;                   /* all of them */
    bool has_other_layout;              /* the first of them: the layouts' hashes */
    int64_t common, differing, only[2]; /* slices */
} result_t;

/* --------------------------------------------------------------------------------------------------- JSON */

static char *word_of(const json_t *value) {
    char *text = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    return text ? text : wh_text_copy("not there");
}

static void set_first(result_t *result, const char *field, char *a, char *b) {
    free(result->field);
    free(result->values[0]);
    free(result->values[1]);
    result->field = wh_text_copy(field);
    result->values[0] = a;
    result->values[1] = b;
}

/* A missing value differs from null. */
static json_t *shared(const json_t *value) {
    return value ? json_deep_copy(value) : json_string("not there");
}

static void on_difference(void *user, const wh_json_difference_t *difference) {
    result_t *result = user;
    const bool is_timed = !isnan(difference->time_s);
    if (is_timed && result->slice == 0 && (isnan(result->time_s) || difference->time_s < result->time_s)) {
        result->time_s = difference->time_s;
        set_first(result, difference->path, word_of(difference->a), word_of(difference->b));
    }
    if (!is_timed && result->end_count++ < MOST_TOLD) {
        wh_json_append(result->end, wh_json_add(json_object(), "field a b", wh_json_text(difference->path),
                                                shared(difference->a), shared(difference->b), NULL));
    }
}

/* The length of a slice, s; 0: the document does not tell it. */
static double slice_of(const json_t *root) {
    const json_t *slice_s = json_object_get(root, "slice_s");
    const double slices = json_number_value(json_object_get(root, "slices"));
    return slice_s      ? json_number_value(slice_s)
           : slices > 0 ? json_number_value(json_object_get(root, "simulated_s")) / slices
                        : 0;
}

/* -------------------------------------------------------------------------------------------------- files */

typedef struct {
    const char *path;
    const wh_option_list_t *parameters;
    bool is_log;
    json_t *root;
    wh_log_run_t *run; /* null: JSON */
    wh_log_digests_t digests;
} side_t;

/* There must be something to compare besides the format's number and the fields that are left aside. */
static bool is_result(json_t *root) {
    size_t members = json_object_size(root);
    for (size_t i = 0; aside[i]; ++i) {
        members -= json_object_get(root, aside[i]) ? 1 : 0;
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
static bool is_of_whole_log(const side_t *side) {
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

static bool read_json(side_t *side, FILE *file) {
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

static bool open_side(side_t *side) {
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

static void close_run(side_t *side) {
    wh_log_digests_free(&side->digests);
    if (side->run) {
        wh_log_run_close(side->run);
        free(side->run);
    }
    side->run = NULL;
}

/* With `count` of the given parameters. */
static bool read_run(side_t *side, size_t number, size_t count) {
    wh_log_run_options_t wanted = {
        .path = side->path, .number = number, .layout = {NULL, side->parameters->items, count}};
    side->run = wh_array_new(1, sizeof *side->run);
    return wh_compare_read(side->run, &wanted, &side->digests);
}

/* Both logs may be of one layout's file with other parameters. */
static bool read_with_layout(side_t *side, size_t number) {
    const size_t count = side->parameters->count;
    bool read = read_run(side, number, count);
    if (read && count > 0 && !side->run->cell.is_whole) {
        close_run(side);
        read = read_run(side, number, 0);
    }
    return read;
}

/* A log that lacks something is never equal to another. */
static bool read_log(side_t *side, size_t number) {
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

static void close_side(side_t *side) {
    json_decref(side->root);
    close_run(side);
    side->root = NULL;
}

/* ------------------------------------------------------------------------------------------------ compare */

/* The reach of the axes is rehearsed when a script is played: for a log it is not known. */
static void leave_reach(const side_t sides[2]) {
    const size_t counts[2] = {json_array_size(json_object_get(sides[0].root, "reach")),
                              json_array_size(json_object_get(sides[1].root, "reach"))};
    if ((counts[0] == 0) != (counts[1] == 0)) {
        fprintf(stderr, "reach: %s does not tell it: left aside\n", sides[counts[0] == 0 ? 0 : 1].path);
        (void)json_object_del(sides[0].root, "reach");
        (void)json_object_del(sides[1].root, "reach");
    }
}

static void compare_documents(const side_t sides[2], result_t *result) {
    leave_reach(sides);
    wh_json_compare(sides[0].root, sides[1].root, aside, on_difference, result);
    const double slice_s = slice_of(sides[0].root);
    if (!isnan(result->time_s) && result->slice == 0 && slice_s > 0) {
        result->slice = (int64_t)floor(result->time_s / slice_s + 0.5);
    }
}

/* Runs of two layouts may be equal, slice by slice, so a difference of the layouts is told first. If a
 * layout's file is missing, its shapes and limits are not known. */
static void compare_layouts(const side_t sides[2], result_t *result) {
    const wh_told_layout_t *a = &sides[0].run->cell;
    const wh_told_layout_t *b = &sides[1].run->cell;
    for (size_t i = 0; i < 2; ++i) {
        if (!sides[i].run->cell.is_whole) {
            fprintf(stderr, "%s: shapes are the defaults of 300 mm wafers: %s\n", sides[i].path,
                    sides[i].run->cell.note);
        }
    }
    if (a->hash != b->hash || a->world_hash != b->world_hash) {
        const bool is_cell = a->hash != b->hash;
        json_t *one = wh_json_hash(is_cell ? a->hash : a->world_hash);
        json_t *other = wh_json_hash(is_cell ? b->hash : b->world_hash);
        const wh_json_difference_t difference = {is_cell ? "layout_hash" : "world_hash", one, other,
                                                 (double)NAN};
        result->has_other_layout = true;
        on_difference(result, &difference);
        json_decref(one);
        json_decref(other);
    }
}

/* Names and number of a slice's fields go by the layout: without that of one log they are no longer alike. */
static bool have_like_fields(const side_t sides[2]) {
    const bool whole[2] = {sides[0].run->cell.is_whole, sides[1].run->cell.is_whole};
    const bool are_alike =
        whole[0] == whole[1] || wh_compare_fields_fit(sides[0].run->cell.layout, sides[1].run->cell.layout);
    if (!are_alike) {
        const side_t *lacks = &sides[whole[0] ? 1 : 0];
        fprintf(stderr, "%s: %s; %s has its layout (expected that of both: --set hands them parameters)\n",
                lacks->path, lacks->run->cell.note, sides[whole[0] ? 0 : 1].path);
    }
    return are_alike;
}

/* True if one of the logs' layouts has read each parameter that is given. */
static bool are_read(const side_t sides[2]) {
    const wh_option_list_t *given = sides[0].parameters;
    for (size_t i = 0; i < given->count; ++i) {
        bool is_read = false;
        for (size_t s = 0; s < 2; ++s) {
            const wh_log_run_t *run = sides[s].run;
            is_read = is_read || (run->cell.is_whole && run->options.layout.parameter_count > 0 &&
                                  !wh_sandbox_is_unread(run->cell.sandbox, given->items[i]));
        }
        if (!is_read) {
            fprintf(stderr,
                    "--set %s: no log's layout has read it (expected one with which a log was recorded)\n",
                    given->items[i]);
            return false;
        }
    }
    return true;
}

/* One run of each; nothing of an earlier run may differ. */
static bool compare_run(side_t sides[2], size_t number, result_t *result) {
    wh_compare_t found;
    if (!read_log(&sides[0], number) || !read_log(&sides[1], number) || !are_read(sides)) {
        return false;
    }
    wh_log_run_t *const runs[2] = {sides[0].run, sides[1].run};
    compare_layouts(sides, result);
    const wh_log_digests_t digests[2] = {sides[0].digests, sides[1].digests};
    if (!wh_compare_runs(runs, digests, &found)) {
        fprintf(stderr, "%s\n%s\n", runs[0]->message, runs[1]->message);
        return false;
    }
    if (found.differing > 0 && !have_like_fields(sides)) {
        return false;
    }
    result->common += found.common;
    result->differing += found.differing;
    result->only[0] += found.only[0];
    result->only[1] += found.only[1];
    if (found.slice > 0) {
        result->slice = found.slice;
        result->time_s = found.time_s;
        set_first(result, found.field, wh_text_copy(found.values[0]), wh_text_copy(found.values[1]));
    }
    compare_documents(sides, result);
    return true;
}

static bool is_same(const result_t *result) {
    return !result->field && result->end_count == 0;
}

static void compare_counts(const size_t counts[2], size_t compared, result_t *result) {
    if (counts[0] > 1 || counts[1] > 1) {
        fprintf(stderr, "compared: the first %zu of %zu and %zu runs\n", compared, counts[0], counts[1]);
    }
    if (counts[0] != counts[1]) {
        json_t *a = json_integer((json_int_t)counts[0]);
        json_t *b = json_integer((json_int_t)counts[1]);
        const wh_json_difference_t difference = {"runs", a, b, (double)NAN};
        on_difference(result, &difference);
        json_decref(a);
        json_decref(b);
    }
}

static bool compare_logs(side_t sides[2], result_t *result) {
    size_t number = 1;
    size_t counts[2] = {0, 0};
    bool read = false;
    do {
        read = compare_run(sides, number, result);
        if (read) {
            counts[0] = sides[0].run->run_count;
            counts[1] = sides[1].run->run_count;
        }
        close_side(&sides[0]);
        close_side(&sides[1]);
        ++number;
    } while (read && is_same(result) && number <= counts[0] && number <= counts[1]);
    if (read) {
        compare_counts(counts, number - 1, result);
    }
    return read;
}

/* -------------------------------------------------------------------------------------------------- print */

static void print_end(const result_t *result) {
    size_t i = 0;
    json_t *difference = NULL;
    json_array_foreach(result->end, i, difference) {
        char *a = word_of(json_object_get(difference, "a"));
        char *b = word_of(json_object_get(difference, "b"));
        fputs("at the end: ", stdout);
        wh_style_put(stdout, json_string_value(json_object_get(difference, "field")));
        fputs(": ", stdout);
        wh_style_put(stdout, a);
        fputs(" against ", stdout);
        wh_style_put(stdout, b);
        putchar('\n');
        free(a);
        free(b);
    }
    if (result->end_count > MOST_TOLD) {
        printf("and %zu more\n", result->end_count - MOST_TOLD);
    }
}

static void print_table(const result_t *result) {
    if (result->has_other_layout) {
        puts("the layouts differ: their hashes are below");
    }
    if (result->field) {
        if (result->slice > 0) {
            printf("slice %" PRId64 ", ", result->slice);
        }
        printf("%.6f s: ", result->time_s);
        wh_style_put(stdout, result->field);
        fputs(": ", stdout);
        wh_style_put(stdout, result->values[0]);
        fputs(" against ", stdout);
        wh_style_put(stdout, result->values[1]);
        putchar('\n');
    }
    if (result->differing > 0) {
        printf("%" PRId64 " of %" PRId64 " slices that both have differ\n", result->differing,
               result->common);
    }
    for (size_t i = 0; i < 2; ++i) {
        if (result->only[i] > 0) {
            printf("slices that the %s alone has: %" PRId64 "\n", i == 0 ? "first" : "second",
                   result->only[i]);
        }
    }
    print_end(result);
    puts(is_same(result) ? "same" : "differs");
}

static int print_json(const result_t *result) {
    json_t *first = json_null();
    if (result->field) {
        first = wh_json_set(json_object(), "slice %lld time_s %g field %s a %s b %s",
                            result->slice > 0 ? (json_int_t)result->slice : WH_JSON_NONE, result->time_s,
                            result->field, result->values[0], result->values[1]);
    }
    json_t *root =
        wh_json_add(json_object(),
                    "format same slices_compared slices_differing slices_of_a_alone slices_of_b_alone first "
                    "end end_count",
                    json_integer(1), json_boolean(is_same(result)), json_integer((json_int_t)result->common),
                    json_integer((json_int_t)result->differing), json_integer((json_int_t)result->only[0]),
                    json_integer((json_int_t)result->only[1]), first, json_incref(result->end),
                    json_integer((json_int_t)result->end_count), NULL);
    const int status = wh_json_print(root, stdout);
    json_decref(root);
    return status;
}

/* A file of --data has the record in a member of its own. */
static bool is_data(const side_t *side) {
    return json_object_get(side->root, "tracks") != NULL;
}

static bool are_of_one_kind(const side_t sides[2]) {
    if (sides[0].is_log != sides[1].is_log) {
        fprintf(stderr, "%s and %s: one is a log, the other is not (expected two of one kind)\n",
                sides[0].path, sides[1].path);
    } else if (is_data(&sides[0]) != is_data(&sides[1])) {
        fprintf(stderr, "%s and %s: one is of --data, the other is not (expected two of one kind)\n",
                sides[0].path, sides[1].path);
    }
    return sides[0].is_log == sides[1].is_log && is_data(&sides[0]) == is_data(&sides[1]);
}

static bool compare_sides(side_t sides[2], result_t *result) {
    if (!open_side(&sides[0]) || !open_side(&sides[1]) || !are_of_one_kind(sides)) {
        return false;
    }
    if (sides[0].is_log) {
        return compare_logs(sides, result);
    }
    if (sides[0].parameters->count > 0) {
        fprintf(stderr, "--set: these are no logs (expected two logs)\n");
        return false;
    }
    compare_documents(sides, result);
    return true;
}

static int print(const arguments_t *arguments, const result_t *result) {
    int printed = 0;
    if (arguments->json) {
        printed = print_json(result);
    } else {
        print_table(result);
    }
    if (!wh_app_is_printed(printed)) {
        return WH_EXIT_USAGE;
    }
    return is_same(result) ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int diff(const arguments_t *arguments, side_t sides[2]) {
    result_t result = {.time_s = (double)NAN, .end = json_array()};
    const int status = compare_sides(sides, &result) ? print(arguments, &result) : WH_EXIT_USAGE;
    json_decref(result.end);
    free(result.field);
    free(result.values[0]);
    free(result.values[1]);
    return status;
}

int wh_app_diff(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    int status = WH_EXIT_USAGE;
    if (arguments.paths.count == 2) {
        side_t sides[2] = {{.path = arguments.paths.items[0], .parameters = &arguments.parameters},
                           {.path = arguments.paths.items[1], .parameters = &arguments.parameters}};
        const wh_named_file_t named[] = {{"the first file", sides[0].path, false},
                                         {"the second file", sides[1].path, false}};
        status = wh_files_are_apart(named, 2, true) ? diff(&arguments, sides) : status;
        close_side(&sides[0]);
        close_side(&sides[1]);
    }
    wh_option_list_free(&arguments.paths);
    wh_option_list_free(&arguments.parameters);
    return status;
}
