/* Wafers that an edge grip would not hold where they lie: off by more than its pocket's clearance, or of a
 * size that its window does not have. Asked is the very function by which the simulator closes the
 * plunger. */
#include <stdio.h>

#include "feasibility_internal.h"

/* Why it would not hold; empty: it would. */
typedef struct {
    char text[200];
} reason_t;

static const wh_edge_t *edge_of(const wh_layout_t *layout, size_t w) {
    const int32_t gripper = layout->stations[layout->wafers[w].station].effector;
    return layout->grips[gripper].kind == WH_GRIP_EDGE ? &layout->grips[gripper].edge : NULL;
}

/* Its middle on the blade that comes for it. */
static wh_vec3_t middle_of(const wh_layout_t *layout, size_t w) {
    const wh_layout_wafer_t *from = &layout->wafers[w];
    const wh_pose_t blade = wh_feasibility_slot(layout, &layout->places[from->station], from->slot);
    return wh_pose_relative(&blade, &layout->start[w].base_from_wafer).r;
}

static reason_t reason_of(const wh_layout_t *layout, size_t w) {
    reason_t reason = {""};
    wh_edge_place_t place;
    const wh_edge_t *edge = edge_of(layout, w);
    wh_edge_wafer_t lying = wh_feasibility_lying(layout, w);
    const wh_vec3_t middle = middle_of(layout, w);
    const double off = (double)wh_real_sqrt(middle.x * middle.x + middle.y * middle.y);
    lying.x = (double)middle.x;
    lying.y = (double)middle.y;
    const wh_status_t status = wh_edge_at(edge, &lying, edge->end, &place);
    if (status == WH_OK && place.held) {
        return reason;
    }
    if (off > edge->clearance) {
        (void)snprintf(reason.text, sizeof reason.text,
                       "lies %.3f mm off its centre (expected at most its clearance, %.10g mm)", off,
                       edge->clearance);
    } else {
        (void)snprintf(reason.text, sizeof reason.text,
                       "with a radius of %.10g mm leaves its plunger at %.3f mm (expected %.10g to %.10g mm)",
                       lying.radius, place.s, edge->gripped_from, edge->gripped_to);
    }
    return reason;
}

/* How many behind this wafer lie so at its station. */
static size_t count_more(const wh_layout_t *layout, size_t w) {
    size_t count = 0;
    for (size_t other = w + 1; other < layout->wafer_count; ++other) {
        const bool is_there = layout->wafers[other].station == layout->wafers[w].station;
        count += is_there && reason_of(layout, other).text[0] != '\0' ? 1 : 0;
    }
    return count;
}

static void say(wh_feasibility_t *check, size_t w, const reason_t *reason) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_wafer_t *wafer = &layout->wafers[w];
    const wh_layout_station_t *station = &layout->stations[wafer->station];
    const size_t more = count_more(layout, w);
    char others[60] = "";
    if (more > 0) {
        (void)snprintf(others, sizeof others, ", and so do %zu more there", more);
    }
    wh_finding_t *finding =
        wh_feasibility_add(check, WH_FINDING_POCKET, wafer->station,
                           "%s slot %d: %s does not hold %s, which %s%s", station->name, (int)wafer->slot,
                           layout->grippers[station->effector].name, wafer->name, reason->text, others);
    finding->slot = wafer->slot;
    wh_feasibility_warn(check);
}

void wh_feasibility_pockets(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    int32_t said = WH_NONE;
    for (size_t w = 0; layout->edge_wafers && w < layout->wafer_count; ++w) {
        const int32_t station = layout->wafers[w].station;
        if (station == said || !edge_of(layout, w)) {
            continue;
        }
        const reason_t reason = reason_of(layout, w);
        if (reason.text[0] != '\0') {
            say(check, w, &reason);
            said = station;
        }
    }
}
