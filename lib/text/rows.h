/* The rows of a text file with a separator between the cells (RFC 4180), split and nothing more.
 *
 * Fields may stand in quotes, in which a separator is text and "" is a quote; a field ends on its line.
 * Blanks around a field without quotes are ignored. Lines end in LF or CRLF. Blank lines are left out, and
 * so is a byte order mark of UTF-8. */
#ifndef WH_TEXT_ROWS_H
#define WH_TEXT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

/* The most fields of a row; the longest message. */
#define WH_ROWS_FIELDS 1024
#define WH_ROWS_MESSAGE 512

/* How a file is read. All zero: commas, no comments. */
typedef struct {
    char separator;    /* 0: a comma */
    bool finds_tabs;   /* a tab separates if the first row has one and no comma */
    bool has_comments; /* a line whose first byte is # is left out */
    size_t most_bytes; /* of the file; at least 1 */
} wh_rows_form_t;

/* An open file, with the last row read. Zero it at the beginning. */
typedef struct {
    const char *path;
    wh_rows_form_t form;
    size_t line;                  /* of the fields, from 1 */
    char *fields[WH_ROWS_FIELDS]; /* until wh_rows_close */
    size_t count;
    bool ends_whole;               /* the file's last line has a line end */
    char message[WH_ROWS_MESSAGE]; /* the error: "a.csv:3: why"; empty: none */
    /* the place of reading */
    char *bytes, *at;
    size_t size, next_line;
} wh_rows_t;

/* Opens the file, a regular one, without a byte 0. `path` must outlive the rows. Returns false if it is
 * refused; `message` gives the reason. Close it in either case. Cost: linear in the file. */
bool wh_rows_open(wh_rows_t *rows, const char *path, const wh_rows_form_t *form);

/* Reads the next row. Returns false at the end, and if the row is refused; `message` is then not empty. */
bool wh_rows_read(wh_rows_t *rows);

/* Refuses the last row read: sets `message` to "a.csv:3: why". Returns false. */
__attribute__((format(printf, 2, 3))) bool wh_rows_refuse(wh_rows_t *rows, const char *format, ...);

/* Refuses the file as a whole: "a.csv: why". Returns false. */
bool wh_rows_refuse_file(wh_rows_t *rows, const char *why);

void wh_rows_close(wh_rows_t *rows);

/* A decimal number with a point: no NaN, no infinity, no hex, nothing behind it. False if it is none, or is
 * not from `least` to `most`. */
bool wh_rows_number(const char *text, double least, double most, double *value);

/* True for 1 to `most` bytes of UTF-8 without control characters. */
bool wh_rows_is_name(const char *text, size_t most);

#endif
