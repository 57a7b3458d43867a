#include "field.h"

#include <stdio.h>
#include <string.h>

#include "../math/hash.h"
#include "../math/trig.h"

const wh_reader_field_t *wh_field_find(const wh_reader_field_t *rows, const char *name) {
    while (rows->name && strcmp(rows->name, name) != 0) {
        ++rows;
    }
    return rows->name ? rows : NULL;
}

void wh_field_type(const wh_reader_field_t *row, char *type, size_t size) {
    size_t used = (size_t)snprintf(type, size, "%s", row->words ? "" : row->type);
    for (size_t i = 0; row->words && row->words[i] && used < size; ++i) {
        used += (size_t)snprintf(type + used, size - used, "%s\"%s\"", i > 0 ? "|" : "", row->words[i]);
    }
}

bool wh_field_is_number(const wh_reader_field_t *row) {
    return row->kind >= WH_SCALAR_NUMBER && row->kind <= WH_SCALAR_SEED;
}

bool wh_field_is_member(const wh_reader_field_t *row) {
    return row->kind >= WH_SCALAR_NUMBER;
}

uint64_t wh_field_hash(const wh_reader_field_t *row, const void *of, uint64_t hash) {
    const bool is_real = row->kind == WH_SCALAR_NUMBER || row->kind == WH_SCALAR_DEGREES;
    return is_real ? wh_hash_real(hash, *(const double *)(const void *)((const char *)of + row->offset))
                   : wh_hash_int(hash, (int32_t)wh_field_get(row, of));
}

double wh_field_get(const wh_reader_field_t *row, const void *of) {
    const void *at = (const char *)of + row->offset;
    switch (row->kind) {
    case WH_SCALAR_NUMBER:
        return *(const double *)at;
    case WH_SCALAR_DEGREES:
        return (double)wh_deg_from_rad((wh_real_t) * (const double *)at);
    case WH_SCALAR_WHOLE:
    case WH_SCALAR_WORD:
        return *(const int32_t *)at;
    case WH_SCALAR_SEED:
        return (double)*(const uint64_t *)at;
    case WH_SCALAR_SWITCH:
        return *(const bool *)at ? 1 : 0;
    case WH_SCALAR_BY_HAND:
    case WH_SCALAR_APART:
        break;
    }
    return 0;
}

void wh_field_set(const wh_reader_field_t *row, double value, void *of) {
    void *at = (char *)of + row->offset;
    switch (row->kind) {
    case WH_SCALAR_NUMBER:
        *(double *)at = value;
        break;
    case WH_SCALAR_DEGREES:
        *(double *)at = (double)wh_rad_from_deg((wh_real_t)value);
        break;
    case WH_SCALAR_WHOLE:
    case WH_SCALAR_WORD:
        *(int32_t *)at = (int32_t)value;
        break;
    case WH_SCALAR_SEED:
        *(uint64_t *)at = (uint64_t)value;
        break;
    case WH_SCALAR_SWITCH:
        *(bool *)at = value > 0;
        break;
    case WH_SCALAR_BY_HAND:
    case WH_SCALAR_APART:
        break;
    }
}

void wh_field_unit(const wh_reader_field_t *row, char unit[WH_FIELD_UNIT_BYTES]) {
    static const char *const units[] = {"mm",          "mm/s", "mm/s^2", "mm/s^3", "degrees", "degrees/s",
                                        "degrees/s^2", "s",    "N",      "kg",     "m/s^2",   NULL};
    const size_t length = strcspn(row->text, " :,;");
    size_t i = 0;
    while (units[i] && (strlen(units[i]) != length || strncmp(units[i], row->text, length) != 0)) {
        ++i;
    }
    (void)snprintf(unit, WH_FIELD_UNIT_BYTES, "%s", units[i] ? units[i] : "");
}
