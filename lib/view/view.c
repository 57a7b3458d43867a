#include "view.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* Makes both messages, with as much of the cell as they have room for. */
static bool fit(wh_viewer_t *view, const wh_layout_t *layout) {
    for (int detail = WH_VIEW_ALL; detail < WH_VIEW_DETAILS; ++detail) {
        wh_view_cell_open(&view->cell, layout, (wh_view_detail_t)detail);
        view->load_size = waferhand_viewer_load_encoded_size(&view->cell.load);
        view->draw_room = waferhand_viewer_draw_encoded_size(&view->cell.draw);
        if (view->load_size <= WH_VIEW_BYTES && view->draw_room <= WH_LINK_DATAGRAM) {
            return true;
        }
        wh_view_cell_free(&view->cell);
    }
    return false;
}

wh_status_t wh_viewer_open(wh_viewer_t *view, wh_node_t *node, const wh_layout_t *layout) {
    memset(view, 0, sizeof *view);
    view->node = node;
    if (!fit(view, layout)) {
        return WH_STATUS_BAD_CAPACITY;
    }
    view->load = wh_array_new((size_t)view->load_size, 1);
    view->draw = wh_array_new((size_t)view->draw_room, 1);
    if (waferhand_viewer_load_encode(view->load, 0, view->load_size, &view->cell.load) != view->load_size) {
        wh_viewer_close(view);
        return WH_STATUS_BAD_CAPACITY;
    }
    view->last_load_us = wh_node_clock_us() - WH_VIEW_LOAD_US;
    view->last_draw_us = view->last_load_us;
    return WH_OK;
}

static void publish(wh_viewer_t *view, const char *channel, const uint8_t *data, int size) {
    if (view->node && (size <= 0 || !wh_node_publish(view->node, channel, data, (size_t)size))) {
        ++view->unsent;
    }
}

/* Before the first slice grippers have no poses yet: all is shown at rest. */
static void look_at(wh_viewer_t *view, const wh_protocol_server_t *server) {
    wh_pose_t base_from_grippers[WH_GRIPPERS];
    if (server->seq == 0) {
        wh_view_cell_rest(&view->cell);
        return;
    }
    for (size_t g = 0; g < server->state.gripper_count; ++g) {
        base_from_grippers[g] = server->state.grippers[g].base_from_gripper;
    }
    const wh_view_look_t look = {server->state.utime, base_from_grippers, server->state.wafers};
    wh_view_cell_move(&view->cell, &look);
}

void wh_viewer_tick(wh_viewer_t *view, const wh_protocol_server_t *server) {
    const int64_t now = wh_node_clock_us();
    const bool is_load_due = now - view->last_load_us >= WH_VIEW_LOAD_US;
    /* A slice is shown once; while nothing moves, only the second's beat goes on. */
    const bool is_new = server->identity.run != view->run || server->seq != view->seq;
    if (!is_load_due && (!is_new || now - view->last_draw_us < WH_VIEW_DRAW_US)) {
        return;
    }
    if (is_load_due) {
        view->last_load_us = now;
        ++view->loads;
        publish(view, WH_CHANNEL_VIEWER_LOAD, view->load, view->load_size);
    }
    view->last_draw_us = now;
    view->run = server->identity.run;
    view->seq = server->seq;
    ++view->draws;
    look_at(view, server);
    publish(view, WH_CHANNEL_VIEWER_DRAW, view->draw,
            waferhand_viewer_draw_encode(view->draw, 0, view->draw_room, &view->cell.draw));
}

void wh_viewer_close(wh_viewer_t *view) {
    free(view->load);
    free(view->draw);
    wh_view_cell_free(&view->cell);
    memset(view, 0, sizeof *view);
}
