/* The doors of a simulator: the true position of each wall.
 *
 * A door follows its axis in the command. If a fault kept it from there, it follows later, at most at the
 * door's speed. DOOR_STUCK keeps one door in place, COMMAND_LOST all doors, and DOOR_SLOW limits a door's
 * speed in mm/s. No wafer depends on a door. It matters to collision checks, and to commands that wait for
 * it.
 *
 * A simulator has doors after wh_simulator_set_doors (simulator.h). A firmware that does not call it does
 * not link them. It uses no heap; all functions are reentrant.
 */
#ifndef WH_SIM_DOORS_H
#define WH_SIM_DOORS_H

#include "faults.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(doors);

/* The doors of a machine, which must outlive it: those in `doors`, with the axes from `first` on. */
typedef struct {
    const wh_door_t *doors;
    size_t count, first;
} wh_door_set_t;

/* The doors after the last slice. */
typedef struct {
    int32_t count;          /* 0 to WH_DOORS; 0: there are none */
    wh_real_t at[WH_DOORS]; /* positions of their axes, mm; 0 after the count */
} wh_doors_t;

/* The doors of a machine as a set. */
wh_door_set_t wh_door_set(const wh_machine_t *machine) WH_SYMBOL(wh_door_set);

/* The doors at home. */
void wh_doors_start(const wh_door_set_t *set, wh_doors_t *doors) WH_SYMBOL(wh_doors_start);

/* A slice of `slice_s` seconds: `axes` are the command's, `axis_count` of them; a door whose axis is not
 * among them stands still. No argument may be null. Cost: linear in doors times faults. */
void wh_doors_step(const wh_door_set_t *set, const wh_faults_t *faults, const wh_real_t axes[],
                   size_t axis_count, wh_real_t slice_s, wh_doors_t *doors) WH_SYMBOL(wh_doors_step);

/* Continues a hash (math/hash.h) with the fixed values: each door's travel and speed. */
uint64_t wh_door_set_hash(const wh_door_set_t *set, uint64_t hash) WH_SYMBOL(wh_door_set_hash);

/* A simulator calls the functions above through these pointers, so that one without doors does not link
 * them. */
typedef struct {
    /* wh_doors_step of a wh_simulator_t by a wh_command_t */
    void (*step)(void *simulator, const void *command);
    uint64_t (*hash)(const wh_door_set_t *set, uint64_t hash);
} wh_doors_calls_t;

WH_HEADER_END

#endif
