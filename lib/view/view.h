/* `sim --view`: the cell that a simulator serves, published for Drake's viewer (meldis), live.
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
#include "cell.h"

#define WH_CHANNEL_VIEWER_LOAD "DRAKE_VIEWER_LOAD_ROBOT"
#define WH_CHANNEL_VIEWER_DRAW "DRAKE_VIEWER_DRAW"

/* The shortest time between two messages of places, and the longest between two of each, us. */
#define WH_VIEW_DRAW_US 16667
#define WH_VIEW_LOAD_US 1000000

/* So much arrives whole, in fragments, with the system's default buffers. */
#define WH_VIEW_BYTES 196461

/* Must not be moved once opened. */
typedef struct {
    wh_node_t *node; /* null: nothing is published */
    wh_view_cell_t cell;
    uint8_t *load; /* encoded, once and for all */
    uint8_t *draw; /* room for it encoded */
    int load_size, draw_room;
    int64_t run, seq; /* of what went out last */
    int64_t last_load_us, last_draw_us;
    uint64_t loads, draws, unsent;
} wh_viewer_t;

/* Opens a view of a layout. WH_STATUS_BAD_CAPACITY, and nothing to close, if the cell does not fit
 * WH_VIEW_BYTES even without ledges and with boxes for meshes; view->cell.detail tells what was left out.
 * `node`, which may be null, and `layout` must outlive the view. */
wh_status_t wh_viewer_open(wh_viewer_t *view, wh_node_t *node, const wh_layout_t *layout);

/* Publishes what is due: to be called after each step and at least every 100 ms. Allocates nothing. */
void wh_viewer_tick(wh_viewer_t *view, const wh_protocol_server_t *server);

void wh_viewer_close(wh_viewer_t *view);

#endif
