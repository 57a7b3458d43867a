/* A run's slices as a table for other programs: CSV by RFC 4180, but with lines that end with a line feed. */
#ifndef WH_PRINT_SLICES_CSV_H
#define WH_PRINT_SLICES_CSV_H

#include <stdint.h>
#include <stdio.h>

#include "../log/slice_fields.h"
#include "../text/digits.h"

/* A column, and its last text: most values are those of the row before. */
typedef struct {
    wh_slice_field_t kind; /* the texts of indices are in `words` */
    uint64_t bits;
    bool is_new;
    size_t size;
    char text[WH_DIGITS];
} wh_slices_csv_column_t;

/* A block has this number of columns. Its text is kept while none of its values changes. */
enum { WH_SLICES_CSV_BLOCK = 8 };

/* A name in a row may be in quotes, with each of its own doubled, behind a comma. */
#define WH_SLICES_CSV_WORD (2 * WH_NAME_SIZE + 4)

typedef struct {
    size_t size; /* 0: not made yet */
    char text[WH_SLICES_CSV_BLOCK * WH_SLICES_CSV_WORD];
} wh_slices_csv_block_t;

typedef struct {
    const wh_layout_t *layout; /* the caller's */
    FILE *out;                 /* the caller's; errors are its own */
    wh_slices_csv_column_t *columns;
    size_t count;
    wh_slices_csv_block_t *blocks;
    double *before; /* the last row's values */
    char **words;   /* the names of the wafers, then those of the grippers, as they stand in a row */
    char *row;      /* room for one */
} wh_slices_csv_t;

/* Prints the head: "slice", "time s", and the names of log/slice_fields.h. To be closed. */
void wh_slices_csv_open(wh_slices_csv_t *csv, const wh_layout_t *layout, FILE *out);

/* Prints a slice's row, of the `values` of its fields. Numbers have the digits that read back as the same
 * double; the holder and the nearest part stand there by name; unknown or missing values are empty. Cost:
 * linear in the columns; text is made only for what has changed. */
void wh_slices_csv_row(wh_slices_csv_t *csv, int64_t slice, const double values[]);

void wh_slices_csv_close(wh_slices_csv_t *csv);

#endif
