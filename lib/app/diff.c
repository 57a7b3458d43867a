/* waferhand diff A B */
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "../text/array.h"
#include "../text/json.h"
#include "../text/json_compare.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "diff_side.h"

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

static void check_diff_arguments(const void *given, struct argp_state *state) {
    if (((const arguments_t *)given)->paths.count != 2) {
        argp_error(state, "with what is %s compared? (expected two files)",
                   ((const arguments_t *)given)->paths.items[0]);
    }
}

static const wh_option_table_t tables[] = {{options, 0, NULL, check_diff_arguments}, {0}};

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

/* ------------------------------------------------------------------------------------------------ compare */

/* The reach of the axes is rehearsed when a script is played: for a log it is not known. */
static void leave_reach(const wh_diff_side_t sides[2]) {
    const size_t counts[2] = {json_array_size(json_object_get(sides[0].root, "reach")),
                              json_array_size(json_object_get(sides[1].root, "reach"))};
    if ((counts[0] == 0) != (counts[1] == 0)) {
        fprintf(stderr, "reach: %s does not tell it: left aside\n", sides[counts[0] == 0 ? 0 : 1].path);
        (void)json_object_del(sides[0].root, "reach");
        (void)json_object_del(sides[1].root, "reach");
    }
}

static void compare_documents(const wh_diff_side_t sides[2], result_t *result) {
    leave_reach(sides);
    wh_json_compare(sides[0].root, sides[1].root, wh_diff_aside, on_difference, result);
    const double slice_s = slice_of(sides[0].root);
    if (!isnan(result->time_s) && result->slice == 0 && slice_s > 0) {
        result->slice = (int64_t)floor(result->time_s / slice_s + 0.5);
    }
}

/* Runs of two layouts may be equal, slice by slice, so a difference of the layouts is told first. If a
 * layout's file is missing, its shapes and limits are not known. */
static void compare_layouts(const wh_diff_side_t sides[2], result_t *result) {
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
static bool have_like_fields(const wh_diff_side_t sides[2]) {
    const bool whole[2] = {sides[0].run->cell.is_whole, sides[1].run->cell.is_whole};
    const bool are_alike =
        whole[0] == whole[1] || wh_compare_fields_fit(sides[0].run->cell.layout, sides[1].run->cell.layout);
    if (!are_alike) {
        const wh_diff_side_t *lacks = &sides[whole[0] ? 1 : 0];
        fprintf(stderr, "%s: %s; %s has its layout (expected that of both: --set hands them parameters)\n",
                lacks->path, lacks->run->cell.note, sides[whole[0] ? 0 : 1].path);
    }
    return are_alike;
}

/* True if one of the logs' layouts has read each parameter that is given. */
static bool are_read(const wh_diff_side_t sides[2]) {
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
static bool compare_run(wh_diff_side_t sides[2], size_t number, result_t *result) {
    wh_compare_t found;
    if (!wh_diff_side_read(&sides[0], number) || !wh_diff_side_read(&sides[1], number) || !are_read(sides)) {
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

static bool compare_logs(wh_diff_side_t sides[2], result_t *result) {
    size_t number = 1;
    size_t counts[2] = {0, 0};
    bool read = false;
    do {
        read = compare_run(sides, number, result);
        if (read) {
            counts[0] = sides[0].run->run_count;
            counts[1] = sides[1].run->run_count;
        }
        wh_diff_side_close(&sides[0]);
        wh_diff_side_close(&sides[1]);
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

static bool compare_sides(wh_diff_side_t sides[2], result_t *result) {
    if (!wh_diff_side_open(&sides[0]) || !wh_diff_side_open(&sides[1]) || !wh_diff_sides_are_alike(sides)) {
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

static int diff(const arguments_t *arguments, wh_diff_side_t sides[2]) {
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
        wh_diff_side_t sides[2] = {{.path = arguments.paths.items[0], .parameters = &arguments.parameters},
                                   {.path = arguments.paths.items[1], .parameters = &arguments.parameters}};
        const wh_named_file_t named[] = {{"the first file", sides[0].path, false},
                                         {"the second file", sides[1].path, false}};
        status = wh_files_are_apart(named, 2, true) ? diff(&arguments, sides) : status;
        wh_diff_side_close(&sides[0]);
        wh_diff_side_close(&sides[1]);
    }
    wh_option_list_free(&arguments.paths);
    wh_option_list_free(&arguments.parameters);
    return status;
}
