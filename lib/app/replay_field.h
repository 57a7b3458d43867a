/* `waferhand replay LAYOUT --field FILE.csv`: a field log against a cell. lua/manual/field_logs.md is its
 * manual. */
#ifndef WH_APP_REPLAY_FIELD_H
#define WH_APP_REPLAY_FIELD_H

#include "connection.h"
#include "layout_arguments.h"

/* Zero it to begin with. */
typedef struct {
    const char *field, *columns, *moves, *segments;
    double gap_s, within_s, rest;
    wh_record_arguments_t record;
    wh_layout_arguments_t layout; /* its path is the operand */
} wh_replay_field_arguments_t;

/* The options that go with --field, and itself; the check of their table. Those of a recording and of a
 * layout are tables of their own. */
extern const wh_option_t wh_replay_field_options[];
void wh_replay_field_check(const void *filled, struct argp_state *state);

/* Plays the log, prints what came of it, and frees the layout. Returns the exit status. */
int wh_replay_field(wh_replay_field_arguments_t *arguments, bool json);

#endif
