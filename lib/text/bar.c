#include "bar.h"

#include <unistd.h>

#include "clock.h"

#define CELLS 30

void wh_bar_open(wh_bar_t *bar, FILE *out, uint64_t total, uint64_t begun) {
    bar->out = isatty(fileno(out)) == 1 ? out : NULL;
    bar->style = wh_style_of(out);
    bar->total = total;
    bar->begun = begun;
    bar->start = wh_clock_seconds();
    bar->shown = 0;
}

static void print_left(const wh_bar_t *bar, uint64_t done, double elapsed) {
    if (done > bar->begun && elapsed > 1) {
        const double left = elapsed * (double)(bar->total - done) / (double)(done - bar->begun);
        fprintf(bar->out, ", %d:%02d left", (int)(left / 60), (int)left % 60);
    }
}

void wh_bar_show(wh_bar_t *bar, uint64_t done) {
    const double now = wh_clock_seconds();
    if (!bar->out || now - bar->shown < 0.1) {
        return;
    }
    bar->shown = now;
    const int full = (int)((double)CELLS * (double)done / (double)bar->total);
    fputs("\r\033[K[", bar->out);
    for (int cell = 0; cell < CELLS; ++cell) {
        fputs(cell < full ? (bar->style.utf8 ? "█" : "#") : " ", bar->out);
    }
    fprintf(bar->out, "] %.1f %% of %llu trials", 100 * (double)done / (double)bar->total,
            (unsigned long long)bar->total);
    print_left(bar, done, now - bar->start);
    fflush(bar->out);
}

void wh_bar_close(const wh_bar_t *bar) {
    if (bar->out) {
        fputs("\r\033[K", bar->out);
        fflush(bar->out);
    }
}
