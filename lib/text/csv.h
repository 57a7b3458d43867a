/* A table of comma-separated values (rows.h), read strictly. Nothing is guessed; input that is not
 * understood is refused with its file, line, column and value.
 *
 * * The first line names the columns, in any order. Every other line has as many fields as the first.
 * Numbers are decimal, with a point: no NaN, no infinity, no hex. */
#ifndef WH_TEXT_CSV_H
#define WH_TEXT_CSV_H

#include "rows.h"

/* The longest file; the most columns; the longest text, with its terminator. */
#define WH_CSV_BYTES 16777216
#define WH_CSV_COLUMNS 16
#define WH_CSV_TEXT 64

/* A column that the table may have. */
typedef struct {
    const char *name;
    double least, most; /* of a number */
    bool is_text;       /* 1 to WH_CSV_TEXT - 1 bytes of UTF-8, without control characters */
    bool may_lack;      /* the column, or the number in a line, may be missing; it is then NaN */
} wh_csv_column_t;

/* An open table, with the last line read. Zero it at the beginning. */
typedef struct {
    const char *path;
    const wh_csv_column_t *columns;
    size_t column_count;
    bool has[WH_CSV_COLUMNS]; /* the file has the column */
    size_t line;              /* of the values below, from 1 */
    double numbers[WH_CSV_COLUMNS];
    const char *texts[WH_CSV_COLUMNS]; /* until wh_csv_close */
    char message[512];                 /* the error: "a.csv:3: x: 1,5 (expected ...)"; empty: none */
    wh_rows_t rows;
    size_t field_count;
    size_t order[WH_CSV_COLUMNS]; /* the column of each field */
} wh_csv_t;

/* Opens the file, a regular one, and reads its first line. `path` and `columns` must outlive the table.
 * Returns false if it is refused; `message` gives the reason. Close it in either case. Cost: linear in the
 * file. */
bool wh_csv_open(wh_csv_t *csv, const char *path, const wh_csv_column_t *columns, size_t count);

/* Reads the next line that is not blank. Returns false at the end, and if the line is refused; `message` is
 * then not empty. */
bool wh_csv_read(wh_csv_t *csv);

/* Refuses the value in a column of the last line read, for a reason that the caller knows: sets `message`.
 * Returns false. */
bool wh_csv_refuse(wh_csv_t *csv, size_t column, const char *expected);

/* Refuses the file as a whole: "a.csv: why". */
bool wh_csv_refuse_file(wh_csv_t *csv, const char *why);

void wh_csv_close(wh_csv_t *csv);

#endif
