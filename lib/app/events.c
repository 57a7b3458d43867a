/* waferhand events LOG */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "../link/node.h"
#include "../print/lines_print.h"
#include "../text/nearest.h"
#include "apart.h"
#include "app.h"
#include "events_live.h"
#include "log_arguments.h"

typedef struct {
    wh_log_arguments_t log;
    wh_log_window_t window;
    wh_option_list_t wafers, kinds;
    const char *url;
    bool lcm;
} arguments_t;

static const wh_option_t options[] = {
    {"wafer", 0, "NAME", "Show events of this wafer alone; may be given several times", WH_OPTION_LIST,
     .variable = offsetof(arguments_t, wafers)},
    {"kind", 0, "KIND", "Show events of this kind alone, such as picked; may be given several times",
     WH_OPTION_LIST, .variable = offsetof(arguments_t, kinds)},
    {"lcm", 0, NULL, "Show events live, from the simulator on LCM, until Ctrl-C", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --lcm", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {0}};

/* Refuses a kind that there is not. */
static void check_kinds(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    const char *names[WH_EVENT_KINDS];
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        names[kind] = wh_event_name((wh_event_kind_t)kind);
    }
    for (size_t i = 0; i < arguments->kinds.count; ++i) {
        const char *word = arguments->kinds.items[i];
        bool is_known = false;
        for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
            is_known = is_known || strcmp(word, names[kind]) == 0;
        }
        if (!is_known) {
            char meant[WH_NEAREST_TEXT];
            argp_error(state, "--kind: %s (expected the kind of an event%s)", word,
                       wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(word, names, WH_EVENT_KINDS)));
        }
    }
}

/* True if an option is given that needs a log. */
static bool is_of_log(const wh_log_arguments_t *log) {
    return log->layout || log->number > 0 || log->parameters.count > 0 || log->more.is_alone ||
           log->more.then.count > 0;
}

static void check_events_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    const bool of_log = is_of_log(&arguments->log);
    if (!arguments->lcm && !arguments->log.path) {
        argp_error(state, "of which log? (expected one, or --lcm)");
    } else if (arguments->lcm && (arguments->log.path || of_log)) {
        argp_error(state, "--lcm: it goes with no log, and with nothing that is of one");
    } else if (arguments->url && !arguments->lcm) {
        argp_error(state, "--lcm-url: %s (goes with --lcm)", arguments->url);
    }
}

static const wh_option_table_t tables[] = {
    {options, 0, NULL, check_kinds},
    {wh_log_window_options, offsetof(arguments_t, window), NULL, wh_log_window_check},
    {wh_log_options, offsetof(arguments_t, log), NULL, NULL},
    {wh_log_more_options, offsetof(arguments_t, log.more), NULL, NULL},
    {0}};

static const wh_command_line_t command_line = {
    .name = "events",
    .synopsis = "LOG",
    .about = "Prints the events of a recorded run, or of a simulator that runs, each as a line of JSON as in "
             "`events` of run --json.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "log",
    .operand_variable = offsetof(arguments_t, log.path),
    .operand_may_lack = true,
    .check = check_events_arguments};

/* True if the cell has these wafers, and may have events of these kinds; `whose` cell it is. */
static bool fits(const arguments_t *arguments, const wh_told_layout_t *cell, const char *whose) {
    for (size_t i = 0; i < arguments->kinds.count; ++i) {
        const char *name = arguments->kinds.items[i];
        for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
            const char *why = wh_told_layout_lacks(cell, (wh_event_kind_t)kind);
            if (why && strcmp(name, wh_event_name((wh_event_kind_t)kind)) == 0) {
                fprintf(stderr, "--kind: %s: %s\n", name, why);
                return false;
            }
        }
    }
    for (size_t i = 0; i < arguments->wafers.count; ++i) {
        const char *name = arguments->wafers.items[i];
        if (wh_layout_find_wafer(cell->layout, name) == WH_NONE) {
            fprintf(stderr, "--wafer: %s (expected the name of a wafer of the %s's cell)\n", name, whose);
            return false;
        }
    }
    return true;
}

/* True if the list is empty or has the name; null is no name. */
static bool has(const wh_option_list_t *list, const char *name) {
    bool found = list->count == 0;
    for (size_t i = 0; i < list->count; ++i) {
        found = found || (name && strcmp(list->items[i], name) == 0);
    }
    return found;
}

static bool is_wanted(const arguments_t *arguments, const wh_record_t *record, size_t i) {
    const wh_event_record_t *event = &record->events[i];
    return wh_log_window_has(&arguments->window, (double)event->utime / 1e6) &&
           has(&arguments->kinds, wh_event_name(event->event.kind)) &&
           has(&arguments->wafers, wh_record_wafer_name(record, event->event.wafer));
}

static int print(const arguments_t *arguments, const wh_log_run_t *run) {
    const wh_record_t *record = &run->record;
    int status = 0;
    if (!fits(arguments, &run->cell, "log") || !wh_log_window_begins_in(&arguments->window, run)) {
        return WH_EXIT_USAGE;
    }
    for (size_t i = 0; status == 0 && i < record->event_count; ++i) {
        status = is_wanted(arguments, record, i) ? wh_event_print_line(record, i, stdout) : 0;
    }
    return wh_app_is_printed(status) ? wh_log_arguments_judge(&arguments->log, run) : WH_EXIT_USAGE;
}

static bool on_cell(void *user, const wh_told_layout_t *cell) {
    return fits(user, cell, "simulator");
}

/* The filter does not matter here: the next events belong to another run. */
static bool on_run(void *user, int64_t number, int64_t utime) {
    (void)user;
    return wh_app_is_printed(
        printf("{\"utime\": %" PRId64 ", \"kind\": \"run\", \"run\": %" PRId64 "}\n", utime, number) < 0 ? -1
                                                                                                         : 0);
}

static bool on_event(void *user, const wh_record_t *record, size_t i) {
    const int status = is_wanted(user, record, i) ? wh_event_print_line(record, i, stdout) : 0;
    return wh_app_is_printed(status);
}

static int print_log(const arguments_t *arguments) {
    static wh_log_run_t run;
    const wh_named_file_t named[] = {{"the log", arguments->log.path, false},
                                     {"the layout", arguments->log.layout, false}};
    int status = WH_EXIT_USAGE;
    if (wh_files_are_apart(named, 2, true)) {
        const bool is_read = wh_log_arguments_read(&arguments->log, NULL, NULL, &run) &&
                             wh_log_arguments_check_set(&run, NULL);
        status = is_read ? print(arguments, &run) : status;
        wh_log_run_close(&run);
    }
    return status;
}

int wh_app_events(int argc, char **argv) {
    arguments_t arguments = {.window = {0, HUGE_VAL}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const wh_events_live_t live = {arguments.url, on_cell, on_run, on_event, &arguments};
    const int status = arguments.lcm ? wh_events_live(&live) : print_log(&arguments);
    wh_option_list_free(&arguments.wafers);
    wh_option_list_free(&arguments.kinds);
    wh_option_list_free(&arguments.log.parameters);
    wh_option_list_free(&arguments.log.more.then);
    return status;
}
