/* A rehearsal: a command is planned to its end before anything moves.
 *
 * The track runs ahead and comes back. Each segment is kept as planned and played like that, if motion
 * control gets the answers that the rehearsal assumed. A rehearsal can also look for collisions ahead, and
 * note how near the axes come to the ends of their travel.
 */
#ifndef WH_MCS_REHEARSAL_H
#define WH_MCS_REHEARSAL_H

#include "../layout/grips.h"
#include "../motion/slow.h"
#include "../record/record.h"
#include "../sim/slice.h"
#include "../trial/nominal.h"

/* Another task's segment that runs meanwhile. */
typedef struct {
    const wh_track_t *track;
    bool is_drawn;    /* the track stands at the end of the next slice */
    uint32_t axes;    /* bits: the axes that it moves */
    const char *text; /* its command; null: none */
} wh_other_t;

/* The most segments that run at once: one for each robot, chuck, pins, flipper and door. */
#define WH_OTHERS (WH_LAYOUT_ROBOTS + WH_GRIPPERS + WH_DOORS)

/* The cell at the beginning of a command: its last state before anything of the command was played, and the
 * segments of others. */
typedef struct {
    const wh_state_t *state;
    const wh_other_t *others;
    size_t other_count; /* at most WH_OTHERS */
} wh_ahead_start_t;

/* Judges a segment that `track` has just begun: its valves are as the segments before it leave them. `start`
 * is given with the first segment of a command, and null with the later ones. The other tasks finish their
 * segments, and then stand. With a null track the command is over, and the rest of the others' segments is
 * judged. True if it would collide; `reason`, of WH_REHEARSAL_REASON_BYTES, then names the parts. Adds the
 * number of slices that it has looked at. */
#define WH_REHEARSAL_REASON_BYTES 320
typedef bool wh_look_ahead_t(void *user, const wh_track_t *track, const wh_ahead_start_t *start,
                             int64_t *slices, char *reason);

/* The sensor that a segment of kind SENSOR awaits: its gripper's vacuum sensor, the end switch of a door or
 * of a gripper's carrier, a station until nothing runs in it, or a load lock until it has pumped. */
typedef enum {
    WH_AWAITED_VACUUM,
    WH_AWAITED_DOOR,
    WH_AWAITED_GRIPPER,
    WH_AWAITED_STATION,
    WH_AWAITED_LOCK,
    WH_AWAITED_PORT
} wh_awaited_kind_t;

typedef struct {
    wh_awaited_kind_t kind;
    int32_t index;
} wh_awaited_t;

/* A segment that was planned, ready to be played: a track that has just begun it. */
typedef struct {
    wh_track_t track;
    wh_via_point_t points[WH_VIA_POINTS]; /* of its segment, which the track no longer has */
    wh_slowness_t slowness;
    wh_task_t task;
    uint32_t may_lose; /* bit g: gripper g could lose a wafer in it */
    wh_awaited_t awaited;
} wh_planned_t;

typedef struct {
    wh_planned_t *segments;
    size_t count, capacity;
} wh_plan_list_t;

/* All zero at first. Set `look_ahead`, if it is wanted, and where the reach is noted; the rest is
 * read-only. */
typedef struct {
    bool is_on;             /* segments are planned, not played */
    bool is_judged;         /* and checked for collisions */
    wh_track_t kept;        /* the track before the rehearsal */
    uint64_t spent;         /* of the budget, before the last rehearsal */
    wh_plan_list_t planned; /* of the last rehearsal, in order */
    wh_look_ahead_t *look_ahead;
    void *look_ahead_user;
    int32_t reach_station, reach_slot; /* the slot (from 1) and its station; slot 0: the reach is not
                                        * noted */
    size_t reach_robot;                /* the robot that goes there */
} wh_rehearsal_t;

/* From now on segments are planned, from the track's place; earlier plans are forgotten. */
void wh_rehearsal_begin(wh_rehearsal_t *rehearsal, const wh_track_t *track, bool is_judged);

/* Keeps a planned segment. Ends the program if out of memory. */
void wh_rehearsal_add(wh_rehearsal_t *rehearsal, const wh_planned_t *planned);

/* Takes the segments of an earlier rehearsal for those of the last one. Ends the program if out of memory. */
void wh_rehearsal_take(wh_rehearsal_t *rehearsal, const wh_planned_t planned[], size_t count);

/* Notes in the record how near the axes come to their ends in the segment that the track has skipped, if
 * asked for. */
void wh_rehearsal_note_reach(const wh_rehearsal_t *rehearsal, const wh_track_t *track, wh_record_t *record);

/* Looks for collisions ahead, on a copy of the cell. The copy begins where motion control last saw wafers and
 * grippers, or, in a trial, where it believes them to be (`nominal`; null: no trial). It takes and lets go by
 * the paper's rule, with an immediate vacuum, and does not know future faults. `memory`, as many bytes and
 * aligned as malloc's, the layout and `nominal` must outlive it. */
size_t wh_rehearsal_ahead_bytes(const wh_layout_t *layout);
void wh_rehearsal_look_ahead(wh_rehearsal_t *rehearsal, const wh_layout_t *layout, wh_nominal_t *nominal,
                             void *memory);

/* Ends the rehearsal, if one goes on: the track is back where it was. */
void wh_rehearsal_end(wh_rehearsal_t *rehearsal, wh_track_t *track);

/* Frees the planned segments. */
void wh_rehearsal_free(wh_rehearsal_t *rehearsal);

#endif
