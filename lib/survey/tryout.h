/* A tryout plays GET and PUT at a slot before any run, in a cell that is full of wafers.
 *
 * `waferhand layout` uses it. The commands, the simulator with its vacuum, and the collision check are those
 * of a run, so there is no separate rule for a run's answer. The robot begins in front of the slot; its way
 * from elsewhere is not checked. A layout's wafers lie where it puts them; all other slots of a taught
 * station have one in the middle. Injected faults are left out.
 *
 * After a GET the wafer's height and tilt on the blade depend on its station. So each station's GET can
 * decide the result of a PUT elsewhere.
 */
#ifndef WH_SURVEY_TRYOUT_H
#define WH_SURVEY_TRYOUT_H

#include "../mcs/mcs.h"
#include "../sim/simulator.h"

/* The most wafers beside those of the station itself. If there are more, only the station's own are
 * there. */
#define WH_TRYOUT_WAFERS 1000

/* The most slices that GET and PUT at one slot may take. */
#define WH_TRYOUT_SLICES 1000000

/* The most slices of all tryouts; after them no command is begun. They take about half a minute. */
#define WH_TRYOUT_ALL_SLICES 10000000

/* How a station's wafer lies on the blade after a GET. */
typedef struct {
    bool is_known; /* a GET has taken one */
    wh_pose_t gripper_from_wafer;
} wh_tryout_lift_t;

typedef struct {
    wh_mcs_t *mcs;                /* plays; its layout is `full` meanwhile */
    const wh_layout_t *layout;    /* as read */
    wh_layout_t full;             /* the same, full of wafers */
    wh_edge_wafer_t *edge_wafers; /* those of `full` */
    int32_t station;              /* the station of those wafers; WH_NONE: not filled yet */
    wh_tryout_lift_t *lifts;      /* by station */
    int64_t slices;               /* played so far */
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_grasp_storage_t storage;
    wh_grips_room_t grips;
    wh_gripper_t grippers[WH_GRIPPERS];
    void *world_memory;
} wh_tryout_t;

/* Begins tryouts of this layout by this motion control, whose cell is set up. All three must outlive the
 * tryout. */
void wh_tryout_open(wh_tryout_t *tryout, wh_mcs_t *mcs, const wh_layout_t *layout);

/* Makes a new cell for the next command at a station: its wafers where they begin, valves closed, the axes
 * at `axes`. The wafer of slot `empty` of the station `to` is missing (0: none is). Not WH_OK: the cell is
 * not possible. Cost: n log n in wafers and the layout's parts. */
wh_status_t wh_tryout_begin(wh_tryout_t *tryout, size_t station, const wh_real_t axes[WH_AXES], size_t to,
                            int32_t empty);

/* The axes stand at `axes` from the next slice on; earlier complaints are forgotten. Before you look for the
 * next complaint, let the motion come to rest and call this again without axes (null). */
void wh_tryout_move(wh_tryout_t *tryout, const wh_real_t axes[WH_AXES]);

/* True if the cell had a complaint since the last wh_tryout_move. The first one is in `text`, or the first
 * contact if the first one is only too close. */
bool wh_tryout_complained(const wh_tryout_t *tryout, char *text, size_t size);

/* True if that complaint is a contact. */
bool wh_tryout_touched(const wh_tryout_t *tryout);

/* Notes how the station's wafer lies on its blade, if there is one. */
void wh_tryout_note_lift(wh_tryout_t *tryout, size_t station);

/* The number of slots of all taught stations. */
size_t wh_tryout_slots(const wh_tryout_t *tryout);

/* True if wafers of `from` lie on the blade that serves both stations in a new way: not like `to`'s own
 * wafers, nor like those of a station before `from`. For a chuck, which gets its wafers from others, true
 * also if they lie like its own. False if the way is not known for both, or there are more than
 * WH_TRYOUT_WAFERS slots. */
bool wh_tryout_is_new(const wh_tryout_t *tryout, size_t from, size_t to);

/* Ends the tryouts: motion control has the original layout again, and stands at home. */
void wh_tryout_end(wh_tryout_t *tryout);

void wh_tryout_close(wh_tryout_t *tryout);

#endif
