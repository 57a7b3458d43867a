/* A cell whose axes and valves somebody outside of the program drives: each slice's numbers go in, and the
 * simulator's state, its events in words and a verdict come out.
 *
 * Host code: nothing is allocated after opening.
 */
#ifndef WH_LOOP_PLANT_H
#define WH_LOOP_PLANT_H

#include "../link/sim_process.h"

#define WH_PLANT_TEXT 400

/* An axis moves faster than its limit if it is beyond this share of what the limit lets it go. */
#define WH_PLANT_JUMP 1.02

/* Counts since opening. */
typedef struct {
    uint64_t refused;          /* slices whose numbers were not taken: the cell held the last ones */
    uint64_t jumps;            /* slices in which an axis went farther than its speed allows */
    uint64_t complaints;       /* events by which the cell complains: record/record.h */
    wh_event_kind_t complaint; /* the last of them */
    uint64_t events[WH_EVENT_KINDS];
    uint64_t jammed, missed; /* by edge grips; like an event, each is heard */
} wh_plant_found_t;

/* Must not be moved once opened. */
typedef struct {
    const wh_layout_t *layout;
    wh_sim_process_t *simulation;
    wh_link_identity_t identity;
    wh_command_t command;     /* of the next slice */
    wh_machine_cache_t cache; /* of its axes */
    bool is_driven;           /* its numbers have come; before, the axes are at home and all valves closed */
    int64_t since;            /* slices since its numbers came */
    wh_plant_found_t found;
    wh_grip_phase_t grips[WH_GRIPPERS]; /* of the last slice */
    /* Takes each event in words, without a line end; may be null. */
    void (*heard)(void *user, int64_t utime, const char *text, bool is_complaint);
    void *heard_user;
} wh_plant_t;

/* The simulation must be open, not listening, and outlive the plant. */
void wh_plant_open(wh_plant_t *plant, wh_sim_process_t *simulation);

/* Sets the axes (mm, degrees, as the layout's machine has them) and the valves (bit g: the vacuum of gripper
 * g is on) of the next slice. Not finite, or beyond an axis's travel: they are not taken, which is counted,
 * and `text` says why. A jump is taken, and counted; `text` says it. Otherwise `text` is empty. */
wh_status_t wh_plant_drive(wh_plant_t *plant, const double axes[], uint32_t valves, char text[WH_PLANT_TEXT]);

/* Likewise in the library's units, mm and rad. */
wh_status_t wh_plant_move(wh_plant_t *plant, const wh_real_t q[], uint32_t valves, char text[WH_PLANT_TEXT]);

/* Plays the next slice, with the last numbers that were taken, publishes it, and tells its events. Returns
 * the simulator's status: that of a refusal leaves the slice unplayed. */
wh_status_t wh_plant_step(wh_plant_t *plant);

/* Tells those who listen and record that the run is over, and how it ended; `reason` may be null. */
void wh_plant_tell_over(wh_plant_t *plant, bool passed, const char *reason);

/* The number of the last slice; 0: none yet. */
static inline int64_t wh_plant_slice(const wh_plant_t *plant) {
    return plant->simulation->server.seq;
}

/* An axis's number as board and logs have it, mm or degrees, from the library's; and back. */
double wh_plant_axis_out(const wh_layout_t *layout, size_t axis, wh_real_t value);
wh_real_t wh_plant_axis_in(const wh_layout_t *layout, size_t axis, double value);

#endif
