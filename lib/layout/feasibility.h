/* Finds what is wrong with a cell before anything moves: the judgement of `waferhand layout`.
 *
 * The robot stands at home; the wafers lie where the layout puts them. Lengths in mm.
 */
#ifndef WH_LAYOUT_FEASIBILITY_H
#define WH_LAYOUT_FEASIBILITY_H

#include "layout.h"

typedef enum {
    WH_FINDING_CONTACT, /* two parts overlap that must not */
    WH_FINDING_REACH,   /* an axis does not reach a slot, or the start of the way into it */
    WH_FINDING_LINKS,   /* the arm's two links do not reach the wrist there */
    WH_FINDING_WAFER,   /* a wafer lies in no slot */
    WH_FINDING_ENTRY,   /* the blade does not fit between two wafers */
    WH_FINDING_LEDGES   /* the blade does not fit between the ledges, or beside the chuck */
} wh_finding_kind_t;

typedef struct {
    wh_finding_kind_t kind;
    char text[512];
    int32_t parts[2]; /* the two that are in contact; else WH_NONE */
    int32_t station;  /* or WH_NONE */
} wh_finding_t;

/* The room around the blade that serves a station, when it has entered as far as the slot for a GET. Measured
 * between the parts, tilt included; 0 if they touch or overlap. */
typedef struct {
    size_t wafers; /* how many the layout puts here */
    bool has_above, has_below, has_beside;
    wh_real_t above;  /* to the wafer in the slot */
    wh_real_t below;  /* to the wafer one slot lower; unknown for a single slot */
    wh_real_t beside; /* at the slot's height: to its ledges, or to the prealigner's chuck */
} wh_entry_t;

typedef struct {
    const wh_layout_t *layout;
    bool has_parts; /* false: too many parts; only reach and wafers were checked */
    wh_pose_t base_from_effector, base_from_grippers[WH_GRIPPERS]; /* at home */
    wh_pose_t base_from_arm[WH_ARM_BODIES];
    wh_entry_t *entries; /* by station */
    wh_finding_t *findings;
    size_t count, capacity;
} wh_feasibility_t;

/* Checks all of it. The caller frees the result. Ends the program if out of memory. Cost: n log n in parts
 * and wafers, and wafers times stations. */
void wh_feasibility(wh_feasibility_t *check, const wh_layout_t *layout);
void wh_feasibility_free(wh_feasibility_t *check);

/* The kind in one word, such as "contact": a constant. */
const char *wh_finding_name(wh_finding_kind_t kind);

/* base_from_part of any part, wafers included, with the robot at home and the wafers where the layout puts
 * them. */
wh_pose_t wh_feasibility_place(const wh_feasibility_t *check, int32_t part);

#endif
