/* A trial's cell: the layout's cell with the errors that the trial has drawn.
 *
 * Motion control uses the layout, the simulator uses this cell. Stations, with the wafers in them, stand
 * beside their taught places. Wafers lie beside their places and have their own rims. Beams stand beside
 * their assumed places and latch late; valves and vacuum act late. With several robots each robot was
 * taught a station separately: the station stands where the layout has it, only turned, and motion control
 * goes where the robot was taught it, see wh_trial_cell_teach. Each trial has its own noise in its edge
 * sensors and beams. But errors given by name change only what they name; the noise is then as in a run
 * without errors.
 */
#ifndef WH_TRIAL_TRIAL_CELL_H
#define WH_TRIAL_TRIAL_CELL_H

#include "../layout/layout.h"
#include "../sim/simulator.h"

/* The slices for which the valves' commands are remembered: a power of two above
 * WH_STUDY_LAG_SLICES. */
#define WH_TRIAL_CELL_PAST 8192

/* Room for the trial's own stations and wafers. */
typedef struct {
    wh_station_t *places;
    wh_wafer_t *start;
    wh_rim_t *rims;
    const wh_rim_t **rim_of; /* by wafer: one of `rims`, or the layout's */
    wh_edge_wafer_t *edge_wafers;
    wh_pose_t *supports; /* wh_layout_count_supports of them */
} wh_trial_room_t;

/* `layout` shares everything except places, start, rims, edge_wafers, supports, machine, physics and
 * cell with the layout that it was made from. */
typedef struct {
    wh_trial_t trial;
    wh_layout_t layout;
    bool chucks_moved;                /* a gripper on a chuck is not where the layout has it */
    int64_t lag[WH_GRIPPERS];         /* the delay of the gripper's valve, in slices */
    uint8_t told[WH_TRIAL_CELL_PAST]; /* bit g of entry n: gripper g's valve was told to close in slice n */
} wh_trial_cell_t;

/* Fills in the cell of a trial. The arrays of `room`, and `layout`, which has `errors`, must outlive it. The
 * collision world still is the layout's: see wh_layout_read_trial_world. Deterministic: the same trial gives
 * the same bits. Cost: linear in stations and wafers. */
void wh_trial_cell_fill(wh_trial_cell_t *trial_cell, const wh_layout_t *layout, const wh_trial_t *trial,
                        const wh_trial_room_t *room);

/* Moves a wafer in its slot as it was drawn. */
void wh_trial_cell_displace(const wh_displacement_t *drawn, wh_pose_t *slot_from_wafer);

/* Moves a slot by `aside`, in base, mm. The blade of an arm without a wrist still points along the arm, whose
 * rail stands at `rail`. */
void wh_taught_move(const wh_chain_t *chain, double rail, const wh_vec3_t *aside, wh_pose_t *base_from_slot);

/* The drawn offset, in base, mm, of a station as a robot was taught it from its place in the layout. Zero for
 * a single robot: the station itself is then moved. */
wh_vec3_t wh_trial_cell_aside(const wh_trial_cell_t *trial_cell, size_t station, size_t robot);

/* Moves a slot of the station, as motion control believes it, by that offset. */
void wh_trial_cell_teach(const wh_trial_cell_t *trial_cell, size_t station, size_t robot, double rail,
                         wh_pose_t *base_from_slot);

/* Each station of a tool of times alone processes as long as the trial draws. To be called once, before
 * anything is made from the layout, which has `errors`. */
void wh_trial_draw_tool(const wh_layout_t *layout, const wh_trial_t *trial);

/* Replaces the valves' commands in slice `command->seq` by the delayed ones. Call it for each slice in
 * order, from 1. */
void wh_trial_cell_delay(wh_trial_cell_t *trial_cell, wh_command_t *command);

#endif
