#include "cell.h"

#include <stdlib.h>
#include <string.h>

#include "../bodies/shapes.h"
#include "../layout/arms.h"
#include "../layout/inks.h"
#include "../math/trig.h"
#include "../text/array.h"

/* The distance of a cover and a notch's mark from the wafer's surface, mm. */
#define COVER 0.25
#define MARK 0.5

/* A notch of 1 mm would be too small to see. The mark's width is this share of the wafer's radius, and its
 * length three times that. */
#define MARK_WIDTH 0.02

/* The share by which a held wafer's colour is mixed from its gripper's to the page's background. */
#define PALER 0.42F

/* ---------- colours * Those of the report's page, in light, but less transparent: there are no edges here */

static wh_view_colour_t colour_of_gripper(size_t gripper) {
    return wh_view_colour(wh_ink_series[gripper % WH_INK_SERIES].light, 1);
}

/* Blades and chucks have the colour of their gripper. Obstacles and shells are transparent. */
static wh_view_colour_t colour_of_part(const wh_part_t *part) {
    static const float opacities[WH_INKS] = {0.35F, 0.22F, 1, 1, 1, 1, 1};
    const wh_part_ink_t ink = wh_ink_of(part);
    if (ink == WH_INK_BLADE || ink == WH_INK_CHUCK) {
        return colour_of_gripper((size_t)part->owner);
    }
    return wh_view_colour(wh_ink_looks[ink].shown.light, opacities[ink]);
}

/* The colour of a held wafer: paler than its gripper's. */
static wh_view_colour_t colour_of_held(size_t gripper) {
    const wh_view_colour_t page = wh_view_colour(wh_ink_stage.light, 1);
    wh_view_colour_t colour = colour_of_gripper(gripper);
    for (size_t c = 0; c < 3; ++c) {
        colour.rgba[c] += PALER * (page.rgba[c] - colour.rgba[c]);
    }
    return colour;
}

/* ----------------------------------------------------------------------------------------------- bodies */

/* Adds a shape to the body that was added last. */
static void add_shape(wh_view_cell_t *cell, const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                      const wh_view_colour_t *colour) {
    wh_view_geometry_make(convex, body_from_shape, colour, cell->detail >= WH_VIEW_BOXES,
                          wh_view_bodies_add_shape(&cell->bodies));
}

/* ------------------------------------------------------------------------------------------------ parts */

/* Notes that the next shape of the last body is this part. */
static void note_shape(wh_view_cell_t *cell, size_t part) {
    cell->shown[part][0] = cell->bodies.load.num_links - 1;
    cell->shown[part][1] = cell->bodies.load.link[cell->bodies.load.num_links - 1].num_geom;
}

static void open_shown(wh_view_cell_t *cell) {
    const size_t count = cell->layout->world.part_count + cell->layout->wafer_count;
    cell->shown = wh_array_new(count, sizeof *cell->shown);
    for (size_t i = 0; i < count; ++i) {
        cell->shown[i][0] = WH_NONE;
    }
    cell->hit[0] = cell->hit[1] = WH_NONE;
}

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
        const wh_view_colour_t colour = colour_of_part(part);
        note_shape(cell, i);
        add_shape(cell, &part->convex, &pose, &colour);
    }
}

/* Body 0 is the obstacles; station s is body 1 + s. */
static void add_stations(wh_view_cell_t *cell) {
    for (size_t s = 0; s < cell->layout->station_count; ++s) {
        (void)wh_view_bodies_add(&cell->bodies, "stations", cell->layout->stations[s].name);
        add_parts(cell, 1U << WH_PART_FIXED | 1U << WH_PART_LEDGE, (int32_t)s,
                  &cell->layout->places[s].base_from_station);
    }
}

static void add_robots(wh_view_cell_t *cell) {
    cell->links = (size_t)cell->bodies.load.num_links;
    for (size_t i = 0; i < wh_layout_arms(cell->layout) * WH_ARM_BODIES; ++i) {
        char name[2 * WH_NAME_SIZE];
        wh_layout_name_body(cell->layout, i, "base", name, sizeof name);
        if (wh_layout_has_body(cell->layout, i)) {
            (void)wh_view_bodies_add(&cell->bodies, "robot", name);
            add_parts(cell, 1U << WH_PART_ARM, (int32_t)i, NULL);
        }
    }
}

static void add_grippers(wh_view_cell_t *cell) {
    cell->grippers = (size_t)cell->bodies.load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        (void)wh_view_bodies_add(&cell->bodies, "grippers", cell->layout->grippers[g].name);
        add_parts(cell, 1U << WH_PART_BLADE | 1U << WH_PART_CHUCK, (int32_t)g, NULL);
    }
}

static void add_doors(wh_view_cell_t *cell) {
    cell->doors = (size_t)cell->bodies.load.num_links;
    for (size_t d = 0; d < cell->layout->machine.door_count; ++d) {
        (void)wh_view_bodies_add(&cell->bodies, "doors", cell->layout->door_list[d].name);
        add_parts(cell, 1U << WH_PART_DOOR, (int32_t)d, NULL);
    }
}

/* ----------------------------------------------------------------------------------------------- wafers */

static void add_disc(wh_view_cell_t *cell, double larger, const wh_view_colour_t *colour) {
    wh_convex_t disc = wh_shapes_wafer(&cell->layout->shapes);
    disc.half.x += larger;
    disc.half.z += larger;
    add_shape(cell, &disc, &disc.body_from_shape, colour);
}

static void add_mark(wh_view_cell_t *cell) {
    const wh_convex_t disc = wh_shapes_wafer(&cell->layout->shapes);
    const wh_view_colour_t colour = wh_view_colour(wh_ink_edge.light, 1);
    const double width = MARK_WIDTH * disc.half.x;
    wh_convex_t mark = {.kind = WH_CONVEX_BOX, .body_from_shape = disc.body_from_shape};
    double sine, cosine;
    if (!(cell->layout->notch_depth > 0)) {
        return;
    }
    wh_sin_cos(cell->layout->notch, &sine, &cosine);
    const double from_middle = disc.half.x - 1.5 * width + MARK;
    mark.half = wh_vec3(1.5 * width, width / 2, disc.half.z + MARK);
    mark.body_from_shape.R = wh_mat3_turn_z(sine, cosine);
    mark.body_from_shape.r.x = from_middle * cosine;
    mark.body_from_shape.r.y = from_middle * sine;
    add_shape(cell, &mark, &mark.body_from_shape, &colour);
}

static void add_covers(wh_view_cell_t *cell) {
    cell->covers = (size_t)cell->bodies.load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        const wh_view_colour_t colour = colour_of_held(g);
        (void)wh_view_bodies_add(&cell->bodies, "held", cell->layout->grippers[g].name);
        add_disc(cell, COVER, &colour);
    }
}

static void add_wafers(wh_view_cell_t *cell) {
    const wh_view_colour_t colour = wh_view_colour(wh_ink_looks[WH_INK_WAFER].shown.light, 1);
    cell->wafers = (size_t)cell->bodies.load.num_links;
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        (void)wh_view_bodies_add(&cell->bodies, "wafers", cell->layout->wafers[w].name);
        note_shape(cell, cell->layout->world.part_count + w);
        add_disc(cell, 0, &colour);
        add_mark(cell);
    }
}

/* ----------------------------------------------------------------------------------------------- places */

static void place_robots(wh_view_cell_t *cell, const wh_pose_t base_from_grippers[]) {
    size_t link = cell->links;
    for (size_t i = 0; i < wh_layout_arms(cell->layout) * WH_ARM_BODIES; ++i) {
        if (wh_layout_has_body(cell->layout, i)) {
            wh_view_bodies_place(&cell->bodies, link++, &cell->robots.bodies[i]);
        }
    }
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        wh_view_bodies_place(&cell->bodies, cell->grippers + g, &base_from_grippers[g]);
    }
}

static void place_doors(wh_view_cell_t *cell, const wh_doors_t *doors, const wh_real_t axes[]) {
    wh_pose_t base_from_door[WH_DOORS];
    wh_layout_place_doors(cell->layout, doors, axes, base_from_door);
    for (size_t d = 0; d < cell->layout->machine.door_count; ++d) {
        wh_view_bodies_place(&cell->bodies, cell->doors + d, &base_from_door[d]);
    }
}

/* Wafers and, if some may be held, their covers. */
static void place_wafers(wh_view_cell_t *cell, const wh_wafer_t wafers[], bool may_be_held) {
    wh_pose_t away = wh_pose_identity();
    away.r.z = -WH_VIEW_AWAY;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        wh_view_bodies_place(&cell->bodies, cell->covers + g, &away);
    }
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        wh_view_bodies_place(&cell->bodies, cell->wafers + w, &wafers[w].base_from_wafer);
        const int32_t part = (int32_t)(cell->layout->world.part_count + w);
        const bool is_red = part == cell->hit[0] || part == cell->hit[1];
        if (may_be_held && wafers[w].holder != WH_NONE && !is_red) {
            wh_view_bodies_place(&cell->bodies, cell->covers + (size_t)wafers[w].holder,
                                 &wafers[w].base_from_wafer);
        }
    }
}

void wh_view_cell_move(wh_view_cell_t *cell, const wh_view_look_t *look) {
    cell->bodies.draw.timestamp = look->utime / 1000;
    wh_links_follow(&cell->robots, cell->layout, look->base_from_grippers, look->axes, WH_LINKS_SAME);
    place_robots(cell, look->base_from_grippers);
    place_doors(cell, look->door_places, look->axes);
    place_wafers(cell, look->wafers, true);
}

void wh_view_cell_rest(wh_view_cell_t *cell) {
    const wh_layout_t *layout = cell->layout;
    wh_real_t axes[WH_AXES] = {0};
    wh_pose_t base_from_grippers[WH_GRIPPERS];
    wh_machine_home(&layout->machine, axes);
    wh_links_at(&cell->robots, layout, axes);
    wh_machine_grippers(&layout->machine, axes, base_from_grippers);
    cell->bodies.draw.timestamp = 0;
    place_robots(cell, base_from_grippers);
    place_doors(cell, NULL, axes);
    place_wafers(cell, layout->start, false);
}

void wh_view_cell_open(wh_view_cell_t *cell, const wh_layout_t *layout, wh_view_detail_t detail) {
    memset(cell, 0, sizeof *cell);
    cell->layout = layout;
    cell->detail = detail;
    open_shown(cell);
    (void)wh_view_bodies_add(&cell->bodies, "obstacles", NULL);
    add_parts(cell, 1U << WH_PART_FIXED, WH_NONE, NULL);
    add_stations(cell);
    add_robots(cell);
    add_grippers(cell);
    add_doors(cell);
    add_covers(cell);
    add_wafers(cell);
    wh_view_bodies_open(&cell->bodies);
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_view_bodies_place(&cell->bodies, 1 + s, &layout->places[s].base_from_station);
    }
    wh_view_cell_rest(cell);
}

/* ------------------------------------------------------------------------------------------------- hits */

/* The colour of a part's shape; null if it is not shown. */
static float *colour_at(const wh_view_cell_t *cell, int32_t part) {
    const size_t count = cell->layout->world.part_count + cell->layout->wafer_count;
    if (part < 0 || (size_t)part >= count || cell->shown[part][0] == WH_NONE) {
        return NULL;
    }
    return cell->bodies.load.link[cell->shown[part][0]].geom[cell->shown[part][1]].color;
}

bool wh_view_cell_set_hit(wh_view_cell_t *cell, const int32_t parts[2]) {
    const wh_view_colour_t red = wh_view_colour(0xe5001f, 1);
    if (memcmp(cell->hit, parts, sizeof cell->hit) == 0) {
        return false;
    }
    for (size_t i = 2; i-- > 0;) { /* backwards, because both may be one shape */
        float *colour = colour_at(cell, cell->hit[i]);
        if (colour) {
            memcpy(colour, cell->plain[i], sizeof cell->plain[i]);
        }
    }
    memcpy(cell->hit, parts, sizeof cell->hit);
    for (size_t i = 0; i < 2; ++i) {
        float *colour = colour_at(cell, cell->hit[i]);
        if (colour) {
            memcpy(cell->plain[i], colour, sizeof cell->plain[i]);
            memcpy(colour, red.rgba, sizeof cell->plain[i]);
        }
    }
    return true;
}

void wh_view_cell_free(wh_view_cell_t *cell) {
    wh_view_bodies_free(&cell->bodies);
    free(cell->shown);
    memset(cell, 0, sizeof *cell);
}
