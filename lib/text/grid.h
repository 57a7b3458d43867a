/* A table of text and numbers for the terminal, printed by libsmartcols.
 *
 * Columns first, then rows, then print. Numbers of a column share their decimals, so that they line up on the
 * point, and get as many as the column's rule asks for. Nothing is ever cut off: a table wider than the
 * terminal is printed in parts that each begin with the key columns, and rows that would be empty in a later
 * part are left out there. Ends the program if out of memory.
 */
#ifndef WH_TEXT_GRID_H
#define WH_TEXT_GRID_H

#include "style.h"

#define WH_GRID_COLUMNS 16

/* How a column's numbers are printed. */
typedef struct {
    int least, most; /* decimals: `least`, and up to `most` where a number has non-zero ones there */
    bool has_limit;
    double limit; /* then more decimals until no number is rounded onto its limit or across it */
} wh_grid_digits_t;

typedef struct wh_grid wh_grid_t;

/* A table without rows; its first `keys` columns begin each part. `columns` has their headings, with a ';'
 * between them. Behind a heading "{3}" or "{3,6}" makes it a column of numbers, to the right, with so many
 * decimals at least and at most. A '+' before it keeps the column beside the one before wherever a part has
 * room for both.
 *
 *     wh_grid_t *grid = wh_grid_new(style, 1, "station;x mm{0,6};y mm{0,6};+turned deg{1}");
 */
wh_grid_t *wh_grid_new(const wh_style_t *style, size_t keys, const char *columns);

/* More columns, all of them before the first row. There are WH_GRID_COLUMNS at most. */
void wh_grid_columns(wh_grid_t *grid, const char *columns);

/* No number of the last column is rounded onto this limit or across it. */
void wh_grid_limit(wh_grid_t *grid, double limit);

/* One more row, of empty cells; or with a text in its first cell. */
void wh_grid_row(wh_grid_t *grid);
void wh_grid_named_row(wh_grid_t *grid, const char *name);

/* Sets a cell of the last row. Text is copied and made printable. */
__attribute__((format(printf, 4, 5))) void wh_grid_text(wh_grid_t *grid, size_t column, wh_ink_t ink,
                                                        const char *format, ...);
void wh_grid_number(wh_grid_t *grid, size_t column, wh_ink_t ink, double value);

/* Sets `count` numbers side by side, from `column` on. */
void wh_grid_numbers(wh_grid_t *grid, size_t column, const double values[], size_t count);

/* How many rows there are. */
size_t wh_grid_rows(const wh_grid_t *grid);

/* Prints the table, unless it has no rows, and frees it. */
void wh_grid_print(wh_grid_t *grid, FILE *out);

/* Formats a number by a rule into `text`, with the decimals given, -0 as 0. `decimals` is what
 * wh_grid_decimals says of it or more. */
int wh_grid_decimals(const wh_grid_digits_t *digits, double value);
void wh_grid_format(char *text, size_t size, double value, int decimals);

/* Room for any double with 20 decimals. */
#define WH_GRID_NUMBER_SIZE 352

#endif
