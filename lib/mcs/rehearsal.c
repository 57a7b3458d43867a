#include "rehearsal.h"

#include <stdlib.h>

#include "../text/array.h"

void wh_rehearsal_begin(wh_rehearsal_t *rehearsal, const wh_track_t *track, bool is_judged) {
    rehearsal->is_on = true;
    rehearsal->is_judged = is_judged;
    rehearsal->kept = *track;
    rehearsal->count = 0;
}

void wh_rehearsal_add(wh_rehearsal_t *rehearsal, const wh_planned_t *planned) {
    rehearsal->segments = wh_array_grow(rehearsal->segments, rehearsal->count, &rehearsal->capacity,
                                        sizeof *rehearsal->segments);
    rehearsal->segments[rehearsal->count++] = *planned;
}

void wh_rehearsal_end(wh_rehearsal_t *rehearsal, wh_track_t *track) {
    if (rehearsal->is_on) {
        *track = rehearsal->kept;
        rehearsal->is_on = false;
    }
}

void wh_rehearsal_free(wh_rehearsal_t *rehearsal) {
    free(rehearsal->segments);
    rehearsal->segments = NULL;
    rehearsal->count = rehearsal->capacity = 0;
}

/* --------------------------------------------------------------------------------------------------------- reach */

static void note_axis(const wh_travel_t *travel, wh_real_t at, int32_t slot, wh_travel_margin_t *least) {
    const bool is_max = travel->max - at < at - travel->min;
    const wh_real_t margin = is_max ? travel->max - at : at - travel->min;
    if (least->slot == 0 || margin < least->margin) {
        least->margin = margin > 0 ? margin : 0;
        least->at = at;
        least->is_max = is_max;
        least->slot = slot;
    }
}

/* Where a line passes base's axis, R is least between its ends; all else runs one way. */
static bool passes_axis(const wh_line_t *line, wh_real_t *least_R) {
    const wh_real_t outward = line->direction.x;
    const wh_real_t level = outward * outward + line->direction.y * line->direction.y;
    const wh_real_t R = line->from[WH_AXIS_R];
    *least_R = R * wh_real_abs(line->direction.y) / wh_real_sqrt(level);
    return outward < 0 && -R * outward < level * line->path.distance;
}

void wh_rehearsal_note_reach(const wh_rehearsal_t *rehearsal, const wh_track_t *track, wh_record_t *record) {
    const wh_travel_t *travel = track->machine->robot.travel;
    wh_real_t least_R;
    if (rehearsal->reach_slot == 0) {
        return;
    }
    wh_travel_margin_t *least = record->reach[rehearsal->reach_station].axes;
    if (track->segment.kind == WH_SEGMENT_LINE && passes_axis(&track->plan.line, &least_R)) {
        note_axis(&travel[WH_AXIS_R], least_R, rehearsal->reach_slot, &least[WH_AXIS_R]);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        note_axis(&travel[axis], track->axes[axis], rehearsal->reach_slot, &least[axis]);
    }
}
