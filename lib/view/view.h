/* `sim --view`: the cell that a simulator serves, and a board with time, command and hit, published for
 * Drake's viewer (meldis), live.
 *
 * The bodies go out at the beginning and once a second, for viewers that come later or missed them. Their
 * places go out at most 60 times a second while slices are stepped, once more at the end, and once a second.
 * All this goes by the wall clock. The simulation does not look at any of it: with a view it has the same
 * bits as without.
 */
#ifndef WH_VIEW_VIEW_H
#define WH_VIEW_VIEW_H

#include "../link/node.h"
#include "../link/protocol_server.h"
#include "board.h"
#include "cell.h"

#define WH_CHANNEL_VIEWER_LOAD "DRAKE_VIEWER_LOAD_ROBOT"
#define WH_CHANNEL_VIEWER_DRAW "DRAKE_VIEWER_DRAW"
#define WH_CHANNEL_BOARD_LOAD "DRAKE_VIEWER_LOAD_ROBOT_ILLUSTRATION"
#define WH_CHANNEL_BOARD_DRAW "DRAKE_VIEWER_DRAW_ILLUSTRATION"

/* The shortest time between two messages of places, and the longest between two of each, us. */
#define WH_VIEW_DRAW_US 16667
#define WH_VIEW_LOAD_US 1000000

/* So much arrives whole, in fragments, with the system's default buffers. */
#define WH_VIEW_BYTES 196461

/* Both messages of one kind of bodies, encoded. */
typedef struct {
    uint8_t *load, *draw;
    int load_size, load_room, draw_room;
    bool is_new; /* the bodies are others than those that went out */
} wh_viewer_bytes_t;

/* Must not be moved once opened. */
typedef struct {
    wh_node_t *node;     /* null: nothing is published */
    const char *command; /* borrowed: the line that motion control executes, or an empty one; null: none */
    wh_view_cell_t cell;
    wh_view_board_t board;
    wh_viewer_bytes_t cell_bytes, board_bytes;
    int64_t run, seq; /* of what went out last */
    int64_t hit_run;  /* of what is red */
    int64_t last_load_us, last_draw_us;
    uint64_t loads, draws, unsent;
} wh_viewer_t;

/* Opens a view of a layout. WH_STATUS_BAD_CAPACITY, and nothing to close, if the cell does not fit
 * WH_VIEW_BYTES even without ledges and with boxes for meshes; view->cell.detail tells what was left out.
 * `node`, which may be null, and `layout` must outlive the view, and so must what `command` is
 * set to then. */
wh_status_t wh_viewer_open(wh_viewer_t *view, wh_node_t *node, const wh_layout_t *layout);

/* Publishes what is due: to be called after each step and at least every 100 ms. Allocates nothing. */
void wh_viewer_tick(wh_viewer_t *view, const wh_protocol_server_t *server);

void wh_viewer_close(wh_viewer_t *view);

#endif
