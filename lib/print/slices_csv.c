#include "slices_csv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "print_internal.h"

/* The name as it stands in a row; to be freed. */
static char *make_word(const char *name) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out) {
        wh_print_csv_text(name, out);
    }
    if (!out || fclose(out) != 0) {
        wh_memory_out();
    }
    return text;
}

static void make_words(wh_slices_csv_t *csv) {
    const wh_layout_t *layout = csv->layout;
    const size_t grippers = layout->machine.gripper_count;
    csv->words = wh_array_new(layout->wafer_count + grippers, sizeof *csv->words);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        csv->words[w] = make_word(layout->wafers[w].name);
    }
    for (size_t g = 0; g < grippers; ++g) {
        csv->words[layout->wafer_count + g] = make_word(layout->grippers[g].name);
    }
}

void wh_slices_csv_open(wh_slices_csv_t *csv, const wh_layout_t *layout, FILE *out) {
    char name[WH_SLICE_FIELD_NAME];
    csv->layout = layout;
    csv->out = out;
    csv->count = wh_slice_field_count(layout);
    csv->columns = wh_array_new(csv->count, sizeof *csv->columns);
    fputs("slice,time s", out);
    for (size_t i = 0; i < csv->count; ++i) {
        csv->columns[i].kind = wh_slice_field_name(layout, i, name);
        csv->columns[i].is_new = true;
        fputc(',', out);
        wh_print_csv_text(name, out);
    }
    fputc('\n', out);
    make_words(csv);
    csv->blocks = wh_array_new(csv->count / WH_SLICES_CSV_BLOCK + 1, sizeof *csv->blocks);
    csv->before = wh_array_new(csv->count, sizeof *csv->before);
    csv->row = wh_array_new(csv->count + 1, WH_SLICES_CSV_WORD);
}

/* Appends to a block. The text is copied with all that is behind it: a copy of a fixed size is fast. */
static char *put_number(wh_slices_csv_column_t *column, double value, char *end) {
    const uint64_t bits = wh_double_bits(value);
    if (column->is_new || column->bits != bits) {
        column->text[0] = '\0';
        if (isfinite(value)) {
            wh_digits(value, column->text);
        }
        column->bits = bits;
        column->size = strlen(column->text);
        column->is_new = false;
    }
    memcpy(end, column->text, sizeof column->text);
    return end + column->size;
}

/* Appends the name for an index; nothing for WH_NONE. */
static char *put_word(const wh_slices_csv_t *csv, wh_slice_field_t kind, double value, char *end) {
    const char *word = wh_slice_field_word(csv->layout, kind, value);
    if (word[0] == '\0') {
        return end;
    }
    const size_t first = kind == WH_FIELD_WAFER ? 0 : csv->layout->wafer_count;
    const char *text = csv->words[first + (size_t)value];
    const size_t size = strlen(text);
    memcpy(end, text, size);
    return end + size;
}

static void make_block(wh_slices_csv_t *csv, size_t first, size_t count, const double values[]) {
    wh_slices_csv_block_t *block = &csv->blocks[first / WH_SLICES_CSV_BLOCK];
    char *end = block->text;
    for (size_t i = first; i < first + count; ++i) {
        wh_slices_csv_column_t *column = &csv->columns[i];
        *end++ = ',';
        end = column->kind == WH_FIELD_NUMBER ? put_number(column, values[i], end)
                                              : put_word(csv, column->kind, values[i], end);
    }
    block->size = (size_t)(end - block->text);
}

static char *put_block(wh_slices_csv_t *csv, size_t first, const double values[], char *end) {
    const wh_slices_csv_block_t *block = &csv->blocks[first / WH_SLICES_CSV_BLOCK];
    const size_t rest = csv->count - first;
    const size_t count = rest < WH_SLICES_CSV_BLOCK ? rest : WH_SLICES_CSV_BLOCK;
    if (block->size == 0 || memcmp(values + first, csv->before + first, count * sizeof *values) != 0) {
        make_block(csv, first, count, values);
    }
    memcpy(end, block->text, block->size);
    return end + block->size;
}

static char *put_whole(uint64_t number, char *end) {
    char digits[20];
    size_t at = sizeof digits;
    do {
        digits[--at] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    memcpy(end, digits + at, sizeof digits - at);
    return end + (sizeof digits - at);
}

/* Seconds with the digits of wh_digits: no double is nearer to so few decimals than that of the quotient. */
static char *put_seconds(int64_t time_us, char *end) {
    if (time_us < 100 || time_us >= INT64_C(1000000000000000)) {
        wh_digits((double)time_us / 1e6, end);
        return end + strlen(end);
    }
    uint64_t rest = (uint64_t)time_us % 1000000;
    end = put_whole((uint64_t)time_us / 1000000, end);
    if (rest > 0) {
        *end++ = '.';
    }
    for (uint64_t unit = 100000; rest > 0; rest %= unit, unit /= 10) {
        *end++ = (char)('0' + rest / unit);
    }
    return end;
}

void wh_slices_csv_row(wh_slices_csv_t *csv, int64_t slice, const double values[]) {
    char *end = put_whole((uint64_t)slice, csv->row);
    *end++ = ',';
    end = put_seconds(slice * csv->layout->slice_us, end);
    for (size_t i = 0; i < csv->count; i += WH_SLICES_CSV_BLOCK) {
        end = put_block(csv, i, values, end);
    }
    memcpy(csv->before, values, csv->count * sizeof *values);
    *end++ = '\n';
    fwrite(csv->row, 1, (size_t)(end - csv->row), csv->out);
}

void wh_slices_csv_close(wh_slices_csv_t *csv) {
    const size_t words = csv->words ? csv->layout->wafer_count + csv->layout->machine.gripper_count : 0;
    for (size_t i = 0; i < words; ++i) {
        free(csv->words[i]);
    }
    free(csv->words);
    free(csv->columns);
    free(csv->blocks);
    free(csv->before);
    free(csv->row);
    csv->words = NULL;
    csv->columns = NULL;
    csv->blocks = NULL;
    csv->before = NULL;
    csv->row = NULL;
}
