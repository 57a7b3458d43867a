/* waferhand csv LOG */
#include <math.h>
#include <stdlib.h>

#include "../log/slice_fields.h"
#include "../print/lines_print.h"
#include "../text/array.h"
#include "apart.h"
#include "app.h"
#include "log_arguments.h"

typedef struct {
    wh_log_arguments_t log;
    wh_log_window_t window;
    uint64_t every;
    const char *output;
} arguments_t;

static const wh_option_t options[] = {
    {"output", 'o', "FILE", "Write the table into FILE (default: standard output)", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, output)},
    {"every", 0, "N", "Of the slices from --from on every N-th alone (default 1)", WH_OPTION_COUNT,
     .variable = offsetof(arguments_t, every), .least = 1},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_log_window_options, offsetof(arguments_t, window), NULL, wh_log_window_check},
    {wh_log_options, offsetof(arguments_t, log), NULL, NULL},
    {0}};

static const wh_command_line_t command_line = {
    .name = "csv",
    .synopsis = "LOG",
    .about = "Writes a recorded run as a table, a row for each slice: axes, valves, vacuum, how near each "
             "gripper is to its wafer, and where each wafer is.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "log",
    .operand_variable = offsetof(arguments_t, log.path)};

typedef struct {
    const arguments_t *arguments;
    FILE *out;
    double *values;
    int64_t first; /* the slice that every N-th is counted from; 0: none yet */
} table_t;

static void on_slice(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     uint64_t hash) {
    table_t *table = user;
    const arguments_t *arguments = table->arguments;
    (void)hash;
    if (!table->values) {
        table->values = wh_array_new(wh_slice_field_count(layout), sizeof *table->values);
        wh_slices_csv_head(layout, table->out);
    }
    if (!wh_log_window_has(&arguments->window, (double)(state->seq * layout->slice_us) / 1e6)) {
        return;
    }
    table->first = table->first > 0 ? table->first : state->seq;
    if ((uint64_t)(state->seq - table->first) % (arguments->every > 0 ? arguments->every : 1) == 0) {
        wh_slice_fields(layout, axes, state, table->values);
        wh_slices_csv_row(layout, state->seq, table->values, table->out);
    }
}

/* The table is made beside its place: of a log that turns out to be none nothing is printed. */
static bool copy(void *user, FILE *out) {
    table_t *table = user;
    char block[1 << 14];
    size_t size = 0;
    rewind(table->out);
    while ((size = fread(block, 1, sizeof block, table->out)) > 0) {
        if (fwrite(block, 1, size, out) != size) {
            return false;
        }
    }
    return !ferror(table->out);
}

static int write_table(const arguments_t *arguments, table_t *table, const wh_log_run_t *run) {
    if (fflush(table->out) != 0 || ferror(table->out)) {
        perror("waferhand csv: no room for the table");
        return WH_EXIT_USAGE;
    }
    if (!wh_file_write("--output", arguments->output, copy, table, NULL)) {
        return WH_EXIT_USAGE;
    }
    if (!arguments->output && !wh_app_is_printed(copy(table, stdout) ? 0 : -1)) {
        return WH_EXIT_USAGE;
    }
    if (!run->cell.is_whole) {
        fprintf(stderr, "%s: %s: what the log itself does not tell of the cell is left out, or empty\n",
                arguments->log.path, run->cell.note);
    }
    return wh_log_arguments_judge(&arguments->log, run);
}

int wh_app_csv(int argc, char **argv) {
    static wh_log_run_t run;
    arguments_t arguments = {.window = {0, HUGE_VAL}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const wh_named_file_t named[] = {{"the log", arguments.log.path, false},
                                     {"the layout", arguments.log.layout, false},
                                     {"--output", arguments.output, true}};
    table_t table = {.arguments = &arguments};
    int status = WH_EXIT_USAGE;
    if (!wh_files_are_apart(named, 3, !arguments.output)) {
        return status;
    }
    table.out = tmpfile();
    if (!table.out) {
        perror("waferhand csv: no room for the table");
        return status;
    }
    if (wh_log_arguments_read(&arguments.log, on_slice, &table, &run) &&
        wh_log_arguments_check_set(&run, NULL) && wh_log_window_begins_in(&arguments.window, &run)) {
        status = write_table(&arguments, &table, &run);
    }
    wh_log_run_close(&run);
    free(table.values);
    (void)fclose(table.out);
    wh_option_list_free(&arguments.log.parameters);
    return status;
}
