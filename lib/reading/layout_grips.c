/* `grip` of grippers, and what edge grips refuse. */
#include "../layout/grips.h"

#include <math.h>
#include <stdio.h>

#include "../layout/words.h"
#include "../math/trig.h"
#include "layout_internal.h"

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* Each default is moved within the limits of the fields before it. */
static void read_windows(wh_reader_t *reader, wh_edge_t *edge) {
    const double open = -(edge->clearance + 1);
    wh_reader_scalar_within(reader, "retracted", edge, edge->retracted < open ? edge->retracted : open, -50,
                            open);
    wh_reader_scalar_within(reader, "gripped_from", edge, edge->gripped_from,
                            larger(-5, edge->retracted + 0.001), 5);
    wh_reader_scalar_within(reader, "gripped_to", edge,
                            edge->gripped_from < edge->gripped_to ? edge->gripped_to : 5, edge->gripped_from,
                            5);
    edge->end = larger(edge->end, edge->gripped_to + 1);
    if (wh_reader_has(reader, "stroke")) {
        edge->end = edge->retracted + wh_reader_number(reader, "stroke", WH_REAL(NAN),
                                                       edge->gripped_to - edge->retracted + 0.01,
                                                       10 - edge->retracted);
    }
}

static void read_edge(wh_reader_t *reader, const wh_layout_t *layout, wh_edge_t *edge) {
    const double radius = layout->wafer_diameter / 2;
    const double most = radius / 10 < 10 ? radius / 10 : 10;
    *edge = wh_edge_default(radius);
    wh_reader_open_section(reader, "grip", wh_layout_edge_grip_fields);
    (void)wh_reader_choice(reader, "kind", WH_GRIP_EDGE, (const char *const[]){"edge", NULL});
    wh_reader_scalars(reader, edge);
    wh_reader_scalar_within(reader, "clearance", edge, edge->clearance < most ? edge->clearance : most, 0,
                            most);
    read_windows(reader, edge);
    wh_reader_leave(reader);
}

static void check_edge(wh_reader_t *reader, const wh_layout_t *layout, size_t g) {
    if (layout->wafer_diameter < 2 * 10 || layout->wafer_diameter > 2 * 300) {
        (void)wh_reader_push(reader, "grip");
        wh_reader_fail(reader, "grip", "\"vacuum\": an edge grip is for wafers from 20 to 600 mm");
    }
    if (layout->grippers[g].station != WH_NONE) {
        (void)wh_reader_push(reader, "grip");
        wh_reader_fail(reader, "grip", "\"vacuum\": an edge grip is on a robot");
    }
}

void wh_layout_read_grip(wh_reader_t *reader, wh_layout_t *layout, size_t g) {
    wh_grip_t *grip = &layout->grips[g];
    const int type = wh_reader_push(reader, "grip");
    const bool is_edge = type == LUA_TTABLE;
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "grip", "\"vacuum\", \"edge\", \"passive\" or { rest = , alpha = , ... }");
    }
    lua_pop(reader->L, 1);
    grip->kind = is_edge
                     ? WH_GRIP_EDGE
                     : (wh_grip_kind_t)wh_reader_choice(reader, "grip", WH_GRIP_VACUUM, wh_layout_grip_words);
    if (grip->kind == WH_GRIP_PASSIVE && layout->grippers[g].station != WH_NONE &&
        !wh_layout_is_pins(layout, g)) {
        wh_reader_refuse(reader, "grip", "passive",
                         "\"vacuum\": a chuck holds the wafer that it turns; passive are blades and pins");
    }
    grip->edge = wh_edge_default(layout->wafer_diameter / 2);
    if (is_edge) {
        read_edge(reader, layout, &grip->edge);
    }
    if (grip->kind == WH_GRIP_EDGE) {
        check_edge(reader, layout, g);
    }
}

/* --------------------------------------------------------------------------------- what edges they meet */

static void check_wafer(wh_reader_t *reader, const wh_layout_t *layout, const wh_edge_t *edge, size_t g,
                        size_t w) {
    const char *expected = wh_layout_edge_refuses(edge, layout->rims[w], &layout->edge_wafers[w]);
    if (expected) {
        char field[64];
        (void)snprintf(field, sizeof field, "grippers[%zu].grip", g + 1);
        wh_reader_refuse(reader, field, wh_layout_grip_name(WH_GRIP_EDGE), "%s; %s is not such a wafer",
                         expected, layout->wafers[w].name);
    }
}

void wh_layout_read_edge_wafers(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_layout_has_edge(layout)) {
        return;
    }
    wh_edge_wafer_t *wafers = wh_layout_memory(reader->L, layout->wafer_count, sizeof *wafers);
    layout->edge_wafers = wafers;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w] = wh_layout_edge_wafer(layout->rims[w]);
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            if (layout->grips[g].kind == WH_GRIP_EDGE) {
                check_wafer(reader, layout, &layout->grips[g].edge, g, w);
            }
        }
    }
}
