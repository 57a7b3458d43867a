#include "cell.h"

#include <string.h>

#include "../math/trig.h"
#include "cell_internal.h"

/* How far a cover, and then a notch's mark, stand out of the wafer, mm. */
#define COVER 0.25
#define MARK 0.5

/* A notch of 1 mm would not be seen: the mark is so wide, and three times as long, of the wafer's radius. */
#define MARK_WIDTH 0.02

static void add_parts(wh_view_cell_t *cell, uint32_t kinds, int32_t owner, const wh_pose_t *base_from_body) {
    const wh_world_config_t *world = &cell->layout->world;
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        const bool is_left_out = part->kind == WH_PART_LEDGE && cell->detail >= WH_VIEW_NO_LEDGES;
        if ((kinds >> (unsigned)part->kind & 1U) == 0 || part->owner != owner || is_left_out) {
            continue;
        }
        const wh_pose_t *at = &part->convex.body_from_shape;
        const wh_pose_t pose = base_from_body ? wh_pose_relative(base_from_body, at) : *at;
        const wh_view_colour_t colour = wh_view_colour_of_part(part);
        wh_view_add_shape(cell, &part->convex, &pose, &colour);
    }
}

static void add_obstacles(wh_view_cell_t *cell) {
    (void)wh_view_add_body(cell, "obstacles", NULL);
    add_parts(cell, 1U << WH_PART_FIXED, WH_NONE, NULL);
}

/* The indices of stations are behind those of the obstacles. */
static void add_stations(wh_view_cell_t *cell) {
    for (size_t s = 0; s < cell->layout->station_count; ++s) {
        (void)wh_view_add_body(cell, "stations", cell->layout->stations[s].name);
        add_parts(cell, 1U << WH_PART_FIXED | 1U << WH_PART_LEDGE, (int32_t)s,
                  &cell->layout->places[s].base_from_station);
    }
}

static void add_robot(wh_view_cell_t *cell) {
    static const char *const names[WH_ARM_BODIES] = {"base", "lift", "upper arm", "forearm", "hand"};
    cell->links = (size_t)cell->load.num_links;
    for (int32_t i = 0; i < WH_ARM_BODIES; ++i) {
        (void)wh_view_add_body(cell, "robot", names[i]);
        add_parts(cell, 1U << WH_PART_ARM, i, NULL);
    }
}

static void add_grippers(wh_view_cell_t *cell) {
    cell->grippers = (size_t)cell->load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        (void)wh_view_add_body(cell, "grippers", cell->layout->grippers[g].name);
        add_parts(cell, 1U << WH_PART_BLADE | 1U << WH_PART_CHUCK, (int32_t)g, NULL);
    }
}

/* --------------------------------------------------------------------------------------------------- wafers */

static void add_disc(wh_view_cell_t *cell, double larger, const wh_view_colour_t *colour) {
    wh_convex_t disc = wh_shapes_wafer(&cell->layout->shapes);
    disc.half.x += larger;
    disc.half.z += larger;
    wh_view_add_shape(cell, &disc, &disc.body_from_shape, colour);
}

static void add_mark(wh_view_cell_t *cell) {
    const wh_convex_t disc = wh_shapes_wafer(&cell->layout->shapes);
    const wh_view_colour_t colour = wh_view_colour_of_notch();
    const double width = MARK_WIDTH * disc.half.x;
    wh_convex_t mark = {.kind = WH_CONVEX_BOX, .body_from_shape = disc.body_from_shape};
    double sine, cosine;
    if (!(cell->layout->notch_depth > 0)) {
        return;
    }
    wh_sin_cos(cell->layout->notch, &sine, &cosine);
    const double from_middle = disc.half.x - 1.5 * width + MARK;
    mark.half = wh_vec3(1.5 * width, width / 2, disc.half.z + MARK);
    mark.body_from_shape.R = wh_mat3_identity();
    mark.body_from_shape.R.m[0][0] = mark.body_from_shape.R.m[1][1] = cosine;
    mark.body_from_shape.R.m[0][1] = -sine;
    mark.body_from_shape.R.m[1][0] = sine;
    mark.body_from_shape.r.x = from_middle * cosine;
    mark.body_from_shape.r.y = from_middle * sine;
    wh_view_add_shape(cell, &mark, &mark.body_from_shape, &colour);
}

static void add_covers(wh_view_cell_t *cell) {
    cell->covers = (size_t)cell->load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        const wh_view_colour_t colour = wh_view_colour_of_held(g);
        (void)wh_view_add_body(cell, "held", cell->layout->grippers[g].name);
        add_disc(cell, COVER, &colour);
    }
}

static void add_wafers(wh_view_cell_t *cell) {
    const wh_view_colour_t colour = wh_view_colour_of_wafer();
    cell->wafers = (size_t)cell->load.num_links;
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        (void)wh_view_add_body(cell, "wafers", cell->layout->wafers[w].name);
        add_disc(cell, 0, &colour);
        add_mark(cell);
    }
}

void wh_view_cell_open(wh_view_cell_t *cell, const wh_layout_t *layout, wh_view_detail_t detail) {
    memset(cell, 0, sizeof *cell);
    cell->layout = layout;
    cell->detail = detail;
    add_obstacles(cell);
    add_stations(cell);
    add_robot(cell);
    add_grippers(cell);
    add_covers(cell);
    add_wafers(cell);
    wh_view_draw_open(cell);
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_view_place(cell, 1 + s, &layout->places[s].base_from_station);
    }
    wh_view_cell_rest(cell);
}
