/* Default shapes of a cell. The figures are of the usual size, not a maker's data. */
#include "shapes.h"

#include <stdarg.h>
#include <stdio.h>

#include "../math/trig.h"

/* Heights of the arm's links below the end-effector's contact plane, mm: the links fold over each other. */
enum { HAND_BOTTOM = -60, FOREARM_TOP = -65, FOREARM_BOTTOM = -110, UPPER_TOP = -115, UPPER_BOTTOM = -160 };
enum { LIFT_TOP = -165, LINK_HALF_WIDTH = 35, HAND_RADIUS = 40, LIFT_RADIUS = 90, COLUMN_RADIUS = 120 };
/* A wrist farther aside than this, mm, makes the neck askew. */
#define NECK_STRAIGHT WH_REAL(1e-6)
enum { BODY_BOTTOM = -220 }; /* of a prealigner, below the chuck's upper side */

wh_real_t wh_shapes_link(wh_real_t farthest) {
    return farthest > 300 ? WH_REAL(0.53) * (farthest - 250) : 100;
}

wh_shapes_t wh_shapes_default(wh_real_t diameter, wh_real_t thickness, wh_real_t farthest, wh_real_t lowest) {
    const wh_real_t scale = diameter / 300;
    const wh_real_t radius = diameter / 2;
    const wh_real_t blade = diameter > 250 ? 3 : (diameter > 175 ? WH_REAL(2.0) : WH_REAL(1.5));
    const wh_shapes_t shapes = {
        .wafer_radius = radius,
        .wafer_thickness = thickness,
        .lowest = lowest,
        .arm = {.reach = 250, .link = wh_shapes_link(farthest)},
        .blade = {.thickness = blade,
                  .half_width = 75 * scale,
                  .finger = 25 * scale,
                  .length = 100 * scale,
                  .palm = 80 * scale},
        .ledge = {.inner = radius - 10 * scale,
                  .outer = radius + 2,
                  .thickness = WH_REAL(0.5),
                  .length = radius},
        .shell = {.room = 8, .wall = 5, .floor = 25, .roof = 20},
        .chuck = {.radius = 40 * scale, .height = 20, .body = 60 * scale},
    };
    return shapes;
}

/* ------------------------------------------------------------------------------------------------- adding */

void wh_shapes_add(wh_part_list_t *list, const wh_part_t *part, const char *name, ...) {
    va_list values;
    va_start(values, name);
    (void)vsnprintf(list->names[list->count], WH_PART_NAME_SIZE, name, values);
    va_end(values);
    list->parts[list->count++] = *part;
}

/* A box from one corner to the opposite one, in the body's frame. */
static wh_convex_t box(wh_real_t x0, wh_real_t x1, wh_real_t y0, wh_real_t y1, wh_real_t z0, wh_real_t z1) {
    wh_convex_t convex = {.kind = WH_CONVEX_BOX, .body_from_shape = wh_pose_identity()};
    convex.half = wh_vec3((x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2);
    convex.body_from_shape.r = wh_vec3((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2);
    return convex;
}

static wh_convex_t cylinder(wh_real_t radius, wh_real_t z0, wh_real_t z1) {
    wh_convex_t convex = {.kind = WH_CONVEX_CYLINDER, .body_from_shape = wh_pose_identity()};
    convex.half = wh_vec3(radius, 0, (z1 - z0) / 2);
    convex.body_from_shape.r.z = (z0 + z1) / 2;
    return convex;
}

wh_convex_t wh_shapes_wafer(const wh_shapes_t *shapes) {
    return cylinder(shapes->wafer_radius, 0, shapes->wafer_thickness);
}

/* -------------------------------------------------------------------------------------------------- robot */

static wh_convex_t link_box(wh_real_t length, wh_real_t bottom, wh_real_t top) {
    return box(-LINK_HALF_WIDTH, length + LINK_HALF_WIDTH, -LINK_HALF_WIDTH, LINK_HALF_WIDTH, bottom, top);
}

static void add_body(wh_part_list_t *list, const wh_shapes_arm_t *arm, wh_arm_body_t body, wh_convex_t convex,
                     const char *name) {
    const wh_part_t part = {
        .kind = WH_PART_ARM, .owner = (int32_t)(arm->first + (size_t)body), .convex = convex};
    if (body >= arm->own) {
        wh_shapes_add(list, &part, "%s%s%s", arm->robot, name, arm->number);
    }
}

/* The lift slides in the column. The column ends where the lift's head stops at its lowest. */
void wh_shapes_add_arm(wh_part_list_t *list, const wh_shapes_t *shapes, const wh_shapes_arm_t *arm) {
    const wh_real_t column = arm->lowest + LIFT_TOP - 10;
    if (column > 20) {
        add_body(list, arm, WH_ARM_BASE, cylinder(COLUMN_RADIUS, 0, column), "column");
        add_body(list, arm, WH_ARM_LIFT, cylinder(LIFT_RADIUS, LIFT_TOP - column, LIFT_TOP), "lift");
    }
    add_body(list, arm, WH_ARM_UPPER, link_box(arm->links[0], UPPER_BOTTOM, UPPER_TOP), "upper arm");
    add_body(list, arm, WH_ARM_FOREARM, link_box(arm->links[1], FOREARM_BOTTOM, FOREARM_TOP), "forearm");
    add_body(list, arm, WH_ARM_HAND, cylinder(HAND_RADIUS, HAND_BOTTOM, -shapes->blade.thickness), "hand");
}

static void add_blade(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper, const char *name) {
    const wh_blade_t *b = &shapes->blade;
    const wh_real_t inner = b->half_width - b->finger;
    const wh_real_t bottom = -b->thickness;
    wh_part_t part = {.kind = WH_PART_BLADE, .owner = gripper};
    part.convex = box(b->finger - b->palm, b->length, inner, b->half_width, bottom, 0);
    wh_shapes_add(list, &part, "%s finger left", name);
    part.convex = box(b->finger - b->palm, b->length, -b->half_width, -inner, bottom, 0);
    wh_shapes_add(list, &part, "%s finger right", name);
    part.convex = box(-b->palm, b->finger - b->palm, -b->half_width, b->half_width, bottom, 0);
    wh_shapes_add(list, &part, "%s palm", name);
}

/* True for a length that a part cannot have: the parts that it would join already meet. */
static bool is_too_short(wh_real_t half) {
    return half < WH_CONVEX_THINNEST / 2;
}

/* The wrist's axis meets the blade's plane here, in the gripper's frame; z is the wrist's height. */
static wh_vec3_t wrist_of(wh_real_t reach, const wh_pose_t *effector_from_gripper) {
    const wh_vec3_t wrist = {-reach, 0, 0};
    const wh_vec3_t from_gripper = wh_vec3_subtract(&wrist, &effector_from_gripper->r);
    return wh_mat3_transform_back(&effector_from_gripper->R, &from_gripper);
}

/* From the middle of the palm's end to the wrist, wherever on the end-effector the blade is. */
static void add_neck(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper, const wh_vec3_t *wrist,
                     const char *name) {
    const wh_blade_t *b = &shapes->blade;
    const wh_real_t dx = wrist->x + b->palm;
    const wh_real_t length = wh_real_sqrt(dx * dx + wrist->y * wrist->y);
    wh_part_t part = {.kind = WH_PART_BLADE, .owner = gripper};
    const bool is_straight = !(wh_real_abs(wrist->y) > NECK_STRAIGHT);
    if (is_straight && !(dx < 0)) {
        return; /* the palm is over the wrist */
    }
    if (is_straight) {
        part.convex = box(wrist->x, -b->palm, -b->half_width / 2, b->half_width / 2, -b->thickness, 0);
    } else {
        part.convex = box(0, length, -b->half_width / 2, b->half_width / 2, -b->thickness, 0);
        const wh_pose_t gripper_from_neck = {
            {{{dx / length, -wrist->y / length, 0}, {wrist->y / length, dx / length, 0}, {0, 0, 1}}},
            {-b->palm, 0, 0}};
        part.convex.body_from_shape = wh_pose_compose(&gripper_from_neck, &part.convex.body_from_shape);
    }
    if (is_too_short(part.convex.half.x)) {
        return;
    }
    wh_shapes_add(list, &part, "%s neck", name);
}

/* A blade above the hand, or below it, stands on a post at the wrist. */
static void add_post(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper, const wh_vec3_t *wrist,
                     const char *name) {
    const wh_real_t top = wrist->z - shapes->blade.thickness;
    const wh_real_t bottom = wrist->z + HAND_BOTTOM;
    wh_part_t part = {.kind = WH_PART_BLADE, .owner = gripper};
    if (top < -shapes->blade.thickness) {
        part.convex = cylinder(HAND_RADIUS, top, -shapes->blade.thickness);
    } else if (bottom > 0) {
        part.convex = cylinder(HAND_RADIUS, 0, bottom);
    } else {
        return;
    }
    if (is_too_short(part.convex.half.z)) {
        return;
    }
    part.convex.body_from_shape.r.x = wrist->x;
    part.convex.body_from_shape.r.y = wrist->y;
    wh_shapes_add(list, &part, "%s post", name);
}

void wh_shapes_add_gripper(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper, wh_real_t reach,
                           const wh_pose_t *effector_from_gripper, const char *name) {
    if (effector_from_gripper) {
        const wh_vec3_t wrist = wrist_of(reach, effector_from_gripper);
        add_blade(list, shapes, gripper, name);
        add_neck(list, shapes, gripper, &wrist, name);
        add_post(list, shapes, gripper, &wrist, name);
        return;
    }
    const wh_part_t part = {.kind = WH_PART_CHUCK,
                            .owner = gripper,
                            .convex = cylinder(shapes->chuck.radius, -shapes->chuck.height, 0)};
    wh_shapes_add(list, &part, "%s chuck", name);
}

void wh_shapes_add_edge(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper,
                        const wh_edge_t *edge, const char *name) {
    const wh_real_t height = shapes->wafer_thickness;
    const wh_real_t out = (wh_real_t)(edge->radius + edge->rest);
    for (int side = 1; side >= -1; side -= 2) {
        wh_part_t rest = {.kind = WH_PART_BLADE, .owner = gripper};
        rest.convex = cylinder((wh_real_t)edge->rest, 0, height);
        rest.convex.body_from_shape.r.x = out * wh_cos((wh_real_t)edge->alpha);
        rest.convex.body_from_shape.r.y = side * out * wh_sin((wh_real_t)edge->alpha);
        wh_shapes_add(list, &rest, "%s rest %d", name, side > 0 ? 1 : 2);
    }
    const wh_real_t wide = (wh_real_t)edge->plunger;
    const wh_real_t rear = (wh_real_t)(edge->retracted - edge->radius - 2 * edge->plunger);
    const wh_part_t plunger = {.kind = WH_PART_BLADE,
                               .owner = gripper,
                               .convex =
                                   box(rear, (wh_real_t)(edge->end - edge->radius), -wide, wide, 0, height)};
    wh_shapes_add(list, &plunger, "%s plunger", name);
}

static void add_corner(wh_blade_outline_t *outline, wh_real_t x, wh_real_t y) {
    const wh_real_t most = 1000;
    outline->x[outline->count] = x < -most ? -most : x > most ? most : x;
    outline->y[outline->count] = y < -most ? -most : y > most ? most : y;
    ++outline->count;
}

wh_blade_outline_t wh_shapes_outline(const wh_shapes_t *shapes, const wh_pose_t *effector_from_gripper) {
    const wh_blade_t *b = &shapes->blade;
    const wh_real_t inner = b->half_width - b->finger;
    const wh_vec3_t wrist = wrist_of(shapes->arm.reach, effector_from_gripper);
    const wh_real_t dx = wrist.x + b->palm;
    const wh_real_t length = wh_real_sqrt(dx * dx + wrist.y * wrist.y);
    wh_blade_outline_t outline = {.count = 0};
    add_corner(&outline, -b->palm, -b->half_width);
    add_corner(&outline, b->length, -b->half_width);
    add_corner(&outline, b->length, -inner);
    add_corner(&outline, b->finger - b->palm, -inner);
    add_corner(&outline, b->finger - b->palm, inner);
    add_corner(&outline, b->length, inner);
    add_corner(&outline, b->length, b->half_width);
    add_corner(&outline, -b->palm, b->half_width);
    if (dx < -NECK_STRAIGHT) {
        /* Half the neck's width, across it. */
        const wh_real_t x = b->half_width / 2 * wrist.y / length;
        const wh_real_t y = b->half_width / 2 * -dx / length;
        add_corner(&outline, -b->palm, b->half_width / 2);
        add_corner(&outline, wrist.x + x, wrist.y + y);
        add_corner(&outline, wrist.x - x, wrist.y - y);
        add_corner(&outline, -b->palm, -b->half_width / 2);
    }
    return outline;
}

/* ----------------------------------------------------------------------------------------------- stations */

size_t wh_shapes_count_station(wh_stand_t stand, int32_t slots) {
    if (stand == WH_STAND_NOTHING) {
        return 0;
    }
    const size_t shell = stand == WH_STAND_FOUP ? 6 : 0;
    return stand == WH_STAND_CHUCK ? 1 : 2 * (size_t)slots + shell;
}

static void place(wh_part_t *part, const wh_pose_t *base_from_frame, const wh_convex_t *convex) {
    part->convex = *convex;
    part->convex.body_from_shape = wh_pose_compose(base_from_frame, &convex->body_from_shape);
}

static void add_ledges(wh_part_list_t *list, const wh_ledge_t *ledge, const wh_station_t *station,
                       int32_t index, const char *name) {
    const wh_real_t half = ledge->length / 2;
    for (int32_t slot = 1; slot <= station->slots; ++slot) {
        const wh_pose_t base_from_slot = wh_station_slot(station, slot);
        wh_part_t part = {.kind = WH_PART_LEDGE, .owner = index, .slot = slot};
        wh_convex_t convex = box(-half, half, ledge->inner, ledge->outer, -ledge->thickness, 0);
        place(&part, &base_from_slot, &convex);
        wh_shapes_add(list, &part, "%s ledge %d left", name, (int)slot);
        convex = box(-half, half, -ledge->outer, -ledge->inner, -ledge->thickness, 0);
        place(&part, &base_from_slot, &convex);
        wh_shapes_add(list, &part, "%s ledge %d right", name, (int)slot);
    }
}

static void add_fixed(wh_part_list_t *list, const wh_station_t *station, int32_t index, wh_convex_t convex,
                      const char *name, const char *what) {
    wh_part_t part = {.kind = WH_PART_FIXED, .owner = index};
    place(&part, &station->base_from_station, &convex);
    wh_shapes_add(list, &part, "%s %s", name, what);
}

/* Walls, roof and floor, open towards the robot, and the load port's table down to the cell's floor. */
static void add_foup(wh_part_list_t *list, const wh_shapes_t *shapes, const wh_station_t *station,
                     int32_t index, const char *name) {
    const wh_shell_t *s = &shapes->shell;
    const wh_real_t front = -shapes->wafer_radius - s->room;
    const wh_real_t inside = shapes->wafer_radius + s->room;
    const wh_real_t out = inside + s->wall;
    const wh_real_t top = (wh_real_t)(station->slots - 1) * station->pitch + s->roof;
    const wh_real_t bottom = -s->floor;
    const wh_real_t ground = -station->base_from_station.r.z;
    add_fixed(list, station, index, box(front, out, inside, out, bottom, top), name, "wall left");
    add_fixed(list, station, index, box(front, out, -out, -inside, bottom, top), name, "wall right");
    add_fixed(list, station, index, box(inside, out, -inside, inside, bottom, top), name, "wall behind");
    add_fixed(list, station, index, box(front, out, -out, out, top, top + s->wall), name, "roof");
    add_fixed(list, station, index, box(front, out, -out, out, bottom - s->wall, bottom), name, "floor");
    if (ground < bottom - s->wall - 20) {
        add_fixed(list, station, index, box(front, out + 50, -out - 10, out + 10, ground, bottom - s->wall),
                  name, "load port");
    }
}

void wh_shapes_add_station(wh_part_list_t *list, const wh_shapes_t *shapes, const wh_station_t *station,
                           int32_t index, wh_stand_t stand, const char *name) {
    if (stand == WH_STAND_NOTHING) {
        return;
    }
    if (stand == WH_STAND_CHUCK) {
        add_fixed(list, station, index, cylinder(shapes->chuck.body, BODY_BOTTOM, -shapes->chuck.height - 1),
                  name, "body");
        return;
    }
    add_ledges(list, &shapes->ledge, station, index, name);
    if (stand == WH_STAND_FOUP) {
        add_foup(list, shapes, station, index, name);
    }
}
