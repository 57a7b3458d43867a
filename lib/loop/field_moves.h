/* The moves of axes in a log: from rest to rest, with their times, as `waferhand estimate limits` reads
 * them.
 *
 * An axis rests while it goes less than `rest` (mm or degrees) from row to row, for 30 ms. A move begins
 * with the last row of a rest and ends with the first one of the next. One that turns back, or has a hole
 * in it, is left out. Host code; it ends the program if out of memory. */
#ifndef WH_LOOP_FIELD_MOVES_H
#define WH_LOOP_FIELD_MOVES_H

#include "../layout/layout.h"

/* How long an axis rests, s. */
#define WH_MOVES_REST_S 0.03
/* The least number of moves of an axis by which it is told to look simulated. */
#define WH_MOVES_ALIKE 3

typedef struct {
    size_t axis;
    double from, to; /* mm or degrees */
    double seconds;
} wh_field_move_t;

/* An axis on its way. */
typedef struct {
    bool moves, is_odd;         /* is_odd: it has turned back, or a hole is in it */
    bool has_moved, has_rested; /* ever; and after a move */
    double from, from_s;        /* where and when it rested last */
    double last, last_s;        /* where it moved last, and when */
    double direction;
} wh_field_axis_t;

/* Zero it but for `layout` and `rest`. */
typedef struct {
    const wh_layout_t *layout;
    double rest, gap_s;
    bool has_row;
    double before_s, period_s; /* the row before; the longest time between two rows */
    double before[WH_AXES];
    wh_field_axis_t axes[WH_AXES];
    wh_field_move_t *moves;
    size_t count, capacity, odd;
} wh_field_moves_t;

/* Takes a row; `q` in the library's units. */
void wh_field_moves_take(wh_field_moves_t *moves, double time_s, const wh_real_t q[]);

/* The name of an axis in tables of moves; null: they have none for it. */
const char *wh_field_moves_axis(const wh_layout_t *layout, size_t axis);

/* How many of the axis's moves there are, and how many of them take the time by the layout's limits, to 1
 * ms and a row. In a log with rows farther apart than 1.5 ms none is known to. */
size_t wh_field_moves_count(const wh_field_moves_t *moves, size_t axis, size_t *alike);

/* True if at least WH_MOVES_ALIKE moves of the axis and half of them are so much alike: no real axis is. */
bool wh_field_moves_look_simulated(const wh_field_moves_t *moves, size_t axis);

/* True if the axis has moved, and never came to rest. */
bool wh_field_moves_never_rests(const wh_field_moves_t *moves, size_t axis);

void wh_field_moves_free(wh_field_moves_t *moves);

#endif
