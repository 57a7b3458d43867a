/* How far a study is, as a line on a terminal; nothing anywhere else. */
#ifndef WH_TEXT_BAR_H
#define WH_TEXT_BAR_H

#include <stdint.h>

#include "style.h"

typedef struct {
    FILE *out; /* null: no terminal */
    wh_style_t style;
    uint64_t total, begun; /* trials, and those done before */
    double start, shown;   /* s */
} wh_bar_t;

/* `begun` trials are done already. */
void wh_bar_open(wh_bar_t *bar, FILE *out, uint64_t total, uint64_t begun);

/* Shows it, ten times a second at most. */
void wh_bar_show(wh_bar_t *bar, uint64_t done);

/* Takes the line away. */
void wh_bar_close(const wh_bar_t *bar);

#endif
