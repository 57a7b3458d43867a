/* Rows that nobody asks for: a record may drop them while its run goes on, so that its memory stays flat
 * however long that is.
 *
 * A command's row goes once the command is over and another one begins, with its events, puts, waits and
 * expectations that were met. Complaints of the cell, expectations that were not met, marks of cycles, and of
 * each station the last stay of each wafer stay. All sums are those of a record with rows.
 */
#ifndef WH_RECORD_DROPPED_H
#define WH_RECORD_DROPPED_H

#include "record.h"

/* Rows are dropped from now on. Call it before the first one. */
void wh_dropped_want(wh_record_t *record);

/* For the recorder: begins a command in place of one that is over, whose rows go. Indices of commands that
 * run stay. Cost: linear in commands that run and in events since the first of them began. */
wh_command_record_t *wh_dropped_begin(wh_record_t *record, const wh_layout_t *layout, int line,
                                      const char *text, double begin_s);

/* For the record, before it adds one more: the last one goes if nobody asks for it. Where rows are kept they
 * do nothing. */
void wh_dropped_expectation(wh_record_t *record);
void wh_dropped_station_event(wh_record_t *record);

#endif
