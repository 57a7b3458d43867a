/* A table of text and numbers for the terminal.
 *
 * Set columns first, then rows, then print. Numbers of a column share their decimals, so that they line up
 * on the point; the column's rule sets the number of decimals. Nothing is cut off. A table wider than the
 * terminal is printed in parts that each begin with the key columns; rows that would be empty in a later
 * part are left out there. It ends the program if out of memory.
 */
#ifndef WH_TEXT_GRID_H
#define WH_TEXT_GRID_H

#include "style.h"

/* Two of each axis that a machine may have, and a key. */
#define WH_GRID_COLUMNS 80

/* The rule for printing a column's numbers. */
typedef struct {
    int least, most; /* decimals: `least`, and up to `most` for a number with non-zero digits there */
    bool has_limit;
    double limit; /* then more decimals until no number is rounded onto its limit or across it */
} wh_grid_digits_t;

typedef struct wh_grid wh_grid_t;

/* A table without rows; its first `keys` columns begin each part. `columns` has their headings, separated
 * by ';'; null: none yet. "{3}" or "{3,6}" after a heading makes it a column of numbers, aligned right,
 * with these least and most decimals. A '+' before it keeps the column next to the one before if a part
 * has room for both.
 *
 *     wh_grid_t *grid = wh_grid_new(style, 1, "station;x mm{0,6};y mm{0,6};+turned deg{1}");
 */
wh_grid_t *wh_grid_new(const wh_style_t *style, size_t keys, const char *columns);

/* Adds columns, all of them before the first row. There may be at most WH_GRID_COLUMNS. */
void wh_grid_columns(wh_grid_t *grid, const char *columns);

/* Ensures that no number of the last column is rounded onto this limit or across it. */
void wh_grid_limit(wh_grid_t *grid, double limit);

/* Adds a row of empty cells, or with a text in its first cell. */
void wh_grid_row(wh_grid_t *grid);
void wh_grid_named_row(wh_grid_t *grid, const char *name);

/* Sets a cell of the last row. Text is copied and made printable. */
__attribute__((format(printf, 4, 5))) void wh_grid_text(wh_grid_t *grid, size_t column, wh_ink_t ink,
                                                        const char *format, ...);
void wh_grid_number(wh_grid_t *grid, size_t column, wh_ink_t ink, double value);

/* Sets `count` numbers side by side, from `column` on. */
void wh_grid_numbers(wh_grid_t *grid, size_t column, const double values[], size_t count);

/* The number of rows. */
size_t wh_grid_rows(const wh_grid_t *grid);

/* Prints the table, unless it has no rows, and frees it. */
void wh_grid_print(wh_grid_t *grid, FILE *out);

/* Formats a number by a rule into `text`, with the decimals given, -0 as 0. `decimals` is the result of
 * wh_grid_decimals for it, or more. */
int wh_grid_decimals(const wh_grid_digits_t *digits, double value);
void wh_grid_format(char *text, size_t size, double value, int decimals);

/* Room for any double with 20 decimals. */
#define WH_GRID_NUMBER_SIZE 352

#endif
