#include "grid.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"
#include "grid_internal.h"

wh_grid_t *wh_grid_new(const wh_style_t *style, size_t keys) {
    wh_grid_t *grid = calloc(1, sizeof *grid);
    if (grid) {
        grid->style = *style;
        grid->keys = keys;
    }
    return grid;
}

static void free_grid(wh_grid_t *grid) {
    for (size_t i = 0; i < grid->row_count * grid->column_count; ++i) {
        free(grid->cells[i].text);
    }
    for (size_t i = 0; i < grid->column_count; ++i) {
        free(grid->columns[i].heading);
    }
    free(grid->cells);
    free(grid);
}

static void add_column(wh_grid_t *grid, const char *heading, bool to_right, wh_grid_digits_t digits) {
    if (!grid || grid->column_count == WH_GRID_COLUMNS) {
        return;
    }
    wh_grid_column_t *column = &grid->columns[grid->column_count++];
    column->heading = wh_style_printable(heading);
    column->to_right = to_right;
    column->digits = digits;
    column->decimals = digits.least;
    grid->failed = grid->failed || !column->heading;
}

void wh_grid_text_column(wh_grid_t *grid, const char *heading) {
    const wh_grid_digits_t none = {0, 0, false, 0};
    add_column(grid, heading, false, none);
}

void wh_grid_number_column(wh_grid_t *grid, const char *heading, wh_grid_digits_t digits) {
    add_column(grid, heading, true, digits);
}

static bool reserve_row(wh_grid_t *grid) {
    grid->cells = wh_array_grow(grid->cells, grid->row_count, &grid->row_capacity,
                                grid->column_count * sizeof *grid->cells);
    return true;
}

void wh_grid_glue(wh_grid_t *grid) {
    if (grid && grid->column_count > 0) {
        grid->columns[grid->column_count - 1].glued = true;
    }
}

void wh_grid_row(wh_grid_t *grid) {
    if (!grid || grid->failed || grid->column_count == 0) {
        return;
    }
    if (!reserve_row(grid)) {
        grid->failed = true;
        return;
    }
    wh_grid_cell_t *row = &grid->cells[grid->row_count++ * grid->column_count];
    memset(row, 0, grid->column_count * sizeof *row);
}

size_t wh_grid_rows(const wh_grid_t *grid) {
    return grid ? grid->row_count : 0;
}

/* A cell of the last row, emptied, or null when there is none. */
static wh_grid_cell_t *last_cell(wh_grid_t *grid, size_t column) {
    if (!grid || grid->failed || grid->row_count == 0 || column >= grid->column_count) {
        return NULL;
    }
    wh_grid_cell_t *cell = &grid->cells[(grid->row_count - 1) * grid->column_count + column];
    free(cell->text);
    memset(cell, 0, sizeof *cell);
    return cell;
}

void wh_grid_text(wh_grid_t *grid, size_t column, wh_ink_t ink, const char *format, ...) {
    wh_grid_cell_t *cell = last_cell(grid, column);
    if (!cell) {
        return;
    }
    char *raw = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&raw, format, arguments);
    va_end(arguments);
    if (length >= 0) {
        cell->text = wh_style_printable(raw);
        cell->ink = ink;
        free(raw);
    }
    grid->failed = !cell->text;
}

void wh_grid_number(wh_grid_t *grid, size_t column, wh_ink_t ink, double value) {
    wh_grid_cell_t *cell = last_cell(grid, column);
    if (!cell) {
        return;
    }
    const int decimals = wh_grid_decimals(&grid->columns[column].digits, value);
    cell->number = value;
    cell->is_number = true;
    cell->ink = ink;
    if (decimals > grid->columns[column].decimals) {
        grid->columns[column].decimals = decimals;
    }
}

int wh_grid_discard(wh_grid_t *grid) {
    const int status = !grid || grid->failed ? -1 : 0;
    if (grid) {
        free_grid(grid);
    }
    return status;
}
