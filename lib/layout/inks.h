/* The colours of a cell's parts in drawings (`layout --svg`) and in glTF. The report's page has paler ones,
 * in its style sheet. */
#ifndef WH_LAYOUT_INKS_H
#define WH_LAYOUT_INKS_H

#include "../collision/world.h"

/* How a part looks. */
typedef enum {
    WH_INK_WALL,
    WH_INK_SHELL,
    WH_INK_LEDGE,
    WH_INK_WAFER,
    WH_INK_ARM,
    WH_INK_CHUCK,
    WH_INK_BLADE,
    WH_INKS
} wh_part_ink_t;

/* A screen's colour (sRGB), 0xrrggbb, on light and on dark paper. */
typedef struct {
    uint32_t light, dark;
} wh_colour_t;

typedef struct {
    const char *class, *name; /* in a drawing, and in its key */
    wh_colour_t drawn;
    const char *opacity; /* in a drawing */
} wh_ink_look_t;

extern const wh_ink_look_t wh_ink_looks[WH_INKS];

/* A part's material in glTF: `drawn.light` in linear light. All numbers are 0 to 1. */
typedef struct {
    const char *name;
    double red, green, blue, opacity;
    double metallic, roughness;
} wh_ink_material_t;

extern const wh_ink_material_t wh_ink_materials[WH_INKS];

wh_part_ink_t wh_ink_of(const wh_part_t *part);

#endif
