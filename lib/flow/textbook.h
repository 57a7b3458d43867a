/* The textbook's steady cycle of a flow, where a closed form holds: one robot, one route without locks and
 * doors, by rule backward or swap. It is beside the cycle that is played, to be compared; nothing depends on
 * it.
 *
 * Steps 1 to n of the route process; wafers come from step 0 and end in step n + 1. g is a pick, q a place, s
 * a swap, v a move, p a process, c the clean after each wafer, m the places of a step, z those that stay
 * empty.
 *   one arm, times alike everywhere: the largest of (n+1)(g+q+2v), (p+c+g+q)/m, (p+2g+2q+3v)/(m-z), and
 *     over sets A of steps without neighbours ((n+1-2|A|)(g+q+2v) + sum over A of g+q+v+c) / (1 + sum of z)
 *   one arm, m = 1, c = z = 0: the largest of the robot's round by its own times, and each place's
 *   two arms with swap, c = z = 0: the largest of (p+s)/m, and the robot's round (m > 1: times alike) */
#ifndef WH_FLOW_TEXTBOOK_H
#define WH_FLOW_TEXTBOOK_H

#include "plan.h"

typedef struct {
    double cycle_us; /* of a wafer; below 0: no closed form holds */
    int32_t step;    /* of the route, whose places limit it; 0: the robot does */
    const char *why; /* null, or why no closed form holds; never to be freed */
} wh_flow_textbook_t;

/* The plan must be finished. Cost: 2^n for n steps with cleans, of which up to 16 are looked at. */
wh_flow_textbook_t wh_flow_textbook(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan);

#endif
