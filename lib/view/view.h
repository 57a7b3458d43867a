/* `sim --view`: publishes, live for Drake's viewer (meldis), the cell that a simulator serves, and a board
 * with time, command and hit.
 *
 * The bodies are sent at the beginning and once a second, for viewers that start later or missed them.
 * Their places are sent at most 60 times a second while slices are stepped, once more at the end, and once
 * a second. All this follows the wall clock. The simulation uses none of it: with a view it has the same
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

/* This number of bytes arrives complete, in fragments, with the system's default buffers. */
#define WH_VIEW_BYTES 196461

/* Both messages of one kind of bodies, encoded. */
typedef struct {
    uint8_t *load, *draw;
    int load_size, load_room, draw_room;
    bool is_new; /* the bodies differ from those that were sent */
} wh_viewer_bytes_t;

/* It must not be moved once opened. */
typedef struct {
    wh_node_t *node;     /* null: nothing is published */
    const char *command; /* borrowed: the line that motion control executes, or an empty one; null: none */
    wh_view_cell_t cell;
    wh_view_board_t board;
    wh_viewer_bytes_t cell_bytes, board_bytes;
    int64_t run, seq; /* of the last message sent */
    int64_t hit_run;  /* run of the red parts */
    int64_t last_load_us, last_draw_us;
    uint64_t loads, draws, unsent;
} wh_viewer_t;

/* Opens a view of a layout. Returns WH_STATUS_BAD_CAPACITY, with nothing to close, if the cell does not fit
 * WH_VIEW_BYTES even without ledges and with boxes for meshes. view->cell.detail tells which parts were
 * left out. `node`, which may be null, and `layout` must outlive the view; so must the text that `command`
 * points to. */
wh_status_t wh_viewer_open(wh_viewer_t *view, wh_node_t *node, const wh_layout_t *layout);

/* Publishes the messages that are due. Call it after each step and at least every 100 ms. It allocates
 * nothing. */
void wh_viewer_tick(wh_viewer_t *view, const wh_protocol_server_t *server);

void wh_viewer_close(wh_viewer_t *view);

#endif
