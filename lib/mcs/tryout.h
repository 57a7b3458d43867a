/* A tryout: GET and PUT are played at a slot before any run, in a cell that is full of wafers.
 *
 * For `waferhand layout`. The commands, the simulator with its vacuum, and the check for collisions are those
 * of a run, so what a run would answer is not worked out by a rule beside it. The robot begins in front of
 * the slot, for nothing is said of its way from elsewhere. A layout's wafers lie where it puts them, all
 * other slots of a taught station have one in the middle. Faults on purpose are left out.
 *
 * A wafer that a GET has taken lies on the blade as its station has it lie there: at some height, and tilted
 * with it. So each station's GET can decide what becomes of a PUT elsewhere.
 */
#ifndef WH_MCS_TRYOUT_H
#define WH_MCS_TRYOUT_H

#include "../sim/simulator.h"
#include "mcs.h"

/* The most wafers beside those of the station itself. With more of them only its own are there. */
#define WH_TRYOUT_WAFERS 1000

/* The most slices that GET and PUT at one slot may take. */
#define WH_TRYOUT_SLICES 1000000

/* The most slices of all that is played; what comes after that is not begun. About half a minute. */
#define WH_TRYOUT_ALL_SLICES 10000000

/* How a station's wafer lies on the blade after a GET. */
typedef struct {
    bool is_known; /* a GET has taken one */
    wh_pose_t gripper_from_wafer;
} wh_tryout_lift_t;

typedef struct {
    wh_mcs_t *mcs;                /* plays; its layout is `full` meanwhile */
    const wh_layout_t *layout;    /* as it was read */
    wh_layout_t full;             /* the same, full of wafers */
    wh_edge_wafer_t *edge_wafers; /* those of `full` */
    int32_t station;              /* whose wafers those are; WH_NONE: not filled yet */
    wh_tryout_lift_t *lifts;      /* by station */
    int64_t slices;               /* played so far */
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_grasp_storage_t storage;
    wh_grips_room_t grips;
    wh_gripper_t grippers[WH_GRIPPERS];
    void *world_memory;
} wh_tryout_t;

/* All later tryouts are of this layout, by this motion control, whose cell is set up. All three must outlive
 * the tryout. */
void wh_tryout_open(wh_tryout_t *tryout, wh_mcs_t *mcs, const wh_layout_t *layout);

/* A new cell, its wafers where they begin, valves closed, with the axes there: for the next command at a
 * station. The wafer of slot `empty` of the station `to` is not there (0: it is). Not WH_OK: the cell cannot
 * be. Cost: n log n in wafers and the layout's parts. */
wh_status_t wh_tryout_begin(wh_tryout_t *tryout, size_t station, const wh_real_t axes[WH_AXES], size_t to,
                            int32_t empty);

/* The axes are there from the next slice on; what has been is forgotten. Before the next complaint is looked
 * for the motion must have come to rest, and this be called anew, without axes (null). */
void wh_tryout_move(wh_tryout_t *tryout, const wh_real_t axes[WH_AXES]);

/* True if the cell had a complaint since the last of these; the first one is in `text`, or the first contact
 * if that one is only too close. */
bool wh_tryout_complained(const wh_tryout_t *tryout, char *text, size_t size);

/* Notes how the station's wafer lies on its blade, if one does. */
void wh_tryout_note_lift(wh_tryout_t *tryout, size_t station);

/* The slots of all taught stations. */
size_t wh_tryout_slots(const wh_tryout_t *tryout);

/* True if wafers of `from` lie on the blade that serves both stations in a way that is not that of `to`'s
 * own, nor of a station before `from`; to a chuck, which has them handed over, also if it is its own. False
 * if that is not known of both, or there are more than WH_TRYOUT_WAFERS slots. */
bool wh_tryout_is_new(const wh_tryout_t *tryout, size_t from, size_t to);

/* Motion control has the layout again as it was read, and stands at home. */
void wh_tryout_end(wh_tryout_t *tryout);

void wh_tryout_close(wh_tryout_t *tryout);

#endif
