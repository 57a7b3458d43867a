/* A board above the cell, for Drake's viewer: simulated time, the running command, and the parts that were
 * hit.
 *
 * The viewer has no text that LCM can reach. So lines are meshes of small rectangles, in capitals of five
 * by seven dots; a byte without such a letter is a box. The digits of the time have seven segments, which
 * DRAW moves, so that the time runs without a new LOAD. The board has channels of its own: a new line makes
 * the viewer restart with the board, not with the cell.
 *
 * Host code: it ends the program if out of memory. Nothing is allocated after wh_view_board_open.
 */
#ifndef WH_VIEW_BOARD_H
#define WH_VIEW_BOARD_H

#include "../layout/layout.h"
#include "geometry.h"

/* Characters across the board, and digits of the time, the last of them tenths of a second. */
#define WH_VIEW_COLUMNS 30
#define WH_VIEW_DIGITS 6
#define WH_VIEW_SEGMENTS 7

/* The command stands after the time and has 20 characters; the lines below have the full width. */
typedef enum { WH_VIEW_COMMAND, WH_VIEW_HIT, WH_VIEW_HIT_WITH, WH_VIEW_LINES } wh_view_line_t;

/* Rectangles of a line: a text that needs more is cut off. */
#define WH_VIEW_RECTANGLES 300

/* The bodies: the back, the unit of time, the lines, the segments. */
typedef struct {
    wh_view_bodies_t bodies;
    wh_pose_t base_from_board; /* x to the right, y up, z to the viewer */
    double dot;                /* mm */
    int64_t tenths;            /* of a second: the digits' value */
    char lines[WH_VIEW_LINES][WH_VIEW_COLUMNS + 1];
} wh_view_board_t;

/* The position of a viewer, from the cell's middle, in base; of any length. */
extern const wh_vec3_t wh_view_from;

/* A board behind the cell, over its highest part, as wide as most of the cell; it shows 0 s and no lines. */
void wh_view_board_open(wh_view_board_t *board, const wh_layout_t *layout);

/* The most bytes of the encoded `load`, for any text. */
int wh_view_board_room(const wh_view_board_t *board);

/* Writes a line for `load`, cut off at the board's edge. Returns false if it already has that text. */
bool wh_view_board_write(wh_view_board_t *board, wh_view_line_t line, const char *text);

/* Shows a time for `draw`: up to 99999.9 s, then from 0 again. Returns false if no digit changes. */
bool wh_view_board_set_time(wh_view_board_t *board, int64_t utime);

void wh_view_board_free(wh_view_board_t *board);

#endif
