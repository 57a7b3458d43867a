#include "members.h"

#include <string.h>

#include "messages.h"

/* ---------------------------------------------------------------------------------------------- the rows */

#define SAME(of, a, message, b)                                                                              \
    (offsetof(of, a) + 0 * sizeof(char[sizeof(((of *)0)->a) == sizeof(((message *)0)->b) ? 1 : -1]))
#define ROW(kind, count, of, a, message, b)                                                                  \
    { kind, count, SAME(of, a, message, b), offsetof(message, b) }
#define NUMBER(of, a, message, b) ROW(WH_MEMBER_NUMBER, 1, of, a, message, b)
#define NUMBERS(count, of, a, message, b) ROW(WH_MEMBER_NUMBER, count, of, a, message, b)
#define WHOLE(of, a, message, b) ROW(WH_MEMBER_WHOLE, 1, of, a, message, b)
#define LONG(of, a, message, b) ROW(WH_MEMBER_LONG, 1, of, a, message, b)
#define SWITCH(of, a, message, b) ROW(WH_MEMBER_SWITCH, 1, of, a, message, b)
#define CHOICE(of, a, message, b)                                                                            \
    { WH_MEMBER_CHOICE, 1, offsetof(of, a), offsetof(message, b) }
#define END                                                                                                  \
    { WH_MEMBER_NUMBER, 0, 0, 0 }

#define CELL(kind, a, b) kind(wh_layout_t, a, waferhand_cell, b)
const wh_member_t wh_cell_members[] = {CELL(LONG, slice_us, slice_us),
                                       CELL(NUMBER, grasp.tolerance.projz, eps_projz),
                                       CELL(NUMBER, grasp.tolerance.projxy, eps_projxy),
                                       CELL(NUMBER, grasp.tolerance.planar, eps_planar),
                                       CELL(NUMBER, grasp.near_projz, near_projz),
                                       CELL(NUMBER, grasp.near_projxy, near_projxy),
                                       CELL(CHOICE, grasp.check, check),
                                       CELL(SWITCH, grasp.seat, seat),
                                       CELL(SWITCH, cell.settle, settle),
                                       CELL(NUMBER, cell.off_centre, off_centre),
                                       CELL(NUMBER, cell.askew, askew),
                                       CELL(NUMBER, cell.drop, drop),
                                       CELL(NUMBER, cell.thickness, thickness),
                                       CELL(NUMBER, physics.vacuum.build, vacuum_build),
                                       CELL(NUMBER, physics.vacuum.vent, vacuum_vent),
                                       CELL(NUMBER, physics.vacuum.idle, vacuum_idle),
                                       CELL(NUMBER, physics.vacuum.on, vacuum_sensor_on),
                                       CELL(NUMBER, physics.vacuum.off, vacuum_sensor_off),
                                       CELL(NUMBER, physics.vacuum.release, vacuum_release),
                                       CELL(NUMBER, physics.pads.friction, pads_friction),
                                       CELL(NUMBER, physics.pads.force, pads_force),
                                       CELL(NUMBER, physics.pads.mass, pads_mass),
                                       CELL(NUMBER, physics.pads.gravity, pads_gravity),
                                       END};

#define SENSOR(kind, a, b) kind(wh_scanner_t, a, waferhand_edge_sensor, b)
const wh_member_t wh_sensor_members[] = {SENSOR(WHOLE, gripper, gripper),
                                         SENSOR(LONG, seed, seed),
                                         SENSOR(NUMBER, sensor.direction, direction),
                                         SENSOR(NUMBER, sensor.middle, middle),
                                         SENSOR(NUMBER, sensor.length, length),
                                         SENSOR(NUMBER, sensor.pixel, pixel),
                                         SENSOR(WHOLE, sensor.samples, samples),
                                         SENSOR(WHOLE, sensor.encoder, encoder),
                                         SENSOR(NUMBER, sensor.noise, noise),
                                         SENSOR(NUMBER, sensor.tilt, tilt),
                                         SENSOR(NUMBER, sensor.error.offset, offset),
                                         SENSOR(NUMBER, sensor.error.zero, zero),
                                         SENSOR(NUMBER, sensor.error.gain, gain),
                                         SENSOR(NUMBER, sensor.error.latency, latency),
                                         SENSOR(WHOLE, sensor.hidden_count, hidden_count),
                                         END};

#define RIM(kind, a, b) kind(wh_rim_t, a, waferhand_rim, b)
const wh_member_t wh_rim_members[] = {RIM(NUMBER, radius, radius),
                                      RIM(NUMBER, notch.direction, notch_direction),
                                      RIM(NUMBER, notch.depth, notch_depth),
                                      RIM(NUMBER, notch.opening, notch_opening),
                                      RIM(NUMBER, notch.bottom, notch_bottom),
                                      RIM(NUMBER, notch.corner, notch_corner),
                                      RIM(NUMBER, flats[0].direction, flat_direction[0]),
                                      RIM(NUMBER, flats[0].length, flat_length[0]),
                                      RIM(NUMBER, flats[1].direction, flat_direction[1]),
                                      RIM(NUMBER, flats[1].length, flat_length[1]),
                                      RIM(NUMBER, bow, bow),
                                      RIM(NUMBER, saddle, saddle),
                                      RIM(NUMBER, saddle_direction, saddle_direction),
                                      RIM(NUMBER, transmission, transmission),
                                      RIM(WHOLE, chip_count, chip_count),
                                      END};

#define EDGE(a, b) NUMBER(wh_edge_t, a, waferhand_edge_grip, b)
const wh_member_t wh_edge_members[] = {EDGE(radius, radius),
                                       EDGE(rest, rest),
                                       EDGE(plunger, plunger),
                                       EDGE(alpha, alpha),
                                       EDGE(clearance, clearance),
                                       EDGE(retracted, retracted),
                                       EDGE(gripped_from, gripped_from),
                                       EDGE(gripped_to, gripped_to),
                                       EDGE(end, end),
                                       EDGE(speed, speed),
                                       END};

#define BEAM(kind, a, b) kind(wh_door_beam_t, a, waferhand_door_beam, b)
const wh_member_t wh_light_members[] = {BEAM(LONG, seed, seed),
                                        BEAM(WHOLE, stuck, stuck),
                                        BEAM(NUMBER, delay_on, delay_on),
                                        BEAM(NUMBER, delay_off, delay_off),
                                        BEAM(NUMBER, jitter, jitter),
                                        BEAM(NUMBER, beam.x, point[0]),
                                        BEAM(NUMBER, beam.y, point[1]),
                                        BEAM(NUMBER, beam.z, point[2]),
                                        BEAM(NUMBER, beam.ex, direction[0]),
                                        BEAM(NUMBER, beam.ey, direction[1]),
                                        BEAM(NUMBER, beam.ez, direction[2]),
                                        BEAM(NUMBER, beam.low, low),
                                        BEAM(NUMBER, beam.high, high),
                                        END};

#define TOUCH(a, b) NUMBERS(3, wh_door_beam_t, touch.a, waferhand_door_beam, b)
const wh_member_t wh_touch_members[] = {BEAM(LONG, seed, seed),
                                        BEAM(WHOLE, stuck, stuck),
                                        BEAM(WHOLE, gripper, gripper),
                                        BEAM(NUMBER, noise, noise),
                                        BEAM(NUMBER, touch.radius, ball_radius),
                                        BEAM(NUMBER, touch.along, reach[0]),
                                        BEAM(NUMBER, touch.aside, reach[1]),
                                        TOUCH(middle, point),
                                        TOUCH(normal, direction),
                                        TOUCH(edge, edge),
                                        TOUCH(ball, ball),
                                        END};

#define DOOR(kind, a, b) kind(wh_door_t, a, waferhand_door, b)
const wh_member_t wh_door_members[] = {DOOR(NUMBER, way.x, way[0]),
                                       DOOR(NUMBER, way.y, way[1]),
                                       DOOR(NUMBER, way.z, way[2]),
                                       DOOR(NUMBER, travel, travel),
                                       DOOR(SWITCH, is_open, open),
                                       DOOR(NUMBER, limits.speed, speed),
                                       DOOR(NUMBER, limits.acceleration, acceleration),
                                       DOOR(NUMBER, limits.jerk, jerk),
                                       END};

/* ------------------------------------------------------------------------------------------------ copying */

static size_t size_of(wh_member_kind_t kind) {
    return kind == WH_MEMBER_WHOLE ? sizeof(int32_t) : sizeof(int64_t);
}

void wh_members_put(const wh_member_t members[], const void *ours, void *theirs) {
    for (const wh_member_t *member = members; member->count > 0; ++member) {
        const void *from = (const char *)ours + member->ours;
        void *to = (char *)theirs + member->theirs;
        if (member->kind == WH_MEMBER_SWITCH) {
            *(int8_t *)to = *(const bool *)from ? 1 : 0;
        } else if (member->kind == WH_MEMBER_CHOICE) {
            *(int8_t *)to = *(const int32_t *)from != 0 ? 1 : 0;
        } else {
            memcpy(to, from, member->count * size_of(member->kind));
        }
    }
}

void wh_members_take(const wh_member_t members[], const void *theirs, void *ours) {
    for (const wh_member_t *member = members; member->count > 0; ++member) {
        const void *from = (const char *)theirs + member->theirs;
        void *to = (char *)ours + member->ours;
        if (member->kind == WH_MEMBER_SWITCH) {
            *(bool *)to = *(const int8_t *)from != 0;
        } else if (member->kind == WH_MEMBER_CHOICE) {
            *(int32_t *)to = *(const int8_t *)from != 0 ? 1 : 0;
        } else {
            memcpy(to, from, member->count * size_of(member->kind));
        }
    }
}
