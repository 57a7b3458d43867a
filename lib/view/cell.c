#include "cell.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/collision.h"
#include "../layout/inks.h"
#include "../math/trig.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "geometry.h"

/* How far a cover and a notch's mark stand out of the wafer, mm. */
#define COVER 0.25
#define MARK 0.5

/* A notch of 1 mm would not be seen. The mark is this share of the wafer's radius wide, and three times as
 * long. */
#define MARK_WIDTH 0.02

/* Room for a written name: each byte becomes three at most. */
#define WRITTEN_SIZE (3 * WH_NAME_SIZE)

/* How far a held wafer's colour goes from its gripper's to the page's behind it. */
#define PALER 0.42F

/* ---------- colours * Those of the report's page, in light, but less transparent: there are no edges here */

static wh_view_colour_t colour_of(uint32_t hex, float opacity) {
    const wh_view_colour_t colour = {{(float)(hex >> 16 & 0xffU) / 255, (float)(hex >> 8 & 0xffU) / 255,
                                      (float)(hex & 0xffU) / 255, opacity}};
    return colour;
}

static wh_view_colour_t colour_of_gripper(size_t gripper) {
    return colour_of(wh_ink_series[gripper % WH_INK_SERIES].light, 1);
}

/* Blades and chucks have their gripper's colour. Obstacles and shells are transparent. */
static wh_view_colour_t colour_of_part(const wh_part_t *part) {
    static const float opacities[WH_INKS] = {0.35F, 0.22F, 1, 1, 1, 1, 1};
    const wh_part_ink_t ink = wh_ink_of(part);
    if (ink == WH_INK_BLADE || ink == WH_INK_CHUCK) {
        return colour_of_gripper((size_t)part->owner);
    }
    return colour_of(wh_ink_looks[ink].shown.light, opacities[ink]);
}

/* The colour of a held wafer: paler than its gripper's. */
static wh_view_colour_t colour_of_held(size_t gripper) {
    const wh_view_colour_t page = colour_of(wh_ink_stage.light, 1);
    wh_view_colour_t colour = colour_of_gripper(gripper);
    for (size_t c = 0; c < 3; ++c) {
        colour.rgba[c] += PALER * (page.rgba[c] - colour.rgba[c]);
    }
    return colour;
}

/* ----------------------------------------------------------------------------------------------- bodies */

/* The length of the character at `text` if it may stay as it is; 0 if the viewer would take it for part of a
 * path, or could not read it. */
static size_t plain_bytes(const char *text) {
    const unsigned char first = (unsigned char)*text;
    if (first < ' ' || first == 0x7f || first == '/' || first == ':' || first == '%') {
        return 0;
    }
    return wh_utf8_bytes(text);
}

/* Writes other characters as %2F and the like. '%' is one of them, so two names never become the same. */
static void write_name(const char *name, char *written) {
    static const char digits[] = "0123456789ABCDEF";
    while (*name != '\0') {
        const size_t plain = plain_bytes(name);
        const char coded[3] = {'%', digits[(unsigned char)*name >> 4U], digits[(unsigned char)*name & 15U]};
        const size_t size = plain > 0 ? plain : sizeof coded;
        memcpy(written, plain > 0 ? name : coded, size);
        written += size;
        name += plain > 0 ? plain : 1;
    }
    *written = '\0';
}

static char *path_of(const char *folder, const char *name) {
    char written[WRITTEN_SIZE] = "";
    if (name) {
        write_name(name, written);
    }
    char *path = NULL;
    if (asprintf(&path, "%s%s%s", folder, name ? "::" : "", written) < 0) {
        wh_memory_out();
    }
    return path;
}

/* Adds a body without shapes, at base, and returns its index. With a null `name` it has the folder's. */
static size_t add_body(wh_view_cell_t *cell, const char *folder, const char *name) {
    const waferhand_viewer_link body = {.name = path_of(folder, name)};
    cell->load.link =
        wh_array_grow(cell->load.link, (size_t)cell->load.num_links, &cell->capacity, sizeof body);
    cell->load.link[cell->load.num_links] = body;
    return (size_t)cell->load.num_links++;
}

/* Adds a shape to the body that was added last. */
static void add_shape(wh_view_cell_t *cell, const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                      const wh_view_colour_t *colour) {
    waferhand_viewer_link *body = &cell->load.link[cell->load.num_links - 1];
    /* The message's type has no place for a capacity: the array counts as full. */
    size_t capacity = (size_t)body->num_geom;
    body->geom = wh_array_grow(body->geom, capacity, &capacity, sizeof *body->geom);
    wh_view_geometry_make(convex, body_from_shape, colour, cell->detail >= WH_VIEW_BOXES,
                          &body->geom[body->num_geom++]);
}

/* ------------------------------------------------------------------------------------------------ parts */

/* Notes that the next shape of the last body is this part. */
static void note_shape(wh_view_cell_t *cell, size_t part) {
    cell->shown[part][0] = cell->load.num_links - 1;
    cell->shown[part][1] = cell->load.link[cell->load.num_links - 1].num_geom;
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

static void add_obstacles(wh_view_cell_t *cell) {
    (void)add_body(cell, "obstacles", NULL);
    add_parts(cell, 1U << WH_PART_FIXED, WH_NONE, NULL);
}

/* Body 0 is the obstacles; station s is body 1 + s. */
static void add_stations(wh_view_cell_t *cell) {
    for (size_t s = 0; s < cell->layout->station_count; ++s) {
        (void)add_body(cell, "stations", cell->layout->stations[s].name);
        add_parts(cell, 1U << WH_PART_FIXED | 1U << WH_PART_LEDGE, (int32_t)s,
                  &cell->layout->places[s].base_from_station);
    }
}

static void add_robot(wh_view_cell_t *cell) {
    static const char *const names[WH_ARM_BODIES] = {"base", "lift", "upper arm", "forearm", "hand"};
    cell->links = (size_t)cell->load.num_links;
    for (int32_t i = 0; i < WH_ARM_BODIES; ++i) {
        (void)add_body(cell, "robot", names[i]);
        add_parts(cell, 1U << WH_PART_ARM, i, NULL);
    }
}

static void add_grippers(wh_view_cell_t *cell) {
    cell->grippers = (size_t)cell->load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        (void)add_body(cell, "grippers", cell->layout->grippers[g].name);
        add_parts(cell, 1U << WH_PART_BLADE | 1U << WH_PART_CHUCK, (int32_t)g, NULL);
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
    const wh_view_colour_t colour = colour_of(wh_ink_edge.light, 1);
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
    cell->covers = (size_t)cell->load.num_links;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        const wh_view_colour_t colour = colour_of_held(g);
        (void)add_body(cell, "held", cell->layout->grippers[g].name);
        add_disc(cell, COVER, &colour);
    }
}

static void add_wafers(wh_view_cell_t *cell) {
    const wh_view_colour_t colour = colour_of(wh_ink_looks[WH_INK_WAFER].shown.light, 1);
    cell->wafers = (size_t)cell->load.num_links;
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        (void)add_body(cell, "wafers", cell->layout->wafers[w].name);
        note_shape(cell, cell->layout->world.part_count + w);
        add_disc(cell, 0, &colour);
        add_mark(cell);
    }
}

/* ----------------------------------------------------------------------------------------------- places */

static void place(wh_view_cell_t *cell, size_t body, const wh_pose_t *base_from_body) {
    wh_view_put_pose(base_from_body, cell->draw.position[body], cell->draw.quaternion[body]);
}

/* Makes `draw` of the bodies, once all are there. */
static void open_draw(wh_view_cell_t *cell) {
    const size_t count = (size_t)cell->load.num_links;
    const wh_pose_t here = wh_pose_identity();
    waferhand_viewer_draw *draw = &cell->draw;
    draw->num_links = cell->load.num_links;
    draw->link_name = wh_array_new(count, sizeof *draw->link_name);
    draw->robot_num = wh_array_new(count, sizeof *draw->robot_num);
    draw->position = wh_array_new(count, sizeof *draw->position);
    draw->quaternion = wh_array_new(count, sizeof *draw->quaternion);
    cell->places = wh_array_new(count, sizeof *cell->places);
    for (size_t i = 0; i < count; ++i) {
        draw->link_name[i] = cell->load.link[i].name;
        draw->position[i] = cell->places[i];
        draw->quaternion[i] = cell->places[i] + 3;
        place(cell, i, &here);
    }
}

/* A gripper on the robot tells where the arm is; without one the arm stays at home. */
static void place_robot(wh_view_cell_t *cell, const wh_pose_t base_from_grippers[]) {
    const wh_layout_t *layout = cell->layout;
    wh_pose_t bodies[WH_ARM_BODIES];
    (void)wh_collision_effector(&layout->machine, base_from_grippers, &cell->base_from_effector);
    wh_arm_place(&layout->shapes.arm, &cell->base_from_effector, bodies);
    for (size_t i = 0; i < WH_ARM_BODIES; ++i) {
        place(cell, cell->links + i, &bodies[i]);
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        place(cell, cell->grippers + g, &base_from_grippers[g]);
    }
}

/* Wafers and, where some may be held, their covers. */
static void place_wafers(wh_view_cell_t *cell, const wh_wafer_t wafers[], bool may_be_held) {
    wh_pose_t away = wh_pose_identity();
    away.r.z = -WH_VIEW_AWAY;
    for (size_t g = 0; g < cell->layout->machine.gripper_count; ++g) {
        place(cell, cell->covers + g, &away);
    }
    for (size_t w = 0; w < cell->layout->wafer_count; ++w) {
        place(cell, cell->wafers + w, &wafers[w].base_from_wafer);
        const int32_t part = (int32_t)(cell->layout->world.part_count + w);
        const bool is_red = part == cell->hit[0] || part == cell->hit[1];
        if (may_be_held && wafers[w].holder != WH_NONE && !is_red) {
            place(cell, cell->covers + (size_t)wafers[w].holder, &wafers[w].base_from_wafer);
        }
    }
}

void wh_view_cell_move(wh_view_cell_t *cell, const wh_view_look_t *look) {
    cell->draw.timestamp = look->utime / 1000;
    place_robot(cell, look->base_from_grippers);
    place_wafers(cell, look->wafers, true);
}

void wh_view_cell_rest(wh_view_cell_t *cell) {
    const wh_layout_t *layout = cell->layout;
    wh_real_t axes[WH_AXES] = {0};
    wh_pose_t base_from_grippers[WH_GRIPPERS];
    memcpy(axes, layout->machine.robot.home, sizeof layout->machine.robot.home);
    wh_robot_forward(axes, &cell->base_from_effector);
    wh_machine_grippers(&layout->machine, axes, base_from_grippers);
    cell->draw.timestamp = 0;
    place_robot(cell, base_from_grippers);
    place_wafers(cell, layout->start, false);
}

void wh_view_cell_open(wh_view_cell_t *cell, const wh_layout_t *layout, wh_view_detail_t detail) {
    memset(cell, 0, sizeof *cell);
    cell->layout = layout;
    cell->detail = detail;
    open_shown(cell);
    add_obstacles(cell);
    add_stations(cell);
    add_robot(cell);
    add_grippers(cell);
    add_covers(cell);
    add_wafers(cell);
    open_draw(cell);
    for (size_t s = 0; s < layout->station_count; ++s) {
        place(cell, 1 + s, &layout->places[s].base_from_station);
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
    return cell->load.link[cell->shown[part][0]].geom[cell->shown[part][1]].color;
}

bool wh_view_cell_set_hit(wh_view_cell_t *cell, const int32_t parts[2]) {
    const wh_view_colour_t red = colour_of(0xe5001f, 1);
    if (memcmp(cell->hit, parts, sizeof cell->hit) == 0) {
        return false;
    }
    for (size_t i = 2; i-- > 0;) { /* backwards: both may be the same shape */
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

static void free_body(waferhand_viewer_link *body) {
    for (int32_t i = 0; i < body->num_geom; ++i) {
        wh_view_geometry_free(&body->geom[i]);
    }
    free(body->geom);
    free(body->name);
}

void wh_view_cell_free(wh_view_cell_t *cell) {
    for (int32_t i = 0; i < cell->load.num_links; ++i) {
        free_body(&cell->load.link[i]);
    }
    free(cell->load.link);
    free(cell->draw.link_name);
    free(cell->draw.robot_num);
    free(cell->draw.position);
    free(cell->draw.quaternion);
    free(cell->places);
    free(cell->shown);
    memset(cell, 0, sizeof *cell);
}
