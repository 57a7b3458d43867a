/* The own doings of stations: as a table, and as JSON. */
#include <math.h>

#include "../layout/times.h"
#include "../text/grid.h"
#include "../text/json.h"
#include "print_internal.h"
#include "record_print.h"

json_t *wh_station_event_to_json(const void *subject, size_t i) {
    const wh_record_t *record = subject;
    const wh_station_event_record_t *from = &record->station_events[i];
    const wh_clock_event_t *event = &from->event;
    const bool of_place = event->slot != WH_FLOW_NONE;
    const bool of_port = event->kind >= WH_CLOCK_PORT_BEGINS;
    json_t *object = wh_json_set(
        json_object(), "utime %lld kind %s station %s slot %lld wafer %s side %s seconds %g",
        (json_int_t)event->at_us, wh_clock_kind_name(event->kind),
        wh_record_station_name(record, from->station), of_place ? (json_int_t)event->slot + 1 : WH_JSON_NONE,
        wh_record_wafer_name(record, event->wafer), wh_flow_side_words[event->side], (double)event->us / 1e6);
    return of_port ? wh_json_set(object, "step %s carrier %s", wh_load_port_step_name(from->step),
                                 from->carrier[0] ? from->carrier : NULL)
                   : object;
}

/* --------------------------------------------------------------------------------------------- as a table */

enum { BEGINS, STATION, SLOT, WHAT, WAFER, ENDS, STAYS };

/* The word for the thing that an event begins, or whose begin it misses; null: for neither. */
static const char *begins_what(const wh_station_event_record_t *record) {
    const wh_clock_event_t *event = &record->event;
    switch ((int)event->kind) {
    case WH_CLOCK_PROCESS_BEGINS:
    case WH_CLOCK_UNPROCESSED:
        return "process";
    case WH_CLOCK_CLEAN_BEGINS:
    case WH_CLOCK_CLEAN_MISSED:
        return "clean";
    case WH_CLOCK_PUMP_BEGINS:
        return event->side == WH_FLOW_VACUUM ? "to vacuum" : "to atmosphere";
    case WH_CLOCK_PORT_BEGINS:
        return wh_load_port_step_name(record->step);
    default:
        return NULL;
    }
}

static bool ends(wh_clock_kind_t kind) {
    return kind == WH_CLOCK_PROCESS_ENDS || kind == WH_CLOCK_CLEAN_ENDS || kind == WH_CLOCK_PUMP_ENDS ||
           kind == WH_CLOCK_PORT_ENDS;
}

/* The next event of the same slot, or of the station, behind this one; null: there is none. */
static const wh_clock_event_t *next_of(const wh_record_t *record, size_t *i) {
    const wh_station_event_record_t *from = &record->station_events[*i];
    for (size_t k = *i + 1; k < record->station_event_count; ++k) {
        const wh_station_event_record_t *event = &record->station_events[k];
        if (event->station == from->station && event->event.slot == from->event.slot) {
            *i = k;
            return &event->event;
        }
    }
    return NULL;
}

static bool is_cut(wh_clock_kind_t kind) {
    return kind == WH_CLOCK_PROCESS_CUT || kind == WH_CLOCK_CLEAN_CUT || kind == WH_CLOCK_PORT_TIMEOUT;
}

/* The end of what event `i` begins, whose number `i` then is; null: it goes on. Wafers may come and go
 * meanwhile. */
static const wh_clock_event_t *find_end(const wh_record_t *record, size_t *i) {
    const wh_clock_event_t *event = next_of(record, i);
    while (event && !ends(event->kind) && !is_cut(event->kind)) {
        event = next_of(record, i);
    }
    return event;
}

static double window_s(const wh_record_t *record, int32_t station) {
    const wh_layout_times_t *times = record->layout ? record->layout->stations[station].times : NULL;
    return times && times->of.window_us != WH_FLOW_NEVER ? (double)times->of.window_us / 1e6 : HUGE_VAL;
}

static void put_end(wh_grid_t *grid, const wh_clock_event_t *end) {
    if (end && is_cut(end->kind)) {
        wh_grid_text(grid, ENDS, WH_INK_BAD,
                     end->kind == WH_CLOCK_PORT_TIMEOUT ? "ran out at %.3f" : "cut at %.3f",
                     (double)end->at_us / 1e6);
    } else if (end) {
        wh_grid_number(grid, ENDS, WH_INK_PLAIN, (double)end->at_us / 1e6);
    } else {
        wh_grid_text(grid, ENDS, WH_INK_DIM, "goes on");
    }
}

/* The stay behind a process that is event `i`, and with a window that it broke the limit beside it. */
static void put_stay(const wh_printer_t *printer, wh_grid_t *grid, int32_t station, size_t i) {
    const double limit_s = window_s(printer->record, station);
    double stay_s = NAN;
    for (const wh_clock_event_t *event = next_of(printer->record, &i);
         event && event->kind != WH_CLOCK_PROCESS_BEGINS; event = next_of(printer->record, &i)) {
        const double s = (double)event->us / 1e6;
        stay_s = event->kind == WH_CLOCK_TAKEN ? s : event->kind == WH_CLOCK_LATE ? s + limit_s : stay_s;
    }
    if (stay_s > limit_s) {
        wh_grid_text(grid, STAYS, WH_INK_BAD, "%.3f > %.10g", stay_s, limit_s);
    } else if (!isnan(stay_s)) {
        wh_grid_number(grid, STAYS, WH_INK_PLAIN, stay_s);
    }
}

/* A process or a clean that never came, because its wafer went or came. */
static void put_never(wh_grid_t *grid, const wh_clock_event_t *event) {
    const bool is_process = event->kind == WH_CLOCK_UNPROCESSED;
    wh_grid_text(grid, BEGINS, WH_INK_BAD, is_process ? "never" : "missed");
    wh_grid_text(grid, ENDS, WH_INK_BAD, is_process ? "taken at %.3f" : "came at %.3f",
                 (double)event->at_us / 1e6);
}

static void put_times(const wh_printer_t *printer, wh_grid_t *grid, size_t i) {
    const wh_record_t *record = printer->record;
    const wh_station_event_record_t *from = &record->station_events[i];
    if (from->event.kind == WH_CLOCK_UNPROCESSED || from->event.kind == WH_CLOCK_CLEAN_MISSED) {
        put_never(grid, &from->event);
        return;
    }
    const wh_clock_event_t *end = find_end(record, &i);
    wh_grid_number(grid, BEGINS, WH_INK_PLAIN, (double)from->event.at_us / 1e6);
    put_end(grid, end);
    if (end && end->kind == WH_CLOCK_PROCESS_ENDS) {
        put_stay(printer, grid, from->station, i);
    }
}

static void add_row(const wh_printer_t *printer, wh_grid_t *grid, size_t i, const char *what) {
    const wh_record_t *record = printer->record;
    const wh_station_event_record_t *from = &record->station_events[i];
    const char *name = wh_record_station_name(record, from->station);
    wh_grid_row(grid);
    wh_grid_text(grid, STATION, WH_INK_PLAIN, "%s", name ? name : "-");
    if (from->event.slot != WH_FLOW_NONE) {
        wh_grid_text(grid, SLOT, WH_INK_PLAIN, "%d", (int)from->event.slot + 1);
    }
    wh_grid_text(grid, WHAT, WH_INK_PLAIN, "%s%s%s", what, from->carrier[0] ? " of " : "", from->carrier);
    wh_grid_text(grid, WAFER, WH_INK_PLAIN, "%s", wh_print_wafer(printer, from->event.wafer));
    put_times(printer, grid, i);
}

void wh_print_stations(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    wh_grid_t *grid =
        wh_grid_new(printer->style, 1, "begins s{3,6};station;slot{0};what;wafer;ends s{3,6};stays s{3,6}");
    for (size_t i = 0; i < record->station_event_count; ++i) {
        const char *what = begins_what(&record->station_events[i]);
        if (what) {
            add_row(printer, grid, i, what);
        }
    }
    wh_print_titled(printer, "Stations", grid);
}
