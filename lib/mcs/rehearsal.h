/* A rehearsal: a command is planned to its end before anything moves.
 *
 * The track runs ahead and comes back; each segment is kept as it was planned, so that it is played as it is
 * while motion control gets the answers that the rehearsal assumed. On the way a rehearsal can have someone
 * look for collisions ahead, and can note how near the axes come to the ends of their travel.
 */
#ifndef WH_MCS_REHEARSAL_H
#define WH_MCS_REHEARSAL_H

#include "../layout/grips.h"
#include "../motion/track.h"
#include "../record/record.h"
#include "../sim/slice.h"
#include "nominal.h"

/* Another task's segment that runs meanwhile. */
typedef struct {
    const wh_track_t *track;
    bool is_drawn;    /* the track stands at the end of the slice that comes */
    uint32_t axes;    /* bits: what it moves */
    const char *text; /* the command that it is of; null: none */
} wh_other_t;

/* The most segments that run at once: one for each robot, chuck, pins, flipper and door. */
#define WH_OTHERS (WH_LAYOUT_ROBOTS + WH_GRIPPERS + WH_DOORS)

/* What of the cell a command begins with: the last state from it, nothing of the command having been played
 * since, and what others play. */
typedef struct {
    const wh_state_t *state;
    const wh_other_t *others;
    size_t other_count; /* at most WH_OTHERS */
} wh_ahead_start_t;

/* Judges a segment that `track` has just begun: its valves are as the segments before it leave them. `start`
 * is there with the first segment of a command, and null with the others. The others go on along their
 * segments, and then stand. With a null track what is left of these is judged, the command being over. True
 * if it would collide; `reason`, of WH_REHEARSAL_REASON_BYTES, then says with what. Adds the slices that it
 * has looked at. */
#define WH_REHEARSAL_REASON_BYTES 320
typedef bool wh_look_ahead_t(void *user, const wh_track_t *track, const wh_ahead_start_t *start,
                             int64_t *slices, char *reason);

/* Whose sensor a segment of kind SENSOR awaits: the vacuum's of its gripper, or the end switch of a door or
 * of what carries a gripper. */
typedef struct {
    enum { WH_AWAITED_VACUUM, WH_AWAITED_DOOR, WH_AWAITED_GRIPPER } kind;
    int32_t index;
} wh_awaited_t;

/* A segment that was planned, ready to be played: a track that has just begun it. */
typedef struct {
    wh_track_t track;
    wh_task_t task;
    uint32_t may_lose; /* bit g: gripper g could lose a wafer in it */
    wh_awaited_t awaited;
} wh_planned_t;

typedef struct {
    wh_planned_t *segments;
    size_t count, capacity;
} wh_plan_list_t;

/* All zero to begin with. Set `look_ahead`, if anybody does, and where the reach is noted; the rest is only
 * to be read. */
typedef struct {
    bool is_on;             /* segments are planned, not played */
    bool is_judged;         /* and looked at for collisions */
    wh_track_t kept;        /* the track from before */
    wh_plan_list_t planned; /* of the last rehearsal, in order */
    wh_look_ahead_t *look_ahead;
    void *look_ahead_user;
    int32_t reach_station, reach_slot; /* where it goes in, slot from 1; slot 0: the reach is not noted */
    size_t reach_robot;                /* and which robot does */
} wh_rehearsal_t;

/* From now on segments are planned, from where the track stands; what was planned before is forgotten. */
void wh_rehearsal_begin(wh_rehearsal_t *rehearsal, const wh_track_t *track, bool is_judged);

/* Keeps a planned segment. Ends the program if out of memory. */
void wh_rehearsal_add(wh_rehearsal_t *rehearsal, const wh_planned_t *planned);

/* Notes in the record how near the axes come to their ends in the segment that the track has skipped, if that
 * is asked for. */
void wh_rehearsal_note_reach(const wh_rehearsal_t *rehearsal, const wh_track_t *track, wh_record_t *record);

/* Has collisions looked for ahead, on a copy of the cell. The copy begins where motion control last saw
 * wafers and grippers, or, in a trial, where it believes them to be (`nominal`; null: no trial). It takes and
 * lets go by the paper's rule, with vacuum that is there at once, and knows nothing of faults to come.
 * `memory`, as many bytes and aligned as malloc's, the layout and `nominal` must outlive it. */
size_t wh_rehearsal_ahead_bytes(const wh_layout_t *layout);
void wh_rehearsal_look_ahead(wh_rehearsal_t *rehearsal, const wh_layout_t *layout, wh_nominal_t *nominal,
                             void *memory);

/* If a rehearsal goes on, it is over: the track is where it was. */
void wh_rehearsal_end(wh_rehearsal_t *rehearsal, wh_track_t *track);

/* Frees the planned segments. */
void wh_rehearsal_free(wh_rehearsal_t *rehearsal);

#endif
