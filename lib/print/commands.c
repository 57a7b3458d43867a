/* The commands: when each ran, how it ended, and what was taken under which values. */
#include <stdlib.h>

#include "../text/array.h"
#include "print_internal.h"

enum { LINE, COMMAND, BEGIN, END, RESULT, TAKEN, MEASURED };

/* The events that the table shows, in chains by command; the last chain holds what fits none. */
typedef struct {
    size_t *first; /* by command: 1 + index of its first event, 0: none */
    size_t *next;  /* by event: 1 + index of the next one of its command */
} chains_t;

static bool is_shown(wh_event_kind_t kind) {
    return kind == WH_EVENT_PICKED || kind == WH_EVENT_RELEASED || kind == WH_EVENT_HANDED_OVER;
}

static void link_events(const wh_record_t *record, const chains_t *chains) {
    for (size_t i = record->event_count; i-- > 0;) {
        const wh_event_record_t *event = &record->events[i];
        if (is_shown(event->event.kind)) {
            const bool fits = wh_is_index(event->command, record->command_count);
            const size_t chain = fits ? (size_t)event->command : record->command_count;
            chains->next[i] = chains->first[chain];
            chains->first[chain] = i + 1;
        }
    }
}

static wh_grid_t *new_grid(const wh_printer_t *printer) {
    wh_grid_t *grid = wh_grid_new(printer->style, 1);
    wh_grid_number_column(grid, "line", wh_grid_whole);
    wh_grid_text_column(grid, "command");
    wh_grid_number_column(grid, "begin s", wh_print_seconds);
    wh_grid_number_column(grid, "end s", wh_print_seconds);
    wh_grid_text_column(grid, "result");
    wh_grid_text_column(grid, "taken");
    wh_print_measured_columns(printer, grid);
    return grid;
}

static void fill_event(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_t *event) {
    const char *wafer = wh_print_wafer(printer, event->wafer);
    const char *gripper = wh_print_gripper(printer, event->gripper);
    if (event->kind == WH_EVENT_RELEASED) {
        wh_grid_text(grid, TAKEN, WH_INK_DIM, "%s let go", wafer);
        return;
    }
    if (event->kind == WH_EVENT_HANDED_OVER) {
        wh_grid_text(grid, TAKEN, WH_INK_PLAIN, "%s %s %s %s", wafer, wh_print_gripper(printer, event->other),
                     wh_style_arrow(printer->style), gripper);
    } else {
        wh_grid_text(grid, TAKEN, WH_INK_PLAIN, "%s by %s", wafer, gripper);
    }
    wh_print_measured(printer, grid, MEASURED, event);
}

static void fill_command(wh_grid_t *grid, const wh_command_record_t *command) {
    wh_grid_text(grid, COMMAND, WH_INK_PLAIN, "%s", command->text ? command->text : "");
    wh_grid_number(grid, BEGIN, WH_INK_PLAIN, command->begin_s);
    wh_grid_number(grid, END, WH_INK_PLAIN, command->end_s);
    if (command->error == WH_OK) {
        wh_grid_text(grid, RESULT, WH_INK_GOOD, "ok");
    } else {
        wh_grid_text(grid, RESULT, WH_INK_BAD, "error %d %s", (int)command->error,
                     wh_status_name(command->error));
    }
}

/* A command's rows: at least one, and one for each of its events. */
static void add_command(const wh_printer_t *printer, wh_grid_t *grid, const chains_t *chains,
                        size_t command) {
    const wh_command_record_t *from = &printer->record->commands[command];
    size_t event = chains->first[command];
    bool is_first = true;
    while (is_first || event != 0) {
        wh_grid_row(grid);
        if (from->line > 0) {
            wh_grid_number(grid, LINE, WH_INK_DIM, from->line);
        }
        if (is_first) {
            fill_command(grid, from);
        }
        if (event != 0) {
            fill_event(printer, grid, &printer->record->events[event - 1].event);
            event = chains->next[event - 1];
        }
        is_first = false;
    }
}

/* What happened while no command ran. */
static void add_others(const wh_printer_t *printer, wh_grid_t *grid, const chains_t *chains) {
    size_t event = chains->first[printer->record->command_count];
    for (; event != 0; event = chains->next[event - 1]) {
        const wh_event_record_t *from = &printer->record->events[event - 1];
        wh_grid_row(grid);
        wh_grid_text(grid, COMMAND, WH_INK_DIM, "(no command)");
        wh_grid_number(grid, BEGIN, WH_INK_PLAIN, (double)from->utime / 1e6);
        fill_event(printer, grid, &from->event);
    }
}

static void print_table(const wh_printer_t *printer, const chains_t *chains) {
    wh_grid_t *grid = new_grid(printer);
    for (size_t i = 0; i < printer->record->command_count; ++i) {
        add_command(printer, grid, chains, i);
    }
    add_others(printer, grid, chains);
    wh_print_title(printer, "Commands");
    if (wh_grid_rows(grid) > 0) {
        wh_grid_print(grid, printer->out);
    } else {
        fputs("none\n", printer->out);
        wh_grid_free(grid);
    }
}

void wh_print_commands(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    const chains_t chains = {wh_array_new(record->command_count + 1, sizeof(size_t)),
                             wh_array_new(record->event_count, sizeof(size_t))};
    link_events(record, &chains);
    print_table(printer, &chains);
    free(chains.first);
    free(chains.next);
}

static void put_error(const wh_printer_t *printer, const wh_command_record_t *command) {
    const char *message = command->message ? command->message : wh_record_error_text(command->error);
    if (command->line > 0) {
        fprintf(printer->out, "line %d: ", command->line);
    }
    wh_print_put(printer, command->text);
    fputs(": ", printer->out);
    wh_print_put(printer, message);
    fputc('\n', printer->out);
}

void wh_print_errors(const wh_printer_t *printer) {
    bool titled = false;
    for (size_t i = 0; i < printer->record->command_count; ++i) {
        const wh_command_record_t *command = &printer->record->commands[i];
        if (command->error != WH_OK) {
            if (!titled) {
                wh_print_title(printer, "Errors");
                titled = true;
            }
            put_error(printer, command);
        }
    }
}
