/* The commands: when each ran, how it ended, and which wafers it took with which values. Then the messages of
 * failed commands, and the hand-overs: the chuck's values when it took the wafer, in the paper's words. */
#include <stdlib.h>

#include "../text/array.h"
#include "print_internal.h"

enum { LINE, COMMAND, BEGIN, END, RESULT, TAKEN, MEASURED };

/* The events that the table shows, in chains by command; the last chain holds events that fit no command. */
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

static void fill_event(const wh_printer_t *printer, wh_grid_t *grid, const wh_event_t *event) {
    const char *wafer = wh_print_wafer(printer, event->wafer);
    const char *gripper = wh_print_gripper(printer, event->gripper);
    if (event->kind == WH_EVENT_RELEASED) {
        wh_grid_text(grid, TAKEN, WH_INK_DIM, "%s let go", wafer);
        return;
    }
    if (event->kind == WH_EVENT_HANDED_OVER) {
        wh_grid_text(grid, TAKEN, WH_INK_PLAIN, "%s %s %s %s", wafer, wh_print_gripper(printer, event->other),
                     wh_style_glyph(printer->style, WH_GLYPH_ARROW), gripper);
    } else {
        wh_grid_text(grid, TAKEN, WH_INK_PLAIN, "%s by %s%s", wafer, gripper,
                     event->face == WH_FACE_FRONT ? ", by its front" : "");
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

/* Adds the events that happened while no command ran. */
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
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "line{0};command;begin s{3,6};end s{3,6};result;taken");
    wh_print_measured_columns(printer, grid);
    for (size_t i = 0; i < printer->record->command_count; ++i) {
        add_command(printer, grid, chains, i);
    }
    add_others(printer, grid, chains);
    wh_print_title(printer, "Commands");
    fputs(wh_grid_rows(grid) > 0 ? "" : "none\n", printer->out);
    wh_grid_print(grid, printer->out);
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

/* ------------------------------------------------------------------------------------------------- errors */

static void put_error(const wh_printer_t *printer, const wh_command_record_t *command) {
    if (command->line > 0) {
        fprintf(printer->out, "line %d: ", command->line);
    }
    wh_print_say(printer, "%s: %s", command->text ? command->text : "",
                 command->message ? command->message : wh_record_error_text(command->error));
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

/* --------------------------------------------------------------------------------------------- hand-overs */

/* The most hand-overs that are shown in full. */
#define SHOWN 8

/* Columns of its table. */
enum { VALUE, VALUE_MEASURED, LIMIT, MARGIN };

static void print_values(const wh_printer_t *printer, const wh_proximity_t *p) {
    const wh_tolerance_t *limits = &printer->record->layout->grasp.tolerance;
    wh_grid_t *grid = wh_grid_new(printer->style, 1, ";measured{6};limit;margin{6}");
    wh_grid_limit(grid, 0);
    const struct {
        const char *name;
        double measured;
        char relation; /* 0: there is no limit */
        double limit, margin;
    } rows[] = {{"  |dr_proj_z|", wh_real_abs(p->dr_proj_z), '<', limits->projz, p->margin_projz},
                {"  |dr_proj_xy|", p->dr_proj_xy_norm, '<', limits->projxy, p->margin_projxy},
                {"  n1_proj_n2", p->n1_proj_n2, '>', limits->planar, p->margin_planar},
                {"  dr_proj_xy  x", p->dr_proj_xy.x, 0, 0, 0},
                {"              y", p->dr_proj_xy.y, 0, 0, 0},
                {"              z", p->dr_proj_xy.z, 0, 0, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        wh_grid_named_row(grid, rows[i].name);
        wh_grid_number(grid, VALUE_MEASURED, WH_INK_PLAIN, rows[i].measured);
        if (rows[i].relation) {
            wh_grid_text(grid, LIMIT, WH_INK_PLAIN, "%c %.10g", rows[i].relation, rows[i].limit);
            wh_grid_number(grid, MARGIN, rows[i].margin > 0 ? WH_INK_GOOD : WH_INK_BAD, rows[i].margin);
        }
    }
    wh_grid_print(grid, printer->out);
}

static void print_handover(const wh_printer_t *printer, const wh_event_record_t *record) {
    const wh_event_t *event = &record->event;
    const bool ready = event->measured.ready;
    const wh_grid_digits_t seconds = {3, 6, false, 0};
    const double at = (double)record->utime / 1e6;
    const char *gripper = wh_print_gripper(printer, event->gripper);
    wh_print_title(printer, "Hand-over");
    wh_print_say(printer, "%s, %s %s %s, at %.*f s: isReadyToPick%s: ", wh_print_wafer(printer, event->wafer),
                 wh_print_gripper(printer, event->other), wh_style_glyph(printer->style, WH_GLYPH_ARROW),
                 gripper, wh_grid_decimals(&seconds, at), at, gripper);
    wh_style_print(printer->style, printer->out, ready ? WH_INK_GOOD : WH_INK_BAD, "%s",
                   ready ? "true" : "false");
    fputc('\n', printer->out);
    print_values(printer, &event->measured);
}

void wh_print_handovers(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    size_t count = 0;
    for (size_t i = 0; i < record->event_count && record->layout; ++i) {
        if (record->events[i].event.kind == WH_EVENT_HANDED_OVER && ++count <= SHOWN) {
            print_handover(printer, &record->events[i]);
        }
    }
    if (count > SHOWN) {
        fprintf(printer->out, "\n%zu more hand-overs; their values stand in the table above.\n",
                count - SHOWN);
    }
}
