/* A cell as a picture, from above and from the side, with every part by name. */
#ifndef WH_PRINT_DRAWING_H
#define WH_PRINT_DRAWING_H

#include <stdio.h>

#include "../survey/feasibility.h"

/* Writes an SVG image of the cell with the robot at home. Parts that a finding names are marked. Colours
 * follow the viewer's preference for light or dark. Ends the program if out of memory. 0, or -1 if `out`
 * fails (then errno says why). */
int wh_layout_print_svg(const wh_feasibility_t *check, FILE *out);

#endif
