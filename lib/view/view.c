#include "view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* Encodes the bodies. */
static bool encode_load(wh_viewer_bytes_t *bytes, const waferhand_viewer_load *load) {
    bytes->load_size = waferhand_viewer_load_encode(bytes->load, 0, bytes->load_room, load);
    bytes->is_new = true;
    return bytes->load_size > 0;
}

static bool open_bytes(wh_viewer_bytes_t *bytes, const waferhand_viewer_load *load, int load_room,
                       const waferhand_viewer_draw *draw) {
    bytes->load_room = load_room;
    bytes->draw_room = waferhand_viewer_draw_encoded_size(draw);
    bytes->load = wh_array_new((size_t)bytes->load_room, 1);
    bytes->draw = wh_array_new((size_t)bytes->draw_room, 1);
    return encode_load(bytes, load);
}

/* Makes the cell's messages, with as much of the cell as they have room for. */
static bool fit(wh_viewer_t *view, const wh_layout_t *layout) {
    for (int detail = WH_VIEW_ALL; detail < WH_VIEW_DETAILS; ++detail) {
        wh_view_cell_open(&view->cell, layout, (wh_view_detail_t)detail);
        const int load_size = waferhand_viewer_load_encoded_size(&view->cell.bodies.load);
        if (load_size <= WH_VIEW_BYTES &&
            waferhand_viewer_draw_encoded_size(&view->cell.bodies.draw) <= WH_LINK_DATAGRAM) {
            return open_bytes(&view->cell_bytes, &view->cell.bodies.load, load_size, &view->cell.bodies.draw);
        }
        wh_view_cell_free(&view->cell);
    }
    return false;
}

wh_status_t wh_viewer_open(wh_viewer_t *view, wh_node_t *node, const wh_layout_t *layout) {
    memset(view, 0, sizeof *view);
    view->node = node;
    if (!fit(view, layout)) {
        wh_viewer_close(view);
        return WH_STATUS_BAD_CAPACITY;
    }
    wh_view_board_open(&view->board, layout);
    if (!open_bytes(&view->board_bytes, &view->board.bodies.load, wh_view_board_room(&view->board),
                    &view->board.bodies.draw)) {
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

/* ---------------------------------------------------------------------------------------------- looking */

/* Before the first slice grippers have no poses yet, so everything is shown at rest. */
static void look_at(wh_viewer_t *view, const wh_protocol_server_t *server) {
    wh_pose_t base_from_grippers[WH_GRIPPERS];
    if (server->seq == 0) {
        wh_view_cell_rest(&view->cell);
        return;
    }
    for (size_t g = 0; g < server->state.gripper_count; ++g) {
        base_from_grippers[g] = server->state.grippers[g].base_from_gripper;
    }
    const wh_view_look_t look = {
        server->state.utime, base_from_grippers, server->has_axes ? server->axes : NULL,
        server->state.physics ? &server->state.physics->doors : NULL, server->state.wafers};
    wh_view_cell_move(&view->cell, &look);
}

static void write_line(wh_viewer_t *view, wh_view_line_t line, const char *text) {
    if (wh_view_board_write(&view->board, line, text)) {
        (void)encode_load(&view->board_bytes, &view->board.bodies.load);
    }
}

static void show_hit(wh_viewer_t *view, const char *what, const int32_t parts[2]) {
    const char *first = wh_layout_part_name(view->cell.layout, parts[0]);
    const char *second = wh_layout_part_name(view->cell.layout, parts[1]);
    char text[WH_PART_NAME_SIZE + 16];
    (void)snprintf(text, sizeof text, "%s%s", what, first ? first : "");
    write_line(view, WH_VIEW_HIT, text);
    (void)snprintf(text, sizeof text, "%s%s", second ? "and " : "", second ? second : "");
    write_line(view, WH_VIEW_HIT_WITH, text);
    if (wh_view_cell_set_hit(&view->cell, parts)) {
        (void)encode_load(&view->cell_bytes, &view->cell.bodies.load);
    }
}

/* Parts that collided stay red until another run begins. */
static void look_for_hits(wh_viewer_t *view, const wh_protocol_server_t *server) {
    static const int32_t none[2] = {WH_NONE, WH_NONE};
    if (server->identity.run != view->hit_run) {
        view->hit_run = server->identity.run;
        show_hit(view, "", none);
    }
    for (size_t i = 0; i < server->state.event_count; ++i) {
        const wh_event_t *event = &server->state.events[i];
        if (event->kind == WH_EVENT_HIT || event->kind == WH_EVENT_UNDECIDED) {
            show_hit(view, event->kind == WH_EVENT_HIT ? "hit: " : "undecided: ", event->parts);
        }
    }
}

/* ---------------------------------------------------------------------------------------------- sending */

static void send_bodies(wh_viewer_t *view, wh_viewer_bytes_t *bytes, const char *channel) {
    bytes->is_new = false;
    publish(view, channel, bytes->load, bytes->load_size);
}

static void send_places(wh_viewer_t *view, const wh_viewer_bytes_t *bytes, const waferhand_viewer_draw *draw,
                        const char *channel) {
    publish(view, channel, bytes->draw, waferhand_viewer_draw_encode(bytes->draw, 0, bytes->draw_room, draw));
}

/* The board's places are sent only when a digit has changed. */
static void send(wh_viewer_t *view, bool all, int64_t utime) {
    if (all || view->cell_bytes.is_new) {
        ++view->loads;
        send_bodies(view, &view->cell_bytes, WH_CHANNEL_VIEWER_LOAD);
    }
    ++view->draws;
    send_places(view, &view->cell_bytes, &view->cell.bodies.draw, WH_CHANNEL_VIEWER_DRAW);
    const bool is_other_time = wh_view_board_set_time(&view->board, utime);
    if (all || view->board_bytes.is_new) {
        send_bodies(view, &view->board_bytes, WH_CHANNEL_BOARD_LOAD);
    } else if (!is_other_time) {
        return;
    }
    send_places(view, &view->board_bytes, &view->board.bodies.draw, WH_CHANNEL_BOARD_DRAW);
}

void wh_viewer_tick(wh_viewer_t *view, const wh_protocol_server_t *server) {
    const int64_t now = wh_node_clock_us();
    const bool is_load_due = now - view->last_load_us >= WH_VIEW_LOAD_US;
    look_for_hits(view, server);
    write_line(view, WH_VIEW_COMMAND, view->command ? view->command : "");
    /* A slice is shown once; while nothing moves, only the message of each second continues. */
    const bool is_new = server->identity.run != view->run || server->seq != view->seq ||
                        view->cell_bytes.is_new || view->board_bytes.is_new;
    if (!is_load_due && (!is_new || now - view->last_draw_us < WH_VIEW_DRAW_US)) {
        return;
    }
    view->last_load_us = is_load_due ? now : view->last_load_us;
    view->last_draw_us = now;
    view->run = server->identity.run;
    view->seq = server->seq;
    look_at(view, server);
    send(view, is_load_due, server->seq == 0 ? 0 : server->state.utime);
}

static void free_bytes(wh_viewer_bytes_t *bytes) {
    free(bytes->load);
    free(bytes->draw);
}

void wh_viewer_close(wh_viewer_t *view) {
    free_bytes(&view->cell_bytes);
    free_bytes(&view->board_bytes);
    wh_view_board_free(&view->board);
    wh_view_cell_free(&view->cell);
    memset(view, 0, sizeof *view);
}
