/* Finds wafers that an edge grip would not hold where they lie: too high or askew, off by more than its
 * pocket's clearance, or of a size outside its window. It calls the function with which the simulator closes
 * the plunger. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/grips.h"
#include "../layout/ports.h"
#include "feasibility_internal.h"

#define REASON 200

/* An edge grip and a wafer that lies where it comes. */
typedef struct {
    const wh_layout_t *layout;
    const wh_edge_t *edge;
    size_t wafer;
} pocket_t;

/* How the face that looks at the blade lies on it, as the grip itself sees that. */
static wh_edge_wafer_t lying_of(const pocket_t *pocket, wh_proximity_t *measured) {
    const wh_layout_t *layout = pocket->layout;
    const wh_layout_wafer_t *from = &layout->wafers[pocket->wafer];
    const wh_pose_t *wafer = &layout->start[pocket->wafer].base_from_wafer;
    const wh_pose_t blade = wh_layout_come_level(layout, &layout->places[from->station], from->slot);
    const wh_real_t thickness = layout->has_faces ? layout->cell.thickness : 0;
    wh_edge_wafer_t lying = wh_feasibility_lying(layout, pocket->wafer);
    wh_pose_t face = *wafer;
    if (wh_face_seen(wafer, thickness, &blade) == WH_FACE_FRONT) {
        wh_face_frame(wafer, thickness, WH_FACE_FRONT, &face);
    }
    (void)wh_layout_measure(layout, wafer, &blade, measured);
    const wh_vec3_t middle = wh_pose_relative(&blade, &face).r;
    lying.x = (double)middle.x;
    lying.y = (double)middle.y;
    return lying;
}

/* Off by more than the clearance, by so little that only its own digits tell. */
static void say_off(const pocket_t *pocket, double off, char reason[REASON]) {
    const double clearance = pocket->edge->clearance;
    (void)snprintf(reason, REASON,
                   off - clearance < 5e-4
                       ? "lies %.10g mm off its centre (expected at most its clearance, %.10g mm)"
                       : "lies %.3f mm off its centre (expected at most its clearance, %.10g mm)",
                   off, clearance);
}

/* Why it would not be held; false: it would. */
static bool find_reason(const pocket_t *pocket, char reason[REASON]) {
    const wh_edge_t *edge = pocket->edge;
    wh_proximity_t measured;
    wh_edge_place_t place = {.held = false};
    const wh_edge_wafer_t lying = lying_of(pocket, &measured);
    const wh_status_t status = wh_edge_at(edge, &lying, edge->end, &place);
    const double off = sqrt(lying.x * lying.x + lying.y * lying.y);
    reason[0] = '\0';
    if ((measured.failed & WH_FAILED_PLANAR) != 0) {
        (void)snprintf(reason, REASON, "lies askew to it: n1_proj_n2 is %.4f (expected more than %.10g)",
                       (double)measured.n1_proj_n2, (double)pocket->layout->grasp.tolerance.planar);
    } else if ((measured.failed & WH_FAILED_PROJZ) != 0) {
        (void)snprintf(reason, REASON,
                       "lies too high or too low: |dr_proj_z| is %.3f mm (expected below %.10g mm)",
                       fabs((double)measured.dr_proj_z), (double)pocket->layout->grasp.tolerance.projz);
    } else if (off > edge->clearance) {
        say_off(pocket, off, reason);
    } else if (status != WH_OK || !place.held) {
        (void)snprintf(reason, REASON,
                       "with a radius of %.10g mm leaves its plunger at %.3f mm (expected %.10g to %.10g mm)",
                       lying.radius, place.s, edge->gripped_from, edge->gripped_to);
    }
    return reason[0] != '\0';
}

/* True if the wafer is in the station when a run begins. */
static bool lies_in(const wh_layout_t *layout, size_t w, int32_t station) {
    return layout->wafers[w].station == station && !wh_layout_is_outside(&layout->start[w].base_from_wafer);
}

/* ", nor W05, W07 and 3 more there": those behind this wafer that it would not hold either. */
static void list_others(pocket_t pocket, char *text, size_t size) {
    const wh_layout_t *layout = pocket.layout;
    const int32_t station = layout->wafers[pocket.wafer].station;
    size_t length = 0;
    size_t more = 0;
    text[0] = '\0';
    while (++pocket.wafer < layout->wafer_count) {
        char reason[REASON];
        const char *name = layout->wafers[pocket.wafer].name;
        if (!lies_in(layout, pocket.wafer, station) || !find_reason(&pocket, reason)) {
            continue;
        }
        if (more > 0 || length + strlen(name) + 30 > size) {
            ++more;
            continue;
        }
        length += (size_t)snprintf(text + length, size - length, "%s%s",
                                   length > 0 ? ", " : "; nor does it hold ", name);
    }
    if (more > 0) {
        (void)snprintf(text + length, size - length, " and %zu more there", more);
    }
}

/* The first of a station's wafers that this gripper does not hold. */
static void look_at(wh_feasibility_t *check, size_t station, size_t gripper) {
    const wh_layout_t *layout = check->layout;
    pocket_t pocket = {layout, &layout->grips[gripper].edge, 0};
    for (; pocket.wafer < layout->wafer_count; ++pocket.wafer) {
        char reason[REASON];
        char others[200];
        const wh_layout_wafer_t *wafer = &layout->wafers[pocket.wafer];
        if (!lies_in(layout, pocket.wafer, (int32_t)station) || !find_reason(&pocket, reason)) {
            continue;
        }
        list_others(pocket, others, sizeof others);
        wh_finding_t *finding =
            wh_feasibility_add(check, WH_FINDING_POCKET, (int32_t)station,
                               "%s slot %d: %s does not hold %s, which %s%s", layout->stations[station].name,
                               (int)wafer->slot, layout->grippers[gripper].name, wafer->name, reason, others);
        finding->slot = wafer->slot;
        wh_feasibility_warn(check);
        return;
    }
}

/* Another blade comes in as the station's does if it is on the same robot. */
static bool comes_to(const wh_layout_t *layout, size_t station, size_t gripper) {
    const wh_mount_t *mounts = layout->machine.mounts;
    const wh_mount_t *its = &mounts[layout->stations[station].effector];
    return layout->grips[gripper].kind == WH_GRIP_EDGE && mounts[gripper].axis == WH_NONE &&
           mounts[gripper].robot == its->robot;
}

void wh_feasibility_pockets(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    for (size_t s = 0; layout->edge_wafers && s < layout->station_count; ++s) {
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            if (comes_to(layout, s, g)) {
                look_at(check, s, g);
            }
        }
    }
}
