/* Vacuum under one gripper, with valve command, level and sensor kept separate.
 *
 * The level is a share of the full vacuum, 0 to 1. In each slice it moves towards a target by
 *
 *     level + (target - level) * dt / (tau + dt)
 *
 * (a first-order lag, integrated implicitly: stable and without overshoot for every dt and tau >= 0, no
 * exp; tau 0 reaches the target at once, and so does a level closer to it than 1e-4). With the valve closed
 * the target is 0. With the valve open it is 1 while a wafer is on the pads, and `idle` while they draw in
 * air. tau is `build` upwards and `vent` downwards.
 *
 * The valve's command and its effect are separate. An opened valve acts at once, because a wafer rests on
 * an open gripper whatever its level. A closed valve releases a held wafer when the level has fallen below
 * `release`. The sensor's switch turns on when the level reaches `on` and off when it falls below `off`. The
 * sensor tells a turn of its switch once the switch has stood for `debounce` further slices; a turn that does
 * not last that long is never told. With 0 it is told in its own slice.
 *
 * The calls in each slice, around a step of the grasp table (grasp/grasp.h):
 *
 *     input.valve = wh_vacuum_before(&config, &upset, command, holds_a_wafer, dt, &vacuum);
 *     wh_grasp_step(...);
 *     lost = wh_vacuum_after(&config, &upset, holds_a_wafer, dt, &vacuum);
 *
 * With the ideal config every valve acts as commanded, and the sensor shows whether a wafer is held.
 */
#ifndef WH_GRASP_VACUUM_H
#define WH_GRASP_VACUUM_H

#include "grasp.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(vacuum);

/* The most slices of a debounce: a minute of slices of 1 ms. */
#define WH_VACUUM_DEBOUNCE 60000

/* It must not change during a run. */
typedef struct {
    wh_real_t build, vent; /* time constants upwards and downwards, s, 0 to 3600 */
    wh_real_t idle;        /* level under an open valve with nothing on the pads, 0 to below `off` */
    wh_real_t on, off;     /* the sensor's thresholds, 0 < off <= on <= 1 */
    wh_real_t release;     /* below this a closed valve releases the wafer, above 0, up to 1 */
    int32_t debounce;      /* slices that a turn of the switch must last until it is told, 0 to
                            * WH_VACUUM_DEBOUNCE */
} wh_vacuum_config_t;

/* The faults of the vacuum at this time. */
typedef struct {
    wh_real_t full;  /* the level that can be reached, 0 to 1 */
    wh_real_t build; /* a slower time constant upwards, s; 0: none */
} wh_vacuum_fault_t;

/* One gripper's vacuum after the last slice. */
typedef struct {
    wh_real_t level; /* 0 to 1 */
    int32_t command; /* WH_VALVE_*: the command in force */
    bool on;         /* a sensor without fault tells that it is on */
    uint16_t waits;  /* slices for which its switch has not stood as it tells, up to `debounce`; 0: it does */
} wh_vacuum_t;

/* No lag, no delay, no debounce: the paper's gripper. */
wh_vacuum_config_t wh_vacuum_ideal(void) WH_SYMBOL(wh_vacuum_ideal);

/* Lags of 50 ms and 20 ms, idle 0.1, sensor on at 0.7 and off at 0.6, release at 0.3, no debounce. */
wh_vacuum_config_t wh_vacuum_delayed(void) WH_SYMBOL(wh_vacuum_delayed);

/* Returns WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_FINITE, or WH_STATUS_OUT_OF_RANGE for a value
 * outside the ranges above. */
wh_status_t wh_vacuum_validate(const wh_vacuum_config_t *config) WH_SYMBOL(wh_vacuum_validate);

/* No fault: 1 and 0. */
wh_vacuum_fault_t wh_vacuum_sound(void) WH_SYMBOL(wh_vacuum_sound);

/* Before the first slice: no vacuum, closed, off, and the switch is off. */
wh_vacuum_t wh_vacuum_start(void) WH_SYMBOL(wh_vacuum_start);

/* Takes a slice's command, lets the level fall if it is closed, and returns the valve's effect, for the
 * grasp step. A command that is no valid level is returned unchanged, so that the step refuses it; nothing
 * else changes. No other argument is checked; `dt` is the slice's length in s. Cost: a division. */
int32_t wh_vacuum_before(const wh_vacuum_config_t *config, const wh_vacuum_fault_t *upset, int32_t command,
                         bool holds, wh_real_t dt, wh_vacuum_t *vacuum) WH_SYMBOL(wh_vacuum_before);

/* Call it after the grasp step: it updates the level under an open valve, and the sensor. `holds`: a wafer
 * is on the pads now. Returns true when the sensor told that it turned off, under a wafer that the command
 * wants held. Nothing is checked. Cost: a division. */
bool wh_vacuum_after(const wh_vacuum_config_t *config, const wh_vacuum_fault_t *upset, bool holds,
                     wh_real_t dt, wh_vacuum_t *vacuum) WH_SYMBOL(wh_vacuum_after);

WH_HEADER_END

#endif
