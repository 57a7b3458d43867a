/* An example: the firmware of an edge gripper, with a plunger that a valve drives and three switches along its
 * way. Nothing in it depends on Waferhand: put your own firmware in its place. */
#ifndef EDGE_GRIPPER_H
#define EDGE_GRIPPER_H

#include <stdbool.h>

/* The hardware. The firmware writes `closes`, the machine writes the switches. Each is on while the plunger is
 * in its window, also while it only passes through. */
typedef struct {
    bool closes;
    bool retracted, gripped, overtravel;
} gripper_registers_t;

typedef enum {
    GRIPPER_BUSY,
    GRIPPER_READY,
    GRIPPER_JAMMED,  /* the plunger stands before the window: something is in its way */
    GRIPPER_MISSED,  /* it went through the window: there is no wafer */
    GRIPPER_NOT_OPEN /* it did not come back */
} gripper_answer_t;

typedef struct {
    gripper_registers_t *registers;
    gripper_answer_t answer;
    int ms, gripped_ms; /* since the command; and for how long the plunger has been in the window */
} edge_gripper_t;

void gripper_init(edge_gripper_t *gripper, gripper_registers_t *registers);

/* Commands: the answer comes with a later tick. */
void gripper_close(edge_gripper_t *gripper);
void gripper_open(edge_gripper_t *gripper);

/* Once a millisecond. */
void gripper_tick(edge_gripper_t *gripper);

#endif
