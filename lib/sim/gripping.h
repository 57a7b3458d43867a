/* A simulator calls the grips other than vacuum (grasp/grips.h) through these pointers, so that one with
 * vacuum alone does not link them. A simulator has them after wh_simulator_set_grips (simulator.h). */
#ifndef WH_SIM_GRIPPING_H
#define WH_SIM_GRIPPING_H

#include "../grasp/grips.h"
#include "../grasp/hold.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(gripping);

typedef struct {
    /* wh_grips_step of this wh_simulator_t */
    wh_status_t (*step)(void *simulator, const wh_gripper_input_t inputs[], wh_event_list_t *list);
    /* called after a step: vacuum of the grippers that have none. Its level is 0; a sensor without fault is
     * on for a plunger that stands in its window gripped, and for a wafer on passive pads */
    void (*sense)(void *simulator);
    /* wh_carry_update of a gripper, by the cell's pads or by passive ones. It uses no pads for a wafer that
     * an edge grip holds, or that lies in its slot below pads that look down */
    bool (*carries)(void *simulator, size_t gripper, wh_hold_t *hold);
    /* wh_grips_complete of a state that this simulator may continue from, with these grippers */
    wh_status_t (*complete)(const void *simulator, const wh_gripper_t grippers[], wh_grip_state_t states[]);
    /* continues a hash with the fixed values: kinds, edge grips, thickness, shapes, supports */
    uint64_t (*hash)(const wh_grips_t *grips, uint64_t hash);
} wh_gripping_calls_t;

/* Continues a hash with all fixed values of the parts: kinds with their edge grips, shapes beside these,
 * and supports. */
uint64_t wh_gripping_hash(const wh_grips_parts_t *parts, size_t gripper_count, size_t wafer_count,
                          uint64_t hash) WH_SYMBOL(wh_gripping_hash);

WH_HEADER_END

#endif
