/* Finds what the sensors of a cell cannot see: beams that no wafer breaks, and edge sensors that cannot
 * recognize a notch. */
#include <math.h>

#include "../layout/words.h"
#include "../math/trig.h"
#include "feasibility_internal.h"

/* The largest distance between samples on the rim with which ALIGN always finds a notch, mm. */
#define FINE 0.31
/* The largest difference of direction between two scans of one wafer, degrees: lua/mcs/align.lua. */
#define APART 0.07

/* ------------------------------------------------------------------------------------------------- beams */

/* How high above slot 1 a PUT carries a wafer into a slot. */
static double height_of(const wh_layout_t *layout, size_t station, int32_t slot) {
    return (slot - 1) * (double)layout->places[station].pitch + (double)layout->stations[station].offset;
}

static void say_missed(wh_feasibility_t *check, const wh_layout_beam_t *beam, size_t number, int32_t slot) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *station = &layout->stations[beam->station];
    const double height = height_of(layout, (size_t)beam->station, slot);
    wh_finding_t *finding =
        wh_feasibility_add(check, WH_FINDING_SIGHT, beam->station,
                           "%s slot %d: beams[%zu] is from %.6g to %.6g mm above slot 1, and a wafer that is "
                           "put there passes %.6g "
                           "mm above it: it breaks no light",
                           station->name, (int)slot, number, beam->low, beam->high, height);
    finding->slot = slot;
    if (!station->centre) {
        wh_feasibility_warn(check);
    }
}

static void check_beam(wh_feasibility_t *check, size_t b, size_t number) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_beam_t *beam = &layout->beams[b];
    const int32_t slots = layout->places[beam->station].slots;
    for (int32_t slot = 1; slot <= slots; ++slot) {
        const double height = height_of(layout, (size_t)beam->station, slot);
        if (height < beam->low || height > beam->high) {
            say_missed(check, beam, number, slot);
            break;
        }
    }
    if (layout->doors[b].stuck != WH_BEAM_WORKS) {
        (void)wh_feasibility_add(check, WH_FINDING_SIGHT, beam->station,
                                 "%s: beams[%zu] is stuck (`stuck = \"%s\"`) and tells of no wafer",
                                 layout->stations[beam->station].name, number,
                                 wh_layout_beam_stuck_words[layout->doors[b].stuck]);
        wh_feasibility_warn(check);
    }
}

static void check_beams(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    size_t number = 0;
    for (size_t b = 0; b < layout->beam_count; ++b) {
        const bool same = b > 0 && layout->beams[b].station == layout->beams[b - 1].station;
        number = same ? number + 1 : 1;
        if (layout->doors[b].kind == WH_DOOR_LIGHT) {
            check_beam(check, b, number);
        }
    }
}

/* ------------------------------------------------------------------------------------------ edge sensors */

/* ALIGN scans in both directions, and an unknown latency turns the two results against each other. */
static void check_latency(wh_feasibility_t *check, size_t i) {
    const wh_layout_t *layout = check->layout;
    const wh_scanner_t *scanner = &layout->scanners[i];
    const double unknown = fabs(scanner->sensor.error.latency - layout->believed[i].latency);
    const double speed = (double)wh_deg_from_rad(layout->machine.chuck_limits.speed);
    const int32_t station = layout->grippers[scanner->gripper].station;
    if (2 * speed * unknown > APART) {
        (void)wh_feasibility_add(check, WH_FINDING_SIGHT, station,
                                 "%s: a latency of %.4g ms that `sensor.believed` does not have turns the "
                                 "two scans of ALIGN against "
                                 "each other, by up to %.3g degrees at %.6g degrees/s: from %.3g on that is "
                                 "NOTCH_NOT_SURE; less than "
                                 "%.3g ms never is, and CALIBRATE finds it out",
                                 layout->stations[station].name, 1000 * unknown, 2 * speed * unknown, speed,
                                 APART, 1000 * APART / (2 * speed));
        wh_feasibility_warn(check);
    }
}

static void check_scanner(wh_feasibility_t *check, size_t i) {
    const wh_layout_t *layout = check->layout;
    const wh_scanner_t *scanner = &layout->scanners[i];
    const wh_sensor_t *sensor = &scanner->sensor;
    const int32_t station = layout->grippers[scanner->gripper].station;
    const char *name = layout->stations[station].name;
    const double round = WH_PI * layout->wafer_diameter;
    const double depth = layout->nominal_rim->notch.depth;
    if (depth > 0 && round / sensor->samples > FINE) {
        (void)wh_feasibility_add(
            check, WH_FINDING_SIGHT, station,
            "%s: `sensor.samples` of %d are %.4g mm apart on a wafer's rim: ALIGN is sure of "
            "a notch with %.6g mm or less, %d samples, and without one of the centre alone",
            name, (int)sensor->samples, round / sensor->samples, FINE, (int)(round / FINE) + 1);
        wh_feasibility_warn(check);
    }
    check_latency(check, i);
    if (sensor->length / 2 <= depth) {
        (void)wh_feasibility_add(
            check, WH_FINDING_SIGHT, station,
            "%s: `sensor.length` of %.6g mm ends %.6g mm inside of a wafer's rim, where its "
            "notch of %.6g mm ends or goes on",
            name, sensor->length, sensor->length / 2, depth);
        wh_feasibility_warn(check);
    }
}

void wh_feasibility_sight(wh_feasibility_t *check) {
    check_beams(check);
    for (size_t i = 0; i < check->layout->scanner_count; ++i) {
        check_scanner(check, i);
    }
}
