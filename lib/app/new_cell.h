/* The files of a cell to start from: a layout, a script that runs in it, and what editors need. */
#ifndef WH_APP_NEW_CELL_H
#define WH_APP_NEW_CELL_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define WH_NEW_FOUPS 4
#define WH_NEW_BLADES 2

/* What the cell has. */
typedef struct {
    uint64_t wafer; /* mm: a size that has a thickness and a pitch by default, see wh_new_cell_sizes */
    uint64_t foups;
    uint64_t blades;
    bool aligner, collision;
} wh_new_cell_t;

/* mm; 0 ends the list. */
extern const uint64_t wh_new_cell_sizes[];

/* A file of the cell; `write` returns false if `out` does not take it. */
typedef struct {
    const char *name;
    bool (*write)(const wh_new_cell_t *cell, FILE *out);
} wh_new_file_t;

/* In the order in which they are made; a null name ends the list. */
extern const wh_new_file_t wh_new_cell_files[];

#endif
