/* Printing a grid: numbers become text, parts get their columns, libsmartcols lays each part out. */
#include <libsmartcols.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "grid_internal.h"

/* Between two columns. */
#define SEPARATOR "  "

/* The columns of one part, by their indices. */
typedef struct {
    size_t columns[WH_GRID_COLUMNS];
    size_t count;
} part_t;

/* Numbers become text once all of their column are known. */
static void format_numbers(wh_grid_t *grid) {
    for (size_t i = 0; i < grid->row_count * grid->column_count; ++i) {
        wh_grid_cell_t *cell = &grid->cells[i];
        if (cell->is_number) {
            char text[WH_GRID_NUMBER_SIZE];
            wh_grid_format(text, sizeof text, cell->number, grid->columns[i % grid->column_count].decimals);
            cell->text = strdup(text);
            cell->is_number = false;
            grid->failed = grid->failed || !cell->text;
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

/* The column after the one at `column` and those glued to it; their width is added to `width`. */
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

/* The key columns, then as many from `first` on as the terminal has room for, but at least one, glued ones
 * together if a part can hold them. Returns the first column that is left for the next part. */
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

/* Whether a row says anything in a part beyond its keys. */
static bool row_speaks(const wh_grid_t *grid, const part_t *part, size_t row) {
    for (size_t i = 0; i < part->count; ++i) {
        const char *text = grid->cells[row * grid->column_count + part->columns[i]].text;
        if (part->columns[i] >= grid->keys && text && text[0] != '\0') {
            return true;
        }
    }
    return false;
}

static int add_headings(const wh_grid_t *grid, const part_t *part, struct libscols_table *table) {
    int status = 0;
    for (size_t i = 0; i < part->count && status == 0; ++i) {
        const wh_grid_column_t *column = &grid->columns[part->columns[i]];
        const int flags = column->to_right ? SCOLS_FL_RIGHT : 0;
        struct libscols_column *added = scols_table_new_column(table, column->heading, 0, flags);
        const char *bold = wh_style_ink(&grid->style, WH_INK_BOLD);
        status = !added ? -1 : bold ? scols_cell_set_color(scols_column_get_header(added), bold) : 0;
    }
    return status;
}

static int add_line(const wh_grid_t *grid, const part_t *part, size_t row, struct libscols_table *table) {
    struct libscols_line *line = scols_table_new_line(table, NULL);
    int status = line ? 0 : -1;
    for (size_t i = 0; i < part->count && status == 0; ++i) {
        const wh_grid_cell_t *cell = &grid->cells[row * grid->column_count + part->columns[i]];
        const char *ink = wh_style_ink(&grid->style, cell->ink);
        if (cell->text) {
            status = scols_line_set_data(line, i, cell->text);
            status |= ink ? scols_cell_set_color(scols_line_get_cell(line, i), ink) : 0;
        }
    }
    return status;
}

/* Lines end where their text ends. */
static void print_trimmed(const char *text, FILE *out) {
    while (*text != '\0') {
        const size_t length = strcspn(text, "\n");
        size_t end = length;
        while (end > 0 && text[end - 1] == ' ') {
            --end;
        }
        fwrite(text, 1, end, out);
        fputc('\n', out);
        text += length + (text[length] == '\n');
    }
}

static int print_part(const wh_grid_t *grid, const part_t *part, FILE *out) {
    struct libscols_table *table = scols_new_table();
    char *text = NULL;
    int status = table ? 0 : -1;
    if (table) {
        scols_table_enable_noencoding(table, 1);
        scols_table_enable_colors(table, grid->style.colour);
        scols_table_set_termforce(table, SCOLS_TERMFORCE_NEVER);
        status |= scols_table_set_column_separator(table, SEPARATOR);
        status |= add_headings(grid, part, table);
    }
    for (size_t row = 0; row < grid->row_count && status == 0; ++row) {
        status = row_speaks(grid, part, row) ? add_line(grid, part, row, table) : 0;
    }
    status = status != 0 ? status : scols_print_table_to_string(table, &text);
    if (status == 0 && text) {
        print_trimmed(text, out);
    }
    free(text);
    scols_unref_table(table);
    return status == 0 ? 0 : -1;
}

static int print_parts(const wh_grid_t *grid, FILE *out) {
    int status = 0;
    size_t first = 0;
    while (first < grid->column_count && status == 0) {
        part_t part;
        fputs(first > 0 ? "\n" : "", out);
        first = plan_part(grid, first, &part);
        status = print_part(grid, &part, out);
    }
    return status;
}

int wh_grid_print(wh_grid_t *grid, FILE *out) {
    if (grid && !grid->failed) {
        format_numbers(grid);
    }
    if (!grid || grid->failed) {
        return wh_grid_discard(grid);
    }
    measure_columns(grid);
    const int status = print_parts(grid, out);
    (void)wh_grid_discard(grid);
    return status;
}
