/* The points that the arm passes on its way to a station, and back on its way away. */
#include "../math/hash.h"
#include "../math/trig.h"
#include "layout_internal.h"

#define USUAL_BLEND 50

/* Only a polar arm by itself goes by points, as it does within a circle. */
static bool goes_by_points(const wh_layout_t *layout) {
    const wh_carrier_t *carrier = layout->machine.carrier;
    return !carrier || !(carrier->next || carrier->second || carrier->chain.kind == WH_CHAIN_SCARA ||
                         carrier->chain.has_rail || carrier->chain.has_tilt || carrier->chain.has_flip);
}

/* Within its travel; angles in degrees. */
static wh_real_t read_axis(wh_reader_t *reader, const wh_layout_t *layout, size_t axis, const char *name) {
    const wh_travel_t *travel = wh_machine_travel(&layout->machine, axis);
    if (axis != WH_AXIS_THETA && axis != WH_AXIS_YAW) {
        return wh_reader_number(reader, name, 0, travel->min, travel->max);
    }
    return wh_rad_from_deg(
        wh_reader_number(reader, name, 0, wh_deg_from_rad(travel->min), wh_deg_from_rad(travel->max)));
}

static void read_via(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_via_t *via) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    const wh_carrier_t *carrier = layout->machine.carrier;
    bool is_any = false;
    wh_reader_refuse_unknown(reader, wh_layout_via_fields);
    if (carrier && carrier->chain.kind == WH_CHAIN_TRZ) {
        wh_layout_refuse_field(reader, "yaw", "nothing: a robot of kind \"TRZ\" has no wrist");
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        via->is_given[axis] = wh_reader_has(reader, names[axis]);
        if (via->is_given[axis]) {
            via->point.q[axis] = read_axis(reader, layout, axis, names[axis]);
            is_any = true;
        }
    }
    via->point.blend = wh_reader_number(reader, "blend", USUAL_BLEND, 0, 1000);
    if (!is_any) {
        wh_reader_fail(reader, NULL, "at least one of theta, r, z and yaw");
    }
}

static void read_station(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_station_t *station) {
    if (!wh_reader_has(reader, "via")) {
        return;
    }
    (void)wh_reader_enter(reader, "via");
    station->via_count = wh_reader_list(reader);
    if (!goes_by_points(layout)) {
        wh_reader_fail(
            reader, NULL,
            "nothing: it is for one robot of kind \"TRZY\" or \"TRZ\" without rail, tilt, flip and "
            "arms");
    }
    if (station->via_count > WH_LAYOUT_VIAS) {
        wh_reader_fail(reader, NULL, "at most %d points of a station", WH_LAYOUT_VIAS);
    }
    for (size_t i = 0; i < station->via_count; ++i) {
        wh_reader_enter_item(reader, (lua_Integer)i + 1);
        read_via(reader, layout, &station->vias[i]);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

void wh_layout_read_vias(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_reader_enter(reader, layout->stations[s].name);
        read_station(reader, layout, &layout->stations[s]);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

uint64_t wh_layout_hash_vias(uint64_t hash, const wh_layout_t *layout) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_station_t *station = &layout->stations[s];
        for (size_t i = 0; i < station->via_count; ++i) {
            const wh_layout_via_t *via = &station->vias[i];
            hash = wh_hash_real(wh_hash_word(hash, s + 1), via->point.blend);
            for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
                hash = wh_hash_real(wh_hash_int(hash, via->is_given[axis] ? 1 : 0), via->point.q[axis]);
            }
        }
    }
    return hash;
}
