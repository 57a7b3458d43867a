/* Reads scalars by their rows. */
#include <math.h>
#include <string.h>

#include "../math/config.h"
#include "reader.h"

/* A number; a kept one that the table does not have keeps its bits. */
static void read_real(wh_reader_t *reader, const wh_reader_field_t *row, void *into, double fallback,
                      double least, double most) {
    if (wh_reader_has(reader, row->name) || isfinite(fallback)) {
        wh_field_set(row, wh_reader_number(reader, row->name, fallback, least, most), into);
    } else if (row->required) {
        (void)wh_reader_number(reader, row->name, WH_REAL(NAN), least, most);
    }
}

static void read_row(wh_reader_t *reader, const wh_reader_field_t *row, void *into, double fallback,
                     double least, double most) {
    if (row->kind == WH_SCALAR_NUMBER || row->kind == WH_SCALAR_DEGREES) {
        read_real(reader, row, into, fallback, least, most);
        return;
    }
    const int32_t usual = (int32_t)(isinf(fallback) ? wh_field_get(row, into) : fallback);
    if (row->kind == WH_SCALAR_SWITCH) {
        wh_field_set(row, wh_reader_boolean(reader, row->name, usual > 0) ? 1 : 0, into);
    } else if (row->kind == WH_SCALAR_WORD) {
        wh_field_set(row, wh_reader_choice(reader, row->name, usual, row->words), into);
    } else {
        wh_field_set(row, wh_reader_whole(reader, row->name, usual, (int32_t)least, (int32_t)most), into);
    }
}

const wh_reader_field_t *wh_reader_row(const wh_reader_t *reader, const char *field) {
    const wh_reader_field_t *rows = reader->known[reader->depth];
    const wh_reader_field_t *row = rows ? wh_field_find(rows, field) : NULL;
    WH_ASSERT(row && row->kind != WH_SCALAR_BY_HAND);
    return row;
}

void wh_reader_scalar_from(wh_reader_t *reader, const char *field, void *into, double fallback) {
    const wh_reader_field_t *row = wh_reader_row(reader, field);
    read_row(reader, row, into, fallback, row->least, row->most);
}

void wh_reader_scalar_within(wh_reader_t *reader, const char *field, void *into, double fallback,
                             double least, double most) {
    read_row(reader, wh_reader_row(reader, field), into, fallback, least, most);
}

void wh_reader_scalars(wh_reader_t *reader, void *into) {
    for (const wh_reader_field_t *row = reader->known[reader->depth]; row->name; ++row) {
        if (wh_field_is_member(row) && !isnan(row->usual)) {
            read_row(reader, row, into, row->usual, row->least, row->most);
        }
    }
}

/* The default of a word, a switch or a whole number; below the range: it is required. */
static int32_t whole_default(const wh_reader_field_t *row, double fallback) {
    return (int32_t)(isfinite(fallback) ? fallback : row->least - 1);
}

double wh_reader_apart_from(wh_reader_t *reader, const char *field, double fallback) {
    const wh_reader_field_t *row = wh_reader_row(reader, field);
    if (row->words) {
        return wh_reader_choice(reader, field, whole_default(row, fallback), row->words);
    }
    if (strcmp(row->type, "boolean") == 0) {
        return wh_reader_boolean(reader, field, whole_default(row, fallback) > 0) ? 1 : 0;
    }
    return strcmp(row->type, "integer") == 0 ? wh_reader_whole(reader, field, whole_default(row, fallback),
                                                               (int32_t)row->least, (int32_t)row->most)
                                             : wh_reader_number(reader, field, (wh_real_t)fallback,
                                                                (wh_real_t)row->least, (wh_real_t)row->most);
}

double wh_reader_apart(wh_reader_t *reader, const char *field) {
    return wh_reader_apart_from(reader, field, wh_reader_row(reader, field)->usual);
}
