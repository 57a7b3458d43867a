#include "grid.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"

/* The text between two columns. */
#define SEPARATOR "  "

/* With this number of decimals every double differs from a limit next to it. */
#define MOST_DECIMALS 20

/* A cell is empty, a text (not null) or a number. */
typedef struct {
    char *text;
    double number;
    bool is_number;
    wh_ink_t ink;
} wh_grid_cell_t;

typedef struct {
    char *heading;
    bool to_right;
    bool glued; /* stays next to the column before it if there is room */
    wh_grid_digits_t digits;
    int decimals; /* the decimals that the numbers so far need */
    size_t width; /* columns of the terminal that its widest cell takes */
} wh_grid_column_t;

struct wh_grid {
    wh_style_t style;
    size_t keys;
    wh_grid_column_t columns[WH_GRID_COLUMNS];
    size_t column_count;
    wh_grid_cell_t *cells; /* row by row */
    size_t row_count, row_capacity;
};

/* The columns of one part, by their indices. */
typedef struct {
    size_t columns[WH_GRID_COLUMNS];
    size_t count;
} part_t;

/* ------------------------------------------------------------------------------------------------- digits */

void wh_grid_format(char *text, size_t size, double value, int decimals) {
    snprintf(text, size, "%.*f", decimals, value);
    if (text[0] == '-' && strspn(text, "-0.") == strlen(text)) {
        memmove(text, text + 1, strlen(text));
    }
}

/* Returns -1, 0 or 1: below, at, above. */
static int side_of(double value, double limit) {
    return (value > limit) - (value < limit);
}

/* The fewest decimals, from `least` to `most`, that show as much as `most` decimals. */
static int decimals_in_use(double value, int least, int most) {
    char text[WH_GRID_NUMBER_SIZE];
    int decimals = most;
    wh_grid_format(text, sizeof text, value, most);
    const char *last = text + strlen(text) - 1;
    while (decimals > least && *last == '0') {
        --decimals;
        --last;
    }
    return decimals;
}

int wh_grid_decimals(const wh_grid_digits_t *digits, double value) {
    char text[WH_GRID_NUMBER_SIZE];
    if (!isfinite(value)) {
        return digits->least;
    }
    int decimals = decimals_in_use(value, digits->least, digits->most);
    while (digits->has_limit && decimals < MOST_DECIMALS) {
        wh_grid_format(text, sizeof text, value, decimals);
        if (side_of(strtod(text, NULL), digits->limit) == side_of(value, digits->limit)) {
            break;
        }
        ++decimals;
    }
    return decimals;
}

/* ------------------------------------------------------------------------------------------------ filling */

wh_grid_t *wh_grid_new(const wh_style_t *style, size_t keys, const char *columns) {
    wh_grid_t *grid = wh_array_new(1, sizeof *grid);
    grid->style = *style;
    grid->keys = keys;
    wh_grid_columns(grid, columns);
    return grid;
}

/* Adds the column that `text` begins with. */
static void add_column(wh_grid_t *grid, const char *text) {
    wh_grid_column_t *column = &grid->columns[grid->column_count++];
    wh_grid_digits_t *digits = &column->digits;
    column->glued = *text == '+';
    text += column->glued ? 1 : 0;
    const size_t length = strcspn(text, "{;");
    char *heading = wh_memory_need(strndup(text, length));
    column->heading = wh_style_printable(heading);
    free(heading);
    column->to_right = text[length] == '{';
    if (column->to_right) {
        char *end;
        digits->least = (int)strtol(text + length + 1, &end, 10);
        digits->most = *end == ',' ? (int)strtol(end + 1, NULL, 10) : digits->least;
    }
    column->decimals = digits->least;
}

void wh_grid_columns(wh_grid_t *grid, const char *columns) {
    while (columns && grid->column_count < WH_GRID_COLUMNS) {
        add_column(grid, columns);
        const char *end = strchr(columns, ';');
        columns = end ? end + 1 : NULL;
    }
}

void wh_grid_limit(wh_grid_t *grid, double limit) {
    wh_grid_digits_t *digits = &grid->columns[grid->column_count - 1].digits;
    digits->has_limit = true;
    digits->limit = limit;
}

void wh_grid_row(wh_grid_t *grid) {
    const size_t bytes = grid->column_count * sizeof *grid->cells;
    grid->cells = wh_array_grow(grid->cells, grid->row_count, &grid->row_capacity, bytes);
    memset(&grid->cells[grid->row_count++ * grid->column_count], 0, bytes);
}

void wh_grid_named_row(wh_grid_t *grid, const char *name) {
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", name);
}

size_t wh_grid_rows(const wh_grid_t *grid) {
    return grid->row_count;
}

/* A cell of the last row, emptied. */
static wh_grid_cell_t *last_cell(wh_grid_t *grid, size_t column) {
    wh_grid_cell_t *cell = &grid->cells[(grid->row_count - 1) * grid->column_count + column];
    free(cell->text);
    memset(cell, 0, sizeof *cell);
    return cell;
}

void wh_grid_text(wh_grid_t *grid, size_t column, wh_ink_t ink, const char *format, ...) {
    wh_grid_cell_t *cell = last_cell(grid, column);
    char *raw = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&raw, format, arguments) < 0) {
        wh_memory_out();
    }
    va_end(arguments);
    cell->text = wh_style_printable(raw);
    cell->ink = ink;
    free(raw);
}

void wh_grid_number(wh_grid_t *grid, size_t column, wh_ink_t ink, double value) {
    wh_grid_cell_t *cell = last_cell(grid, column);
    const int decimals = wh_grid_decimals(&grid->columns[column].digits, value);
    cell->number = value;
    cell->is_number = true;
    cell->ink = ink;
    if (decimals > grid->columns[column].decimals) {
        grid->columns[column].decimals = decimals;
    }
}

void wh_grid_numbers(wh_grid_t *grid, size_t column, const double values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        wh_grid_number(grid, column + i, WH_INK_PLAIN, values[i]);
    }
}

/* ----------------------------------------------------------------------------------------------- printing */

/* Numbers become text when all rows are known: a column's numbers share their decimals. */
static void format_numbers(wh_grid_t *grid) {
    for (size_t i = 0; i < grid->row_count * grid->column_count; ++i) {
        wh_grid_cell_t *cell = &grid->cells[i];
        if (cell->is_number) {
            char text[WH_GRID_NUMBER_SIZE];
            wh_grid_format(text, sizeof text, cell->number, grid->columns[i % grid->column_count].decimals);
            cell->text = wh_text_copy(text);
            cell->is_number = false;
        }
    }
}

static void measure_columns(wh_grid_t *grid) {
    for (size_t c = 0; c < grid->column_count; ++c) {
        wh_grid_column_t *column = &grid->columns[c];
        column->width = wh_style_columns(column->heading);
        for (size_t row = 0; row < grid->row_count; ++row) {
            const char *text = grid->cells[row * grid->column_count + c].text;
            const size_t width = text ? wh_style_columns(text) : 0;
            column->width = width > column->width ? width : column->width;
        }
    }
}

/* Adds the width of a column and of those glued to it. Returns the column after them. */
static size_t end_of_unit(const wh_grid_t *grid, size_t column, size_t *width) {
    *width += grid->columns[column++].width;
    while (column < grid->column_count && grid->columns[column].glued) {
        *width += strlen(SEPARATOR) + grid->columns[column++].width;
    }
    return column;
}

static size_t add_keys(const wh_grid_t *grid, size_t first, part_t *part) {
    size_t width = 0;
    part->count = 0;
    for (size_t c = 0; c < grid->keys && c < first; ++c) {
        part->columns[part->count++] = c;
        width += grid->columns[c].width + strlen(SEPARATOR);
    }
    return width;
}

/* Takes the key columns, then as many from `first` on as the terminal has room for, but at least one; glued
 * columns stay together if a part can hold them. Returns the first column of the next part. */
static size_t plan_part(const wh_grid_t *grid, size_t first, part_t *part) {
    const size_t room = grid->style.width > 0 ? grid->style.width : SIZE_MAX;
    size_t width = add_keys(grid, first, part);
    size_t next = first;
    while (next < grid->column_count) {
        size_t with_unit = width;
        size_t end = end_of_unit(grid, next, &with_unit);
        if (with_unit > room && next == first) {
            with_unit = width + grid->columns[next].width;
            end = next + 1;
        }
        if (with_unit > room && next > first) {
            break;
        }
        while (next < end) {
            part->columns[part->count++] = next++;
        }
        width = with_unit + strlen(SEPARATOR);
    }
    return next;
}

/* True if a row has a value in a part outside its keys. */
static bool row_speaks(const wh_grid_t *grid, const part_t *part, size_t row) {
    for (size_t i = 0; i < part->count; ++i) {
        const char *text = grid->cells[row * grid->column_count + part->columns[i]].text;
        if (part->columns[i] >= grid->keys && text && text[0] != '\0') {
            return true;
        }
    }
    return false;
}

/* The cell of a column in a row; row `row_count` is the heading. */
static wh_grid_cell_t cell_of(const wh_grid_t *grid, size_t column, size_t row) {
    if (row < grid->row_count) {
        return grid->cells[row * grid->column_count + column];
    }
    return (wh_grid_cell_t){.text = grid->columns[column].heading, .ink = WH_INK_BOLD};
}

/* The columns of the terminal that a column's widest cell takes in this part. */
static size_t width_in(const wh_grid_t *grid, const part_t *part, size_t column) {
    size_t width = wh_style_columns(grid->columns[column].heading);
    for (size_t row = 0; row < grid->row_count; ++row) {
        const char *text = grid->cells[row * grid->column_count + column].text;
        const size_t taken = text && row_speaks(grid, part, row) ? wh_style_columns(text) : 0;
        width = taken > width ? taken : width;
    }
    return width;
}

/* Prints a row without blanks at its end: those before a cell wait until there is a cell. */
static void print_row(const wh_grid_t *grid, const part_t *part, const size_t *widths, size_t row,
                      FILE *out) {
    size_t blanks = 0;
    for (size_t i = 0; i < part->count; ++i) {
        const wh_grid_cell_t cell = cell_of(grid, part->columns[i], row);
        const char *text = cell.text ? cell.text : "";
        const size_t room = widths[i] - wh_style_columns(text);
        const size_t left = grid->columns[part->columns[i]].to_right ? room : 0;
        if (text[0] != '\0') {
            (void)fprintf(out, "%*s", (int)(blanks + left), "");
            wh_style_print(&grid->style, out, cell.ink, "%s", text);
            blanks = room - left;
        } else {
            blanks += room;
        }
        blanks += strlen(SEPARATOR);
    }
    fputc('\n', out);
}

static void print_part(const wh_grid_t *grid, const part_t *part, FILE *out) {
    size_t widths[WH_GRID_COLUMNS];
    bool has_heading = false;
    for (size_t i = 0; i < part->count; ++i) {
        widths[i] = width_in(grid, part, part->columns[i]);
    }
    for (size_t row = 0; row < grid->row_count; ++row) {
        if (row_speaks(grid, part, row)) {
            if (!has_heading) {
                print_row(grid, part, widths, grid->row_count, out);
                has_heading = true;
            }
            print_row(grid, part, widths, row, out);
        }
    }
}

void wh_grid_print(wh_grid_t *grid, FILE *out) {
    format_numbers(grid);
    measure_columns(grid);
    for (size_t first = 0; grid->row_count > 0 && first < grid->column_count;) {
        part_t part;
        fputs(first > 0 ? "\n" : "", out);
        first = plan_part(grid, first, &part);
        print_part(grid, &part, out);
    }
    for (size_t i = 0; i < grid->row_count * grid->column_count; ++i) {
        free(grid->cells[i].text);
    }
    for (size_t i = 0; i < grid->column_count; ++i) {
        free(grid->columns[i].heading);
    }
    free(grid->cells);
    free(grid);
}
