#include "rehearsal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../grasp/restore.h"
#include "../layout/collision.h"
#include "../layout/doors.h"
#include "../layout/travel.h"
#include "../text/array.h"

void wh_rehearsal_begin(wh_rehearsal_t *rehearsal, const wh_track_t *track, bool is_judged) {
    rehearsal->is_on = true;
    rehearsal->is_judged = is_judged;
    rehearsal->kept = *track;
    rehearsal->planned.count = 0;
}

void wh_rehearsal_add(wh_rehearsal_t *rehearsal, const wh_planned_t *planned) {
    rehearsal->planned.segments =
        wh_array_grow(rehearsal->planned.segments, rehearsal->planned.count, &rehearsal->planned.capacity,
                      sizeof *rehearsal->planned.segments);
    rehearsal->planned.segments[rehearsal->planned.count++] = *planned;
}

void wh_rehearsal_take(wh_rehearsal_t *rehearsal, const wh_planned_t planned[], size_t count) {
    rehearsal->planned.count = 0;
    for (size_t i = 0; i < count; ++i) {
        wh_rehearsal_add(rehearsal, &planned[i]);
    }
}

void wh_rehearsal_end(wh_rehearsal_t *rehearsal, wh_track_t *track) {
    if (rehearsal->is_on) {
        *track = rehearsal->kept;
        rehearsal->is_on = false;
    }
}

void wh_rehearsal_free(wh_rehearsal_t *rehearsal) {
    free(rehearsal->planned.segments);
    rehearsal->planned.segments = NULL;
    rehearsal->planned.count = rehearsal->planned.capacity = 0;
}

/* -------------------------------------------------------------------------------------------------- reach */

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

/* A SCARA's elbow is checked only at the line's ends: it bends most where the line passes the shoulder. */
static bool passes_axis(const wh_track_t *track, const wh_carrier_t *carrier, wh_real_t *least_R) {
    if (carrier) {
        return carrier->chain.kind != WH_CHAIN_SCARA &&
               wh_travel_passes_axis(&track->plan.chain_line.path, least_R);
    }
    return wh_travel_passes_axis(&track->plan.line, least_R);
}

/* The index, among its robot's axes, of R of the arm that goes in a line. */
static size_t reach_axis(const wh_track_t *track, const wh_carrier_t *carrier) {
    const wh_machine_t *machine = track->machine;
    const bool is_second =
        carrier && track->segment.gripper != WH_NONE && machine->mounts[track->segment.gripper].arm > 0;
    return is_second ? carrier->axis_count - 1 : WH_AXIS_R;
}

void wh_rehearsal_note_reach(const wh_rehearsal_t *rehearsal, const wh_track_t *track, wh_record_t *record) {
    const wh_machine_t *machine = track->machine;
    wh_real_t least_R = 0;
    if (rehearsal->reach_slot == 0) {
        return;
    }
    wh_travel_margin_t *least = record->reach[rehearsal->reach_station].axes;
    size_t first;
    const wh_carrier_t *carrier = wh_machine_carrier(machine, rehearsal->reach_robot, &first);
    const size_t end = first + (carrier ? carrier->axis_count : WH_ROBOT_AXES);
    if (track->segment.kind == WH_SEGMENT_LINE && passes_axis(track, carrier, &least_R)) {
        const size_t R = first + reach_axis(track, carrier);
        note_axis(wh_machine_travel(machine, R), least_R, rehearsal->reach_slot, &least[R]);
    }
    for (size_t axis = first; axis < end; ++axis) {
        note_axis(wh_machine_travel(machine, axis), track->axes[axis], rehearsal->reach_slot, &least[axis]);
    }
}

/* -------------------------------------------------------------------------------------------------- ahead */

/* Another task's segment, which goes on. */
typedef struct {
    wh_track_t track;
    bool goes, is_drawn;
    uint32_t axes;
    const char *text;
} going_t;

/* The copy of the cell. */
typedef struct {
    const wh_layout_t *layout;
    wh_nominal_t *nominal; /* null: no trial */
    bool is_begun;         /* the cell's state could be copied for this command */
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_grips_room_t grips;
    wh_track_t own;            /* stands where the command's last segment ends */
    going_t others[WH_OTHERS]; /* the others' segments */
    size_t other_count;
    int32_t switched[WH_GRIPPERS]; /* the valve's setting by others since the command began;
                                    * WH_NONE: unchanged */
    void *world_memory;
    wh_wafer_t wafers[];
} ahead_t;

static size_t own_bytes(const wh_layout_t *layout) {
    return (sizeof(ahead_t) + (layout->wafer_count + wh_layout_seen(layout)) * sizeof(wh_wafer_t) + 15) / 16 *
           16;
}

size_t wh_rehearsal_ahead_bytes(const wh_layout_t *layout) {
    return own_bytes(layout) + wh_collision_bytes(layout);
}

/* Sets up the edge grips, before anything is held. */
static bool give_grips(ahead_t *ahead) {
    return wh_layout_give_doors(ahead->layout, &ahead->simulator) == WH_OK &&
           wh_layout_give_grips(ahead->layout, &ahead->simulator, &ahead->grips) == WH_OK;
}

/* Puts the copy where motion control stands. */
static bool begin_ahead(ahead_t *ahead, const wh_state_t *state) {
    const wh_layout_t *layout = ahead->layout;
    const wh_grasp_storage_t storage = {.wafers = ahead->wafers,
                                        .wafer_count = layout->wafer_count,
                                        .grippers = ahead->grippers,
                                        .gripper_count = layout->machine.gripper_count};
    ahead->grips.seen = &ahead->wafers[layout->wafer_count];
    memcpy(ahead->wafers, state->wafers, layout->wafer_count * sizeof *ahead->wafers);
    if (wh_simulator_init(&ahead->simulator, &layout->grasp, &storage, &layout->cell) != WH_OK ||
        !give_grips(ahead) ||
        wh_grasp_restore(&ahead->simulator.table, (uint64_t)state->seq, state->wafers, state->grippers) !=
            WH_OK) {
        return false;
    }
    if (state->physics) {
        memcpy(ahead->simulator.physics.grips, state->physics->grips, sizeof state->physics->grips);
        ahead->simulator.physics.doors = state->physics->doors;
    }
    wh_collision_attach(&ahead->collision, layout, &ahead->simulator, ahead->world_memory);
    ahead->collision.is_told = true;
    return true;
}

static const wh_event_t *find_hit(const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        if (state->events[i].kind == WH_EVENT_HIT || state->events[i].kind == WH_EVENT_UNDECIDED) {
            return &state->events[i];
        }
    }
    return NULL;
}

/* The robot that a part is on, or a wafer; WH_NONE: on none. */
static int32_t robot_of(const ahead_t *ahead, int32_t part) {
    const wh_layout_t *layout = ahead->layout;
    const size_t parts = layout->world.part_count;
    int32_t gripper = WH_NONE;
    if (part >= 0 && (size_t)part >= parts) {
        gripper = ahead->wafers[(size_t)part - parts].holder;
    } else if (part >= 0 && layout->world.parts[part].kind == WH_PART_ARM) {
        return layout->arms[layout->world.parts[part].owner / (int32_t)WH_ARM_BODIES].robot;
    } else if (part >= 0 && layout->world.parts[part].kind == WH_PART_BLADE) {
        gripper = layout->world.parts[part].owner;
    }
    return gripper == WH_NONE || layout->machine.mounts[gripper].axis != WH_NONE
               ? WH_NONE
               : layout->machine.mounts[gripper].robot;
}

/* The segment that plays on the robot; null: none. */
static const going_t *find_other(const ahead_t *ahead, int32_t robot) {
    for (size_t i = 0; robot != WH_NONE && i < ahead->other_count; ++i) {
        size_t first;
        (void)wh_machine_carrier(&ahead->layout->machine, (size_t)robot, &first);
        if ((ahead->others[i].axes >> first & 1U) != 0) {
            return &ahead->others[i];
        }
    }
    return NULL;
}

static void describe_hit(const ahead_t *ahead, const wh_event_t *hit, char *reason) {
    const char *one = wh_layout_part_name(ahead->layout, hit->parts[0]);
    const char *two = wh_layout_part_name(ahead->layout, hit->parts[1]);
    const going_t *other = find_other(ahead, robot_of(ahead, hit->parts[0]));
    other = other ? other : find_other(ahead, robot_of(ahead, hit->parts[1]));
    snprintf(reason, WH_REHEARSAL_REASON_BYTES, "%s and %s at %.3f, %.3f, %.3f mm%s%s", one ? one : "a part",
             two ? two : "others", (double)hit->at.x, (double)hit->at.y, (double)hit->at.z,
             other && other->text ? ", on the way of " : "", other && other->text ? other->text : "");
}

static void take_others(ahead_t *ahead, const wh_ahead_start_t *start) {
    ahead->other_count = start->other_count;
    for (size_t i = 0; i < start->other_count; ++i) {
        const wh_other_t *other = &start->others[i];
        ahead->others[i] = (going_t){*other->track, true, other->is_drawn, other->axes, other->text};
        ahead->others[i].track.machine = &ahead->layout->machine;
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        ahead->switched[g] = WH_NONE;
    }
}

/* Plays one slice of another task's segment. False if it stands. */
static bool go_on(ahead_t *ahead, going_t *other) {
    if (other->goes && !other->is_drawn) {
        other->goes = wh_track_next(&other->track, 0) == WH_TRACK_MOVING;
    }
    other->is_drawn = false;
    const wh_segment_t *segment = &other->track.segment;
    for (size_t g = 0; segment->kind == WH_SEGMENT_VALVES && g < ahead->layout->machine.gripper_count; ++g) {
        ahead->switched[g] = segment->valves[g] != WH_NONE ? segment->valves[g] : ahead->switched[g];
    }
    return other->goes;
}

/* Puts the others' axes and valves into the command's track. True if any of them goes on. */
static bool show_others(ahead_t *ahead, wh_track_t *shown) {
    bool any = false;
    for (size_t i = 0; i < ahead->other_count; ++i) {
        going_t *other = &ahead->others[i];
        any = go_on(ahead, other) || any;
        for (size_t axis = 0; axis < ahead->layout->machine.axis_count; ++axis) {
            shown->axes[axis] = (other->axes >> axis & 1U) != 0 ? other->track.axes[axis] : shown->axes[axis];
        }
    }
    for (size_t g = 0; g < ahead->layout->machine.gripper_count; ++g) {
        shown->valves[g] = ahead->switched[g] != WH_NONE ? ahead->switched[g] : shown->valves[g];
    }
    return any;
}

/* Plays the command's segment, or lets it stand while the others go on. */
static const wh_event_t *play_ahead(ahead_t *ahead, bool stands, int64_t *slices, wh_state_t *state) {
    wh_command_t command = {.fault_count = 0};
    wh_machine_cache_t cache = {.is_taken = false};
    wh_track_t shown = ahead->own;
    while (stands || wh_track_next(&ahead->own, 0) == WH_TRACK_MOVING) {
        memcpy(shown.axes, ahead->own.axes, sizeof shown.axes);
        memcpy(shown.valves, ahead->own.valves, sizeof shown.valves);
        shown.slice = ahead->own.slice;
        if (!show_others(ahead, &shown) && stands) {
            return NULL;
        }
        wh_command_from_track(&command, &cache, &shown);
        (void)wh_simulator_step(&ahead->simulator, &command, state);
        ++*slices;
        const wh_event_t *hit = find_hit(state);
        if (hit) {
            return hit;
        }
    }
    return NULL;
}

static void begin_other_command(ahead_t *ahead, const wh_ahead_start_t *start) {
    wh_state_t state = *start->state;
    if (ahead->nominal) {
        wh_nominal_believe(ahead->nominal, start->state, &state);
    }
    ahead->is_begun = begin_ahead(ahead, &state);
    take_others(ahead, start);
}

static bool judge_ahead(void *user, const wh_track_t *track, const wh_ahead_start_t *start, int64_t *slices,
                        char *reason) {
    ahead_t *ahead = user;
    wh_state_t state;
    if (start) {
        begin_other_command(ahead, start);
    }
    if (!ahead->is_begun) {
        snprintf(reason, WH_REHEARSAL_REASON_BYTES, "nothing can be said, the cell's state was refused");
        return true;
    }
    if (track) {
        ahead->own = *track;
        ahead->own.machine = &ahead->layout->machine;
    }
    if (track && track->segment.kind == WH_SEGMENT_SENSOR) {
        return false; /* no part of it moves */
    }
    const wh_event_t *hit = play_ahead(ahead, !track, slices, &state);
    if (hit) {
        describe_hit(ahead, hit, reason);
    }
    return hit != NULL;
}

void wh_rehearsal_look_ahead(wh_rehearsal_t *rehearsal, const wh_layout_t *layout, wh_nominal_t *nominal,
                             void *memory) {
    ahead_t *ahead = memory;
    memset(ahead, 0, sizeof *ahead);
    ahead->layout = layout;
    ahead->nominal = nominal;
    ahead->world_memory = (unsigned char *)memory + own_bytes(layout);
    rehearsal->look_ahead = judge_ahead;
    rehearsal->look_ahead_user = ahead;
}
