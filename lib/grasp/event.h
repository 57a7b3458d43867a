/* Events: the results of a step, with the values that explain them. */
#ifndef WH_GRASP_EVENT_H
#define WH_GRASP_EVENT_H

#include "face.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(event);

/* A step of the grasp table yields at most this many events for each of its grippers. */
#define WH_EVENTS_PER_GRIPPER 4

typedef enum WH_FOUR_BYTES {
    /* An open gripper took a free wafer. `measured` has the values that made it ready. */
    WH_EVENT_PICKED,
    /* The gripper's valve closed: its wafer stays where it is. `measured` compares the wafer with it. */
    WH_EVENT_RELEASED,
    /* In one step `other` released the wafer and `gripper` took it; this replaces a release and a pick. */
    WH_EVENT_HANDED_OVER,
    /* A free wafer came into the neighbourhood of an open, empty gripper and left it again, or the valve
     * closed, without a pick. The gripper follows one wafer at a time: the free one in its neighbourhood with
     * the smallest |dr_proj_z|, then the lowest index, in the first slice that has one. It follows no other
     * until this one is out of the neighbourhood, taken, or placed elsewhere by hand. `measured` is the
     * closest approach, of slice `measured_slice`: where (dr_proj_z / eps_projz)^2 +
     * (|dr_proj_xy| / eps_projxy)^2 was smallest; tilt does not count. With swept checking it may lie between
     * two slices, and is then judged by 0.998 eps_projz, as a swept pick is. A wafer is then near in a slice
     * if it was so at its closest instant there, and of several the one with the smallest |dr_proj_z| at
     * its own closest instant is followed. One that came and went within a slice is reported in that
     * slice. Not reported when another gripper took that wafer, or this one another wafer, meanwhile. */
    WH_EVENT_NEAR_MISS,
    /* An open, empty gripper was ready on a wafer that `other` held; of several, the wafer with the
     * smallest |dr_proj_z|, then the lowest index. It is reported once, when it ends: `measured` and
     * `measured_slice` are of its beginning. It is not reported if the wafer then passes to another holder,
     * this gripper or a third one, because the hand-over says enough. */
    WH_EVENT_CONTESTED,
    /* The step was refused and nothing changed: `status` gives the reason; `gripper` is the index of the
     * wrong input. */
    WH_EVENT_BAD_INPUT,
    /* From the cell, with the release and its values: no support is under the wafer, which is `height` mm
     * above the next thing below (negative: below base's z = 0 and above no slot). */
    WH_EVENT_RELEASED_UNSUPPORTED,
    /* From the cell, with the release and its values: wafer `other` lies in the same slot. Each wafer lies
     * in one slot, the nearest of all stations. Where stations overlap, two wafers that collide may lie in
     * two slots; this event does not come then. */
    WH_EVENT_SLOT_OCCUPIED,
    /* From the cell, with the release and its values, or with those of a chuck's hand-over: the wafer lies
     * in a slot or on a chuck, but `value` mm from its centre, which is above `limit`. */
    WH_EVENT_PLACED_OFF_CENTRE,
    /* The wafer lies there, but tilted against it by `value` rad, which is above `limit`. */
    WH_EVENT_PLACED_ASKEW,
    /* From the cell: the wafer was released above its support and sank onto it, with its centre `value` mm
     * lower. */
    WH_EVENT_SETTLED,
    /* From the collision check: parts[0] and parts[1] touch each other where they must not; `at` is the
     * place. */
    WH_EVENT_HIT,
    /* From the collision check: it is undecided whether parts[0] and parts[1] touch. Without parts[1] too
     * many parts are near: `value`; `limit` can be checked. */
    WH_EVENT_UNDECIDED,
    /* From the collision check: the gap of a watched pair, `value` mm, fell below the `limit` that the layout
     * sets. */
    WH_EVENT_TOO_CLOSE,
    /* The gripper's motion requires more acceleration than its pads can hold, mm/s^2: `value` against
     * `limit`. */
    WH_EVENT_SLIPPED,
    /* The vacuum under a held wafer fell below the sensor's threshold: `value` is its share of full vacuum,
     * 0 to 1. */
    WH_EVENT_VACUUM_LOST,
    /* An injected fault begins or ends to act; parts[0] is its index, parts[1] its kind (sim/faults.h). */
    WH_EVENT_FAULT_ARMED,
    WH_EVENT_FAULT_CLEARED,
    /* From the cell: the gripper took the wafer that it held through the ledges of a slot, or through a
     * chuck. After that its face's centre is `value` mm below that plane: more than `limit`, eps_projz, if it
     * went down, at most `limit`, twice eps_projz, or above the plane (negative), if it went up. `at` is the
     * wafer's place in base. Reported once, in the slice in which it passes. With `other` it went through
     * that wafer, or the empty blade did if `wafer` is WH_NONE: then it is `value` mm over that one's back
     * face now, negative below it, and `limit` is 0. */
    WH_EVENT_PUSHED_THROUGH
} wh_event_kind_t;

/* How many kinds there are. */
#define WH_EVENT_KINDS 19

typedef struct {
    wh_event_kind_t kind;
    wh_face_t face;          /* the wafer's face for `measured`; WH_FACE_BACK except for events of grips.h */
    uint64_t slice;          /* number of the step in which it is reported; the first step is 1 */
    uint64_t measured_slice; /* number of the step whose values `measured` holds */
    int32_t wafer;           /* index from 0, or WH_NONE */
    int32_t gripper;         /* index from 0, or WH_NONE */
    int32_t other;           /* a second gripper or wafer if the kind has one, otherwise WH_NONE */
    wh_status_t status;      /* WH_OK except for WH_EVENT_BAD_INPUT */
    wh_real_t height;        /* mm; 0 if the kind has none */
    wh_real_t value, limit;  /* the value found and its limit; 0 if the kind has none */
    int32_t parts[2];        /* parts of the collision world, or a fault's index and kind; else WH_NONE */
    wh_vec3_t at;            /* a contact's place in base, mm; 0 if the kind has none */
    wh_proximity_t measured; /* all zero if the kind has none */
} wh_event_t;

/* The caller's array of events: a step sets `count` and writes events[0 .. count-1]. */
typedef struct {
    wh_event_t *events;
    size_t capacity, count;
} wh_event_list_t;

/* The kind's name in lower case, such as "handed_over": a constant string, never null. */
const char *wh_event_name(wh_event_kind_t kind) WH_SYMBOL(wh_event_name);

WH_HEADER_END

#endif
