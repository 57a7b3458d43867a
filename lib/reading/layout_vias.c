/* The points that an arm passes on its way to a station, and back on its way away. */
#include "../layout/axes.h"
#include "../math/trig.h"
#include "layout_internal.h"

/* A robot's carrier; null: it is that of motion/robot.h. */
static const wh_carrier_t *carrier_of(const wh_layout_t *layout, size_t robot) {
    return layout->machine.carrier ? &layout->robots[robot].carrier : NULL;
}

/* How many axes the robot has of its own. */
static size_t axes_of(const wh_carrier_t *carrier) {
    return carrier ? carrier->axis_count : WH_ROBOT_AXES;
}

static bool has_elbow(const wh_carrier_t *carrier) {
    return carrier && carrier->chain.kind == WH_CHAIN_SCARA;
}

/* The field that says where one of the robot's axes is at a point; null: no field does. A second arm has no
 * fields of its own: `r` and `yaw` belong to the arm that goes to the station. */
static const char *field_of(const wh_carrier_t *carrier, size_t own) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    if (own < WH_ROBOT_AXES) {
        return own == WH_AXIS_R && has_elbow(carrier) ? "forearm" : names[own];
    }
    return own < WH_CARRIER_AXES && carrier->axes[own] == WH_CHAIN_RAIL ? "rail" : NULL;
}

/* Within its travel; angles in degrees. */
static wh_real_t read_axis(wh_reader_t *reader, const wh_layout_t *layout, size_t axis, const char *name) {
    const wh_travel_t *travel = wh_machine_travel(&layout->machine, axis);
    if (!wh_axis_turns(&layout->machine, axis)) {
        return wh_reader_number(reader, name, 0, travel->min, travel->max);
    }
    return wh_rad_from_deg(
        wh_reader_number(reader, name, 0, wh_deg_from_rad(travel->min), wh_deg_from_rad(travel->max)));
}

static void refuse_others(wh_reader_t *reader, const wh_carrier_t *carrier) {
    if (has_elbow(carrier)) {
        wh_layout_refuse_field(reader, "r", "nothing: a robot of kind \"SCARA\" has a forearm");
    } else {
        wh_layout_refuse_field(reader, "forearm", "nothing: this is of a robot of kind \"SCARA\"");
    }
    if (carrier && carrier->chain.kind == WH_CHAIN_TRZ) {
        wh_layout_refuse_field(reader, "yaw", "nothing: a robot of kind \"TRZ\" has no wrist");
    }
    if (!carrier || !carrier->chain.has_rail) {
        wh_layout_refuse_field(reader, "rail", "nothing: the robot has no rail");
    }
}

static void read_via(wh_reader_t *reader, const wh_layout_t *layout, size_t robot, wh_layout_via_t *via) {
    const wh_carrier_t *carrier = carrier_of(layout, robot);
    size_t first = 0;
    bool is_any = false;
    (void)wh_machine_carrier(&layout->machine, robot, &first);
    wh_reader_refuse_unknown(reader, wh_layout_via_fields);
    refuse_others(reader, carrier);
    for (size_t own = 0; own < axes_of(carrier) && own < WH_CARRIER_AXES; ++own) {
        const char *field = field_of(carrier, own);
        via->is_given[own] = field && wh_reader_has(reader, field);
        if (via->is_given[own]) {
            via->point.q[own] = read_axis(reader, layout, first + own, field);
            is_any = true;
        }
    }
    via->point.blend = wh_reader_apart(reader, "blend");
    if (!is_any) {
        wh_reader_fail(reader, NULL, "at least one of theta, r (of a SCARA forearm), z, yaw and rail");
    }
}

/* `via` of the station, or of the robot's own part of it, at which the reader is. */
static void read_points(wh_reader_t *reader, const wh_layout_t *layout, size_t robot,
                        wh_layout_vias_t *vias) {
    if (!wh_reader_has(reader, "via")) {
        return;
    }
    (void)wh_reader_enter(reader, "via");
    vias->count = wh_reader_list(reader);
    if (vias->count > WH_LAYOUT_VIAS) {
        wh_reader_fail(reader, NULL, "at most %d points of a station", WH_LAYOUT_VIAS);
    }
    for (size_t i = 0; i < vias->count; ++i) {
        wh_reader_enter_item(reader, (lua_Integer)i + 1);
        read_via(reader, layout, robot, &vias->at[i]);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* With several robots each has its own points: a point is where its axes stand. */
static void read_by(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_station_t *station) {
    wh_layout_refuse_field(reader, "via", "nothing: with several robots `by` says it of each");
    if (!wh_reader_enter(reader, "by")) {
        return;
    }
    for (size_t r = 0; r < layout->robot_count; ++r) {
        if (wh_reader_enter(reader, layout->robots[r].name)) {
            read_points(reader, layout, r, &station->by[r].vias);
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
}

void wh_layout_read_vias(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_layout_station_t *station = &layout->stations[s];
        wh_reader_enter(reader, station->name);
        if (station->by) {
            read_by(reader, layout, station);
        } else {
            read_points(reader, layout, 0, &station->vias);
        }
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}
