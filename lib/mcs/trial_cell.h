/* A trial's cell: what a layout describes, with the errors that the trial has drawn.
 *
 * Motion control goes by the layout, the simulator by this cell: stations, with the wafers in them, stand
 * beside where they were taught, wafers lie beside their places and have rims of their own, beams stand
 * beside where they are taken to be and latch late, valves and vacuum act late. Of several robots each was
 * taught a station by itself: that stands where the layout has it, only turned, and motion control goes
 * where the robot was taught it, wh_trial_cell_teach. Each trial has noise of its own in its edge sensors
 * and beams, but for errors that are given by name: these change what they name alone, and leave noise as
 * a run without errors has it.
 */
#ifndef WH_MCS_TRIAL_CELL_H
#define WH_MCS_TRIAL_CELL_H

#include "../layout/layout.h"
#include "../sim/simulator.h"

/* So many slices back it is remembered what the valves were told: a power of two above
 * WH_STUDY_LAG_SLICES. */
#define WH_TRIAL_CELL_PAST 8192

/* Room for what a trial's cell has of its own: of the layout's stations and wafers. */
typedef struct {
    wh_station_t *places;
    wh_wafer_t *start;
    wh_rim_t *rims;
    const wh_rim_t **rim_of; /* by wafer: one of `rims`, or the layout's */
    wh_edge_wafer_t *edge_wafers;
    wh_pose_t *supports; /* wh_layout_count_supports of them */
} wh_trial_room_t;

/* `layout` shares all but places, start, rims, edge_wafers, supports, machine, physics and cell with the
 * layout that it was made of. */
typedef struct {
    wh_trial_t trial;
    wh_layout_t layout;
    bool chucks_moved;                /* a gripper on a chuck is elsewhere than the layout has it */
    int64_t lag[WH_GRIPPERS];         /* slices that the gripper's valve acts late */
    uint8_t told[WH_TRIAL_CELL_PAST]; /* bit g of entry n: gripper g's valve was told to close in slice n */
} wh_trial_cell_t;

/* Fills in the cell of a trial. The arrays of `room`, and `layout`, which has `errors`, must outlive it. The
 * collision world still is the layout's: see wh_layout_read_trial_world. Deterministic: the same trial gives
 * the same bits. Cost: linear in stations and wafers. */
void wh_trial_cell_fill(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_trial_t *trial,
                        const wh_trial_room_t *room);

/* Moves a slot by `aside`, in base, mm. The blade of an arm without a wrist still points along the arm, whose
 * rail stands at `rail`. */
void wh_taught_move(const wh_chain_t *chain, double rail, const wh_vec3_t *aside, wh_pose_t *base_from_slot);

/* How far beside where the layout has it the trial draws that a robot was taught a station, in base, mm; zero
 * of a robot alone, for which the station stands elsewhere instead. */
wh_vec3_t wh_trial_cell_aside(const wh_trial_cell_t *trial_cell, size_t station, size_t robot);

/* Moves a slot of the station, as motion control takes it, by that. */
void wh_trial_cell_teach(const wh_trial_cell_t *trial_cell, size_t station, size_t robot, double rail,
                         wh_pose_t *base_from_slot);

/* Replaces what the valves are told in slice `command->seq` by what they do, late. To be called for each
 * slice in turn, from 1. */
void wh_trial_cell_delay(wh_trial_cell_t *trial_cell, wh_command_t *command);

#endif
