/* The heading of a blade on an arm without a wrist: straight away from theta's axis. */
#ifndef WH_LAYOUT_ALONG_ARM_H
#define WH_LAYOUT_ALONG_ARM_H

#include "layout.h"

/* The heading, rad in base, of such an arm over a point of base. `rail` is the position of its rail, mm. */
double wh_along_arm(const wh_chain_t *chain, double rail, const wh_vec3_t *at);

/* Turns the ways in to level stations onto that heading if they miss it by 0.01 degrees or less, as places
 * rounded to micrometres do. It turns the station's frame, or the robot's own way in. A way in that the arm
 * can already take keeps its bits. Call it once stations are read, before anything lies in them. */
void wh_layout_turn_along_arms(wh_layout_t *layout);

#endif
