/* The colours of a cell in Drake's viewer: those of the report's page (lib/report/page/page.css), in light,
 * but less transparent: there are no edges here. */
#ifndef WH_VIEW_COLOURS_H
#define WH_VIEW_COLOURS_H

#include "../collision/world.h"

/* As a screen has it (sRGB), 0 to 1. */
typedef struct {
    float red, green, blue, opacity;
} wh_view_colour_t;

/* A part's; a blade or chuck has its gripper's, obstacles and shells let one look through. */
wh_view_colour_t wh_view_colour_of_part(const wh_part_t *part);

/* A wafer's that nobody holds, and that of one that a gripper holds: paler than the gripper. */
wh_view_colour_t wh_view_colour_of_wafer(void);
wh_view_colour_t wh_view_colour_of_held(size_t gripper);

/* Of the mark at a wafer's notch. */
wh_view_colour_t wh_view_colour_of_notch(void);

#endif
