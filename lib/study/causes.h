/* The causes that a study draws: each error whose width is not 0, one by one. */
#ifndef WH_STUDY_CAUSES_H
#define WH_STUDY_CAUSES_H

#include "../layout/layout.h"

typedef enum {
    WH_CAUSE_WAFER,
    WH_CAUSE_STATION,
    WH_CAUSE_VALVE,
    WH_CAUSE_VACUUM,
    WH_CAUSE_RIM,
    WH_CAUSE_BEAM,
    WH_CAUSE_PROCESS,
    WH_CAUSE_DEBOUNCE,
    WH_CAUSE_PORT
} wh_cause_kind_t;

typedef struct {
    wh_cause_kind_t kind;
    size_t index; /* of the wafer, station, gripper or beam */
    /* For a displacement of a wafer or station: x, y, z, then the turns about them; for a rim a
     * wh_rim_draw_t, for a beam a wh_beam_draw_t; for a load port its step. */
    size_t component;
    int32_t robot; /* with several robots, the one whose taught place is off; else WH_NONE */
    double width;  /* mm, degrees, s; a share has no unit */
} wh_cause_t;

/* The causes of a layout, in the order of `kind`, `index` and `component`. To be freed. Memory that runs out
 * ends the program. */
wh_cause_t *wh_causes_of(const wh_layout_t *layout, size_t *count);

/* Fills in a trial's draw of each: mm, degrees, s. Cost: about 70 ns each. */
void wh_causes_draw(const wh_cause_t causes[], size_t count, const wh_layout_t *layout,
                    const wh_trial_t *trial, double drawn[]);

/* The name of the drawn error, such as "dx", "tilt_x", "yaw", "valve", "vacuum", "debounce", "notch_depth" or
 * "late", and its unit: "mm", "deg", "s" or "". Both are constant texts. */
const char *wh_cause_what(const wh_cause_t *cause);
const char *wh_cause_unit(const wh_cause_t *cause);

/* True if the draw may be below 0. */
bool wh_cause_has_sign(const wh_cause_t *cause);

/* The robot's name; null: the error belongs to no single robot. */
const char *wh_cause_robot(const wh_cause_t *cause, const wh_layout_t *layout);

/* The owner of the error: the name of the wafer, station, gripper or beam; null for the vacuum, which belongs
 * to all grippers. */
const char *wh_cause_of(const wh_cause_t *cause, const wh_layout_t *layout);

#endif
