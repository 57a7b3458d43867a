/* Reads a schedule from a table: UTF-8, a line that names the columns, commas or tabs, # comments.
 *
 * * Columns: robot, action, wafer, station, slot (empty: 1), begin_s, end_s, and perhaps arm, wafer2, to,
 * value. Nothing is guessed: what is not understood is refused with file, line, column, value and what was
 * expected. */
#ifndef WH_SCHEDULE_READ_H
#define WH_SCHEDULE_READ_H

#include "../text/rows.h"
#include "schedule.h"

/* The largest file; the latest time, s; the highest slot. */
#define WH_SCHEDULE_BYTES ((size_t)1 << 30)
#define WH_SCHEDULE_LATEST 1e9
#define WH_SCHEDULE_SLOTS 100000

/* A value of a row: a text, or a number that needs no reading. Without either it is empty. */
typedef struct {
    const char *text;
    double number;
    bool is_number;
    double scale; /* of a text that is a number; 0: 1 */
} wh_schedule_cell_t;

/* Zero it at the beginning. */
typedef struct {
    wh_schedule_t *schedule;
    wh_rows_t rows;
    const char *theirs[WH_SCHEDULE_COLUMNS]; /* the file's name of a column, for messages; null: as ours */
    unsigned filled, used;                   /* columns with cells, and those that some row needs: bits */
    char message[1600];                      /* the error; empty: none */
} wh_schedule_reader_t;

/* Opens the file, and refuses one that is empty. The first line is in `rows` then. Close `rows` in any
 * case. */
bool wh_schedule_open(wh_schedule_reader_t *reader, wh_schedule_t *schedule, const char *path,
                      char separator);

/* Reads the next row into `rows`; false at the end, or with a message. */
bool wh_schedule_next(wh_schedule_reader_t *reader, size_t fields);

/* Adds a row of the schedule, of the line that was read last. False, with a message, if it is refused. */
bool wh_schedule_add(wh_schedule_reader_t *reader, const wh_schedule_cell_t cells[WH_SCHEDULE_COLUMNS]);

/* To be called once behind the last row: notes columns that have cells, of which no row needs any. */
void wh_schedule_note_unused(const wh_schedule_reader_t *reader);

/* Reads a whole file with our columns into a zero schedule, which is to be closed in any case. False, with
 * the reason in `message`. Cost: linear in the file, plus a sort of the places. */
bool wh_schedule_read(wh_schedule_t *schedule, const char *path, char message[1600]);

#endif
