/* The fields of a layout about vacuum, holding and faults. */
#include <math.h>

#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../layout/words.h"
#include "../math/trig.h"
#include "layout_internal.h"

/* ------------------------------------------------------------------------------------------------- vacuum */

/* The longest debounce, ms. */
#define MOST_DEBOUNCE_MS 60000.0

static wh_vacuum_config_t model_of(int choice) {
    return choice == 0 ? wh_vacuum_ideal() : wh_vacuum_delayed();
}

/* Each default is moved within the limits of the fields before it, so that no value is changed later. */
static void read_levels(wh_reader_t *reader, wh_vacuum_config_t *vacuum) {
    const wh_real_t off = vacuum->off < vacuum->on ? vacuum->off : vacuum->on;
    wh_reader_scalar_within(reader, "sensor_off", vacuum, off, 0.01, vacuum->on);
    const wh_real_t idle = vacuum->idle < vacuum->off ? vacuum->idle : 0;
    wh_reader_scalar_within(reader, "idle", vacuum, idle, 0, vacuum->off - WH_REAL(1e-3));
}

/* Whole slices, the last one begun: the switch must stand for at least the given time. */
static int32_t read_debounce(wh_reader_t *reader, int64_t slice_us, double *given_ms) {
    const double slice_ms = (double)slice_us / 1000;
    const double most = fmin(MOST_DEBOUNCE_MS, WH_VACUUM_DEBOUNCE * slice_ms);
    *given_ms = wh_reader_number(reader, "debounce", 0, 0, most);
    return (int32_t)ceil(*given_ms / slice_ms - 1e-9);
}

static void read_vacuum_table(wh_reader_t *reader, wh_layout_t *layout, wh_vacuum_config_t *vacuum) {
    (void)wh_reader_open(reader, "vacuum", wh_layout_vacuum_fields);
    *vacuum = model_of((int)wh_reader_apart(reader, "model"));
    wh_reader_scalars(reader, vacuum);
    read_levels(reader, vacuum);
    vacuum->debounce = read_debounce(reader, layout->slice_us, &layout->debounce_given);
    wh_reader_leave(reader);
}

static void read_vacuum(wh_reader_t *reader, wh_layout_t *layout, wh_vacuum_config_t *vacuum) {
    const int type = wh_reader_push(reader, "vacuum");
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "vacuum", "\"ideal\", \"delayed\" or { model = , build = , vent = , ... }");
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        read_vacuum_table(reader, layout, vacuum);
    } else {
        *vacuum = model_of(wh_reader_choice(reader, "vacuum", 0, wh_layout_vacuum_words));
    }
}

static void read_pads(wh_reader_t *reader, const wh_layout_t *layout, wh_pads_t *pads) {
    const wh_real_t mass = wh_wafer_mass(layout->wafer_diameter, layout->wafer_thickness);
    if (!wh_reader_open(reader, "pads", wh_layout_pads_fields)) {
        return;
    }
    wh_reader_scalars(reader, pads);
    wh_reader_scalar_from(reader, "mass", pads, mass);
    wh_reader_leave(reader);
}

void wh_layout_read_physics(wh_reader_t *reader, wh_layout_t *layout) {
    layout->physics = wh_physics_default();
    layout->physics.slice_s = (wh_real_t)layout->slice_us / 1e6;
    read_vacuum(reader, layout, &layout->physics.vacuum);
    read_pads(reader, layout, &layout->physics.pads);
}

/* ------------------------------------------------------------------------------------------------- faults */

static wh_fault_kind_t read_kind(wh_reader_t *reader) {
    const char *names[WH_FAULT_KINDS] = {NULL};
    size_t count = 0;
    for (int i = 0; i < WH_FAULT_KINDS; ++i) {
        if (i != WH_FAULT_WAFER_PLACED) {
            names[count++] = wh_fault_name((wh_fault_kind_t)i);
        }
    }
    const int chosen = wh_reader_choice(reader, "kind", WH_NONE, names);
    const int kind = chosen >= WH_FAULT_WAFER_PLACED ? chosen + 1 : chosen;
    if (kind == WH_NONE) {
        wh_reader_refuse(reader, "kind", NULL, "the kind of a fault, such as \"%s\"", names[0]);
    }
    return (wh_fault_kind_t)kind;
}

static int32_t read_wafer(wh_reader_t *reader, const wh_layout_t *layout, const char *field) {
    return wh_layout_read_name(reader, layout, field, NULL, wh_layout_find_wafer,
                               "the name of a wafer of this layout");
}

static int32_t read_onto(wh_reader_t *reader, const wh_layout_t *layout, int32_t wafer) {
    const int32_t onto = read_wafer(reader, layout, "onto");
    if (onto == wafer) {
        wh_reader_refuse(reader, "onto", layout->wafers[onto].name,
                         "another wafer than the one that is put there");
    }
    return onto;
}

/* The station in whose slots the wafer lies: that of the layout, unless it lies in another one's. */
static int32_t station_of(const wh_layout_t *layout, int32_t wafer, const wh_pose_t *base_from_wafer) {
    wh_place_t place;
    const bool found = wh_cell_locate(&layout->cell, base_from_wafer, &place);
    return found ? place.station : layout->wafers[wafer].station;
}

/* Converts a tilt from the slot's frame to the wafer's, which may be turned in its slot. A wafer that is not
 * turned keeps the tilt's bits. */
static wh_pose_t in_wafer(const wh_pose_t *tilt, const wh_mat3_t *base_from_slot,
                          const wh_mat3_t *base_from_wafer) {
    const wh_mat3_t turn = wh_mat3_multiply_back(base_from_slot, base_from_wafer);
    wh_pose_t pose = *tilt;
    if (!(turn.m[0][0] > 1 - WH_REAL(1e-12) && turn.m[1][1] > 1 - WH_REAL(1e-12))) {
        const wh_mat3_t turned = wh_mat3_multiply(&tilt->R, &turn);
        pose.R = wh_mat3_multiply_back(&turn, &turned);
        pose.r = wh_mat3_transform_back(&turn, &tilt->r);
    }
    return pose;
}

/* Turned about the slot's x, which is the way in: one edge lies `height` above the other, the lower one in
 * the slot's plane. */
static wh_pose_t crossed(wh_reader_t *reader, const wh_layout_t *layout, int32_t wafer,
                         const wh_pose_t *base_from_wafer) {
    const wh_station_t *place = &layout->places[station_of(layout, wafer, base_from_wafer)];
    const wh_real_t most = layout->wafer_diameter / 2;
    const wh_real_t usual = place->pitch < most ? place->pitch : most;
    const wh_real_t height = wh_reader_number(reader, "value", usual, 0, most);
    const wh_real_t sine = height / layout->wafer_diameter;
    const wh_real_t cosine = wh_real_sqrt(1 - sine * sine);
    const wh_pose_t tilt = {{{{1, 0, 0}, {0, cosine, -sine}, {0, sine, cosine}}}, {0, 0, height / 2}};
    return in_wafer(&tilt, &place->base_from_station.R, &base_from_wafer->R);
}

static wh_pose_t read_offset(wh_reader_t *reader, const wh_layout_t *layout, const wh_wafer_t wafers[],
                             const wh_fault_t *fault) {
    wh_pose_t pose = fault->offset;
    if (fault->kind == WH_FAULT_WAFER_DOUBLED) {
        pose.r.z = wafers[fault->other].base_from_wafer.R.m[2][2] < 0 ? -layout->wafer_thickness
                                                                      : layout->wafer_thickness;
    } else if (fault->kind == WH_FAULT_WAFER_CROSSED) {
        pose = crossed(reader, layout, fault->target, &wafers[fault->target].base_from_wafer);
    } else if (fault->kind == WH_FAULT_WAFER_SHIFTED) {
        pose.r.x = wh_reader_apart(reader, "dx");
        pose.r.y = wh_reader_apart(reader, "dy");
        pose.r.z = wh_reader_apart(reader, "dz");
    } else if (fault->kind == WH_FAULT_WAFER_TILTED) {
        const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", NULL);
        pose.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    }
    return pose;
}

static int32_t read_station(wh_reader_t *reader, const wh_layout_t *layout) {
    return wh_layout_read_name(reader, layout, "station", NULL, wh_layout_find_station,
                               "the name of a station of this layout");
}

static int32_t read_timed_station(wh_reader_t *reader, const wh_layout_t *layout) {
    const int32_t station = read_station(reader, layout);
    if (!layout->stations[station].times && !layout->stations[station].port) {
        wh_reader_refuse(reader, "station", layout->stations[station].name,
                         "a station that takes time: with `process`, `clean` or `pump`, or a load port");
    }
    return station;
}

static bool is_of_handshake(wh_fault_kind_t kind) {
    return kind == WH_FAULT_E84_STUCK || kind == WH_FAULT_E84_LATE;
}

/* The step of a load port's handshake, from 1. */
static int32_t read_step(wh_reader_t *reader, const wh_layout_t *layout, int32_t station) {
    static const char *const steps[] = {"tp1", "tp2", "tp3", "tp4", "tp5", NULL};
    const wh_layout_port_t *port = layout->stations[station].port;
    if (!port || !port->of.is_e84) {
        wh_reader_refuse(reader, "station", layout->stations[station].name, "a load port with `e84`");
    }
    const int step = wh_reader_choice(reader, "step", WH_NONE, steps);
    if (step == WH_NONE) {
        wh_reader_refuse(reader, "step", NULL, "\"tp1\" to \"tp5\"");
    }
    return step + 1;
}

static int32_t read_beam(wh_reader_t *reader, const wh_layout_t *layout) {
    const int32_t station = read_station(reader, layout);
    const wh_latch_order_t beams = wh_layout_beams_at(layout, (size_t)station);
    if (beams.count == 0) {
        wh_reader_refuse(reader, "station", layout->stations[station].name, "a station with `beams`");
    }
    return beams.first + wh_reader_whole(reader, "beam", 1, 1, beams.count) - 1;
}

static int32_t read_edge_sensor(wh_reader_t *reader, const wh_layout_t *layout) {
    const int32_t station = read_station(reader, layout);
    const int32_t chuck = layout->places[station].chuck;
    if (!wh_layout_scanner(layout, chuck)) {
        wh_reader_refuse(reader, "station", layout->stations[station].name, "a station with a `sensor`");
    }
    return chuck;
}

static int32_t read_probe(wh_reader_t *reader, const wh_layout_t *layout, wh_fault_kind_t kind) {
    if (!layout->probe.is_there) {
        wh_reader_refuse(reader, "kind", wh_fault_name(kind),
                         "a fault of what is there: no gripper has a `probe`");
    }
    return layout->probe.gripper;
}

static bool is_of_probe(wh_fault_kind_t kind) {
    return kind == WH_FAULT_PROBE_CLOSED || kind == WH_FAULT_PROBE_OPEN;
}

static bool is_of_edge_sensor(wh_fault_kind_t kind) {
    return kind == WH_FAULT_EDGE_SENSOR_STUCK || kind == WH_FAULT_EDGE_SENSOR_LATE;
}

/* The only robot, or one of several by its name. */
static int32_t read_robot(wh_reader_t *reader, const wh_layout_t *layout) {
    const char *only = layout->robot_count == 1 ? layout->robots[0].name : NULL;
    return wh_layout_read_name(reader, layout, "robot", only, wh_layout_find_robot,
                               "the name of a robot of this layout");
}

/* The wafer that another one lies on, or the step of a handshake. */
static void read_other(wh_reader_t *reader, const wh_layout_t *layout, wh_fault_t *fault) {
    if (fault->kind == WH_FAULT_WAFER_DOUBLED) {
        fault->other = read_onto(reader, layout, fault->target);
    } else if (is_of_handshake(fault->kind)) {
        fault->other = read_step(reader, layout, fault->target);
    }
}

static void read_target(wh_reader_t *reader, const wh_layout_t *layout, wh_fault_t *fault) {
    if (wh_fault_is_of_wafer(fault->kind)) {
        fault->target = read_wafer(reader, layout, "wafer");
    } else if (wh_fault_is_of_door(fault->kind)) {
        fault->target = wh_layout_read_name(reader, layout, "door", NULL, wh_layout_find_door,
                                            "the name of a door of this layout");
    } else if (wh_fault_is_of_beam(fault->kind)) {
        fault->target = read_beam(reader, layout);
    } else if (wh_fault_is_of_station(fault->kind)) {
        fault->target = read_timed_station(reader, layout);
    } else if (wh_fault_is_of_controller(fault->kind)) {
        fault->target = read_robot(reader, layout);
    } else if (is_of_edge_sensor(fault->kind)) {
        fault->target = read_edge_sensor(reader, layout);
    } else if (is_of_probe(fault->kind)) {
        fault->target = read_probe(reader, layout, fault->kind);
    } else if (fault->kind != WH_FAULT_COMMAND_LOST) {
        fault->target =
            wh_layout_read_gripper_name(reader, layout, "gripper", "the name of a gripper of this layout");
    }
    read_other(reader, layout, fault);
}

/* A fault can only break a part that the grip has. */
static void check_grip(wh_reader_t *reader, const wh_layout_t *layout, const wh_fault_t *fault) {
    const bool of_plunger = fault->kind == WH_FAULT_PLUNGER_STUCK || fault->kind == WH_FAULT_PLUNGER_SLOW;
    const bool of_vacuum = fault->kind == WH_FAULT_NO_VACUUM || fault->kind == WH_FAULT_SLOW_VACUUM ||
                           fault->kind == WH_FAULT_LEAK;
    if (fault->kind == WH_FAULT_VALVE_STUCK && layout->grips[fault->target].kind == WH_GRIP_PASSIVE) {
        wh_reader_refuse(reader, "gripper", layout->grippers[fault->target].name,
                         "a gripper that is not passive: these have no valve");
    }
    if (!of_plunger && !of_vacuum) {
        return;
    }
    const wh_grip_kind_t wanted = of_plunger ? WH_GRIP_EDGE : WH_GRIP_VACUUM;
    const wh_grip_kind_t kind = layout->grips[fault->target].kind;
    if (kind != wanted) {
        wh_reader_refuse(reader, "gripper", layout->grippers[fault->target].name,
                         "a gripper with grip = \"%s\" for a fault of kind \"%s\"; this one has \"%s\"",
                         wh_layout_grip_name(wanted), wh_fault_name(fault->kind), wh_layout_grip_name(kind));
    }
}

/* Reads the size of a fault. For crossed wafers another function reads `value` as a height. */
static wh_real_t read_value(wh_reader_t *reader, wh_fault_kind_t kind) {
    const wh_real_t most = wh_fault_most(kind);
    const wh_real_t least = kind == WH_FAULT_STATION_SLOW ? 1 : 0;
    return most > 0 ? wh_reader_number(reader, "value", WH_REAL(NAN), least, most) : 0;
}

static int64_t slices_of(const wh_layout_t *layout, wh_real_t seconds) {
    return llround(seconds * 1e6 / (double)layout->slice_us);
}

/* Without `lasting` the fault stays until it is cleared; with it, for one slice at least. */
static void read_times(wh_reader_t *reader, const wh_layout_t *layout, int64_t first, wh_fault_t *fault) {
    const wh_real_t lasting = wh_reader_apart_from(reader, "lasting", -1);
    const int64_t slices = slices_of(layout, lasting);
    fault->from = first + slices_of(layout, wh_reader_apart(reader, "after"));
    fault->until = lasting < 0 ? WH_FAULT_FOREVER : fault->from + (slices > 1 ? slices : 1);
}

wh_fault_t wh_layout_read_fault(wh_reader_t *reader, const wh_layout_t *layout, const wh_wafer_t wafers[],
                                int64_t first) {
    wh_fault_t fault = wh_fault_make(read_kind(reader), WH_NONE, 0, first, WH_FAULT_FOREVER);
    wh_reader_refuse_unknown(reader, wh_layout_fault_fields[fault.kind]);
    read_target(reader, layout, &fault);
    check_grip(reader, layout, &fault);
    fault.value = read_value(reader, fault.kind);
    fault.offset = read_offset(reader, layout, wafers, &fault);
    read_times(reader, layout, first, &fault);
    return fault;
}

void wh_layout_read_faults(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "faults")) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    if (count > WH_FAULTS) {
        wh_reader_fail(reader, NULL, "at most %d faults", WH_FAULTS);
    }
    for (size_t i = 0; i < count; ++i) {
        wh_reader_enter_item(reader, (lua_Integer)i + 1);
        layout->physics.faults[i] = wh_layout_read_fault(reader, layout, layout->start, 1);
        wh_reader_leave(reader);
    }
    layout->physics.fault_count = count;
    wh_reader_leave(reader);
}
