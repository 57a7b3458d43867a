/* The first steady cycle by itself: its duration, its commands, and its wafers per hour. */
#include "../record/steady.h"
#include "print_internal.h"

static void put_place(const wh_printer_t *printer, const wh_steady_cycle_t *steady) {
    const double begin = wh_throughput_seconds(printer->record, steady->begin);
    fprintf(printer->out, "%.3f s, from %.3f s to %.3f s, with ", steady->seconds, begin,
            wh_throughput_seconds(printer->record, steady->end));
    wh_print_counted(printer->out, (int64_t)steady->count, "command", "commands");
    if (steady->mark > 0) {
        const char *name = printer->record->cycles[steady->mark - 1].name;
        fprintf(printer->out, ": cycle %zu", steady->mark);
        if (name[0] != '\0') {
            wh_print_say(printer, ", %s", name);
        }
    }
    fprintf(printer->out, "; %zu like it in a row, to 1 %%\n", steady->times);
}

void wh_print_cycle(const wh_printer_t *printer) {
    const wh_steady_cycle_t steady = wh_steady_cycle(printer->record);
    const wh_print_window_t window = {steady.begin, steady.end, false};
    wh_print_title(printer, "First steady cycle");
    if (steady.found != WH_STEADY_FOUND) {
        fprintf(printer->out, "no steady cycle: %s\n", wh_steady_reason(steady.found));
        return;
    }
    put_place(printer, &steady);
    if (steady.figure == WH_FIGURE_GIVEN) {
        fprintf(printer->out, "%.1f wafers per hour: %zu in %.3f s\n", steady.wafers_per_hour, steady.wafers,
                steady.seconds);
    } else {
        fprintf(printer->out, "no wafers per hour: %s\n", wh_throughput_reason(steady.figure));
    }
    wh_print_gantt(printer, &window);
    wh_print_times(printer, &window);
}
