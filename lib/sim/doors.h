/* Doors as a simulator has them: where each wall truly is.
 *
 * A door follows its axis of the command. If a fault kept it from there it comes after, at most as fast as
 * the door goes. DOOR_STUCK keeps it where it is, COMMAND_LOST all doors, and DOOR_SLOW lets it go at most so
 * many mm/s. No wafer depends on a door: it is in the way of collision checks, and of whoever waits for it.
 *
 * A simulator has doors after wh_simulator_set_doors (simulator.h). A firmware that does not call it does not
 * link them. No heap; all functions are reentrant.
 */
#ifndef WH_SIM_DOORS_H
#define WH_SIM_DOORS_H

#include "faults.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(doors);

/* The doors of a machine, which must outlive it: those of `doors`, with the axes from `first` on. */
typedef struct {
    const wh_door_t *doors;
    size_t count, first;
} wh_door_set_t;

/* The doors after the last slice. */
typedef struct {
    int32_t count;          /* 0 to WH_DOORS; 0: there are none */
    wh_real_t at[WH_DOORS]; /* of their axes, mm; 0 beyond the count */
} wh_doors_t;

/* The doors of a machine as a set. */
wh_door_set_t wh_door_set(const wh_machine_t *machine) WH_SYMBOL(wh_door_set);

/* The doors at home. */
void wh_doors_start(const wh_door_set_t *set, wh_doors_t *doors) WH_SYMBOL(wh_doors_start);

/* A slice of `slice_s` seconds: `axes` are the command's, `axis_count` of them; if a door's is not among
 * them it stands. No argument may be null. Cost: linear in doors times faults. */
void wh_doors_step(const wh_door_set_t *set, const wh_faults_t *faults, const wh_real_t axes[],
                   size_t axis_count, wh_real_t slice_s, wh_doors_t *doors) WH_SYMBOL(wh_doors_step);

/* Continues a hash (math/hash.h) with what does not change: how far each door goes, and how fast. */
uint64_t wh_door_set_hash(const wh_door_set_t *set, uint64_t hash) WH_SYMBOL(wh_door_set_hash);

/* How a simulator reaches the functions above, so that one without doors does not link them. */
typedef struct {
    /* wh_doors_step of a wh_simulator_t by a wh_command_t */
    void (*step)(void *simulator, const void *command);
    uint64_t (*hash)(const wh_door_set_t *set, uint64_t hash);
} wh_doors_calls_t;

WH_HEADER_END

#endif
