/* The parts of a layout's cell, by name. */
#ifndef WH_TESTS_SUPPORT_PARTS_H
#define WH_TESTS_SUPPORT_PARTS_H

#include "support/layout.h"

/* WH_NONE: there is no such part. */
static inline int32_t find(const wh_layout_t *layout, const char *name) {
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        if (strcmp(layout->part_names[i], name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_NONE;
}

static inline const wh_part_t *part(const wh_layout_t *layout, const char *name) {
    const int32_t index = find(layout, name);
    if (index == WH_NONE) {
        fail_msg("no part \"%s\"", name);
    }
    return &layout->world.parts[index];
}

#endif
