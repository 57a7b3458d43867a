/* waferhand csv LOG */
#include <errno.h>
#include <math.h>

#include "../log/slice_fields.h"
#include "../print/slices_csv.h"
#include "../text/output.h"
#include "apart.h"
#include "app.h"
#include "log_arguments.h"

typedef struct {
    wh_log_arguments_t log;
    wh_log_window_t window;
    uint64_t every;
    const char *output;
} arguments_t;

static const wh_option_t options[] = {{"output", 'o', "FILE",
                                       "Write the table into FILE (default: standard output)", WH_OPTION_TEXT,
                                       .variable = offsetof(arguments_t, output)},
                                      {"every", 0, "N", "Write every N-th slice from --from on (default 1)",
                                       WH_OPTION_COUNT, .variable = offsetof(arguments_t, every), .least = 1},
                                      {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_log_window_options, offsetof(arguments_t, window), NULL, wh_log_window_check},
    {wh_log_options, offsetof(arguments_t, log), NULL, NULL},
    {wh_log_more_options, offsetof(arguments_t, log.more), NULL, NULL},
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
    const wh_log_run_t *run;
    FILE *out;
    wh_slices_csv_t csv;
    wh_slice_row_t row;
    bool has_begun, is_refused; /* the latter: a parameter is given that nobody reads */
    int64_t first;              /* the slice that every N-th is counted from; 0: no row yet */
} table_t;

/* Larger blocks than stdio's own are written faster. */
#define BLOCK (1 << 16)

static void on_slice(void *user, const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     uint64_t hash) {
    table_t *table = user;
    const arguments_t *arguments = table->arguments;
    (void)hash;
    if (!table->has_begun) { /* the log's layout is known from here on */
        table->has_begun = true;
        table->is_refused = !wh_log_arguments_check_set(table->run, NULL);
    }
    if (table->is_refused ||
        !wh_log_window_has(&arguments->window, (double)(state->seq * layout->slice_us) / 1e6)) {
        return;
    }
    if (table->first == 0) {
        table->first = state->seq;
        wh_slices_csv_open(&table->csv, layout, table->out);
    }
    if ((uint64_t)(state->seq - table->first) % (arguments->every > 0 ? arguments->every : 1) == 0) {
        wh_slice_row_take(&table->row, layout, axes, state);
        wh_slices_csv_row(&table->csv, state->seq, table->row.values);
    }
}

/* Reads the log, and writes the rows while it does so; nothing before the first row, so that a log that is
 * refused prints nothing. False, and standard error says why, if there is nothing to show. */
static bool write_rows(table_t *table, FILE *out, wh_log_run_t *run) {
    const arguments_t *arguments = table->arguments;
    table->out = out;
    static char block[BLOCK]; /* glibc takes no size without room */
    (void)setvbuf(out, block, _IOFBF, sizeof block);
    if (!wh_log_arguments_read(&arguments->log, on_slice, table, run) || table->is_refused ||
        !wh_log_window_begins_in(&arguments->window, run)) {
        return false;
    }
    if (table->first == 0) {
        wh_slices_csv_open(&table->csv, run->cell.layout, table->out);
    }
    return true;
}

static bool write_file(table_t *table, wh_log_run_t *run) {
    const char *path = table->arguments->output;
    wh_output_t output = {0};
    if (!wh_output_open(&output, path)) {
        wh_output_tell("--output", path, errno);
        return false;
    }
    const bool is_written = write_rows(table, output.file, run) && wh_file_is_free("--output", path);
    if (!is_written) {
        wh_output_drop(&output);
    } else if (!wh_output_commit(&output)) {
        wh_output_tell("--output", path, errno);
        return false;
    }
    return is_written;
}

static bool write_table(table_t *table, wh_log_run_t *run) {
    if (table->arguments->output) {
        return write_file(table, run);
    }
    return write_rows(table, stdout, run) && wh_app_is_printed(0);
}

static int judge_log(const arguments_t *arguments, const wh_log_run_t *run) {
    if (!run->cell.is_whole) {
        fprintf(stderr, "%s: %s: what the log itself does not tell of the cell is left out, or empty\n",
                arguments->log.path, run->cell.note);
    }
    return wh_log_arguments_judge(&arguments->log, run);
}

int wh_app_csv(int argc, char **argv) {
    static wh_log_run_t run;
    arguments_t arguments = {.log.only_slices = true, .window = {0, HUGE_VAL}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const wh_named_file_t named[] = {{"the log", arguments.log.path, false},
                                     {"the layout", arguments.log.layout, false},
                                     {"--output", arguments.output, true}};
    table_t table = {.arguments = &arguments, .run = &run};
    int status = WH_EXIT_USAGE;
    if (wh_files_are_apart(named, 3, !arguments.output) && write_table(&table, &run)) {
        status = judge_log(&arguments, &run);
    }
    wh_slices_csv_close(&table.csv);
    wh_log_run_close(&run);
    wh_slice_row_free(&table.row);
    wh_option_list_free(&arguments.log.parameters);
    wh_option_list_free(&arguments.log.more.then);
    return status;
}
