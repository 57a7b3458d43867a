/* The files of a cell to start from: a layout, a script that runs in it, and files for editors. */
#ifndef WH_APP_NEW_CELL_H
#define WH_APP_NEW_CELL_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define WH_NEW_FOUPS 4
#define WH_NEW_BLADES 2
#define WH_NEW_MODULES 6
#define WH_NEW_LOCKS 2

/* The parts of the cell. */
typedef struct {
    uint64_t wafer; /* mm: a size that has a thickness and a pitch by default, see wh_new_cell_sizes */
    uint64_t foups;
    uint64_t blades;
    bool aligner, collision;
    bool tool;               /* its robots are times alone: no wafer sizes, no collisions */
    uint64_t modules, locks; /* of a tool */
} wh_new_cell_t;

/* mm; 0 ends the list. */
extern const uint64_t wh_new_cell_sizes[];

/* True if nothing is there yet; else standard error says so. */
bool wh_new_cell_is_free(const char *folder);

/* Makes the folder and its files; existing files are not overwritten. False, and standard error says why, if
 * one cannot be made; files that were made before stay. */
bool wh_new_cell_make(const wh_new_cell_t *cell, const char *folder);

/* layout.lua and script.lua of a tool. False if `out` does not take them. */
bool wh_new_tool_write_layout(const wh_new_cell_t *cell, FILE *out);
bool wh_new_tool_write_script(const wh_new_cell_t *cell, FILE *out);

#endif
