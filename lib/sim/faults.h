/* Injected faults: what goes wrong in a cell, and its begin and end.
 *
 * A fault occupies one of WH_FAULTS slots from the slice in which a command brings it, or from the start if
 * the layout has it. It acts in the slices with from <= seq < until, on the signals between command and
 * grasp table; or it moves a wafer once, when it begins:
 *
 *   NO_VACUUM       the gripper's pump is dead: the level falls to 0 and stays there
 *   SLOW_VACUUM     the level builds up with a time constant of `value` s, if that is slower than its own
 *   SENSOR_ON/_OFF  the sensor is on or off at any level
 *   LEAK            the level rises no higher than `value`, 0 to 1
 *   VALVE_STUCK     the gripper's valve stays as it was when the fault began
 *   AXIS_STOPPED    the axes that carry the gripper stand: it stays where it was
 *   COMMAND_LOST    all grippers, valves and doors stay as they were
 *   PLUNGER_STUCK   the edge grip's plunger stays in place; closed on a wafer it does not release it
 *   PLUNGER_SLOW    the plunger moves no faster than `value` mm/s
 *   WAFER_*         the wafer goes to base_from_wafer * offset: missing (out of the cell), shifted, tilted,
 *                   crossed; doubled: to base_from_other * offset, onto the wafer `other`
 *   DOOR_STUCK      the door stays in place
 *   DOOR_SLOW       the door moves at most at `value` mm/s
 *   BEAM_DARK/_LIT  the beam's signal is broken or free, whatever passes
 *   BEAM_LATE       its latches come `value` s later
 *   PROBE_CLOSED/_OPEN  the switch of the gripper's probe is closed or open, whatever it touches
 *   EDGE_SENSOR_STUCK   each sample of the chuck's edge sensor has the same part `value` of its pixels
 *   EDGE_SENSOR_LATE    the samples are taken `value` s later
 *   STATION_STUCK   what goes on in the station by itself stands; the simulator has no part in it
 *   STATION_SLOW    it takes `value` times as long
 *   E84_STUCK       a step of a load port's handshake, `other` from 1 to 5, stands, likewise
 *   E84_LATE        it takes `value` s longer
 *   WAFER_PLACED    the wafer goes to `offset` in base, and the fault is over: a carrier brings or takes it
 *   POWER_LOST, EMERGENCY_STOP, SERVO_ERROR  of a robot's own controller; the simulator has no part in them
 *
 * The wafer, or the one that it is doubled onto, may be held when its fault is due to begin. Then the fault
 * waits: it begins in the first slice after one in which nobody held them. When the fault ends, the wafer
 * goes back to its place before, unless it was taken or moved since. A wafer counts as taken if a gripper
 * held it for a slice, even if it was set down where the fault had put it. A wafer counts as moved if
 * wh_grasp_place put it elsewhere and it lies there when a later slice begins. A wafer that was put exactly
 * where a fault had put it counts as unmoved. If another fault has moved the wafer since, the wafer goes
 * back to its place before both when that other fault ends. A command must be valid even if a fault
 * overrules it. In the first slice of a run there is no earlier state: a stuck valve is closed, and axes
 * move.
 *
 * A beam or a switch gives a latch for each change of its signal, also when a fault causes the change at
 * its begin or end.
 *
 * It uses no heap; a wh_faults_t is a plain struct.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_fault_validate                64    192      24    104
 *     stack of wh_faults_validate               88    224      56    136
 *     stack of wh_faults_check                 112    240      72    152
 *     stack of wh_faults_take                   48     40      48     40
 *     stack of wh_faults_advance               176    264     140    168
 *     stack of wh_faults_overrule               80     64      72     56
 *     stack of wh_faults_of_vacuum              96     96      56     56
 *     stack of wh_faults_sensors                 4      8       0      8
 *     size of wh_fault_t                       136             80
 *     size of wh_faults_t                     5384           2952
 *     size of wh_fault_request_t               144             88
 */
#ifndef WH_SIM_FAULTS_H
#define WH_SIM_FAULTS_H

#include "../grasp/vacuum.h"
#include "../motion/machine.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(faults);

/* The most faults of a run at one time. */
#define WH_FAULTS 16
/* The greatest offset of a fault along each axis, mm. */
#define WH_FAULT_REACH WH_REAL(1e6)
/* No plunger is faster, mm/s (grasp/edge.h). */
#define WH_PLUNGER_FAST 10000
/* The most beams of a cell (latching.h). */
#define WH_BEAMS 16
/* The most stations and robots that a fault can name. */
#define WH_FAULT_STATIONS 1000
#define WH_FAULT_ROBOTS (WH_AXES / WH_ROBOT_AXES)
/* The steps of a load port's handshake. */
#define WH_FAULT_E84_STEPS 5
/* A fault that lasts until it is cleared. */
#define WH_FAULT_FOREVER INT64_MAX

typedef enum WH_FOUR_BYTES {
    WH_FAULT_NO_VACUUM,
    WH_FAULT_SLOW_VACUUM,
    WH_FAULT_SENSOR_ON,
    WH_FAULT_SENSOR_OFF,
    WH_FAULT_LEAK,
    WH_FAULT_VALVE_STUCK,
    WH_FAULT_AXIS_STOPPED,
    WH_FAULT_COMMAND_LOST,
    WH_FAULT_WAFER_MISSING, /* faults of wafers, from here to WAFER_TILTED */
    WH_FAULT_WAFER_DOUBLED,
    WH_FAULT_WAFER_CROSSED,
    WH_FAULT_WAFER_SHIFTED,
    WH_FAULT_WAFER_TILTED,
    WH_FAULT_PLUNGER_STUCK,
    WH_FAULT_PLUNGER_SLOW,
    WH_FAULT_DOOR_STUCK,
    WH_FAULT_DOOR_SLOW,
    WH_FAULT_BEAM_DARK,
    WH_FAULT_BEAM_LIT,
    WH_FAULT_BEAM_LATE,
    WH_FAULT_PROBE_CLOSED,
    WH_FAULT_PROBE_OPEN,
    WH_FAULT_EDGE_SENSOR_STUCK,
    WH_FAULT_EDGE_SENSOR_LATE,
    WH_FAULT_STATION_STUCK,
    WH_FAULT_STATION_SLOW,
    WH_FAULT_E84_STUCK,
    WH_FAULT_E84_LATE,
    WH_FAULT_WAFER_PLACED, /* no fault on purpose */
    WH_FAULT_POWER_LOST,   /* faults of controllers, from here on */
    WH_FAULT_EMERGENCY_STOP,
    WH_FAULT_SERVO_ERROR
} wh_fault_kind_t;

#define WH_FAULT_KINDS 32

typedef struct {
    wh_fault_kind_t kind;
    int32_t target; /* gripper, wafer, door, beam, station or robot; WH_NONE for COMMAND_LOST */
    int32_t other;  /* DOUBLED: the wafer underneath; E84_*: the step; otherwise WH_NONE */
    /* SLOW_VACUUM and E84_LATE: s, 0 to 3600; LEAK and EDGE_SENSOR_STUCK: 0 to 1; PLUNGER_SLOW and
     * DOOR_SLOW: mm/s, 0 to 1e4; BEAM_LATE and EDGE_SENSOR_LATE: s, 0 to 0.01 and 0.001; STATION_SLOW: 0 to
     * 1000; otherwise 0 */
    wh_real_t value;
    wh_pose_t offset;    /* of WAFER_*, up to WH_FAULT_REACH; otherwise the identity */
    int64_t from, until; /* slices, seq: 1 <= from, 0 <= until; WH_FAULT_FOREVER: until it is cleared */
} wh_fault_t;

/* The phases of a fault's life. */
typedef enum WH_FOUR_BYTES {
    WH_FAULT_FREE,
    WH_FAULT_WAITING,
    WH_FAULT_ACTING,
    WH_FAULT_OVER,
    WH_FAULT_TAKEN /* of WAFER_*: it acts, but its wafer was taken or moved since and will not go back */
} wh_fault_phase_t;

typedef struct {
    wh_fault_t fault; /* all zero while the slot is free */
    wh_fault_phase_t phase;
    wh_pose_t before, placed; /* of WAFER_* once it has acted: base_from_wafer before and after; else zero */
} wh_fault_slot_t;

typedef struct {
    wh_fault_slot_t slots[WH_FAULTS];
    size_t count; /* the slots up to the last one in use */
} wh_faults_t;

/* A fault that a command brings, and its slot. */
typedef struct {
    int32_t index;
    wh_fault_t fault;
} wh_fault_request_t;

/* The faults that began and ended in a slice: bit i for slot i. */
typedef struct {
    uint32_t armed, cleared;
} wh_fault_changes_t;

/* The kind's name as layouts and scripts spell it: no_vacuum to servo_error; wafer_placed, which these have
 * not; or "unknown". Never null. */
const char *wh_fault_name(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_name);

/* True if the kind is about a wafer. */
bool wh_fault_is_of_wafer(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_is_of_wafer);

/* True if the kind is about a door. */
bool wh_fault_is_of_door(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_is_of_door);

/* True if the kind is about a beam. */
bool wh_fault_is_of_beam(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_is_of_beam);

/* True if the kind is about what goes on in a station by itself. */
bool wh_fault_is_of_station(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_is_of_station);

/* True if the kind is about a robot's own controller. */
bool wh_fault_is_of_controller(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_is_of_controller);

/* The largest `value` that a fault of this kind may have; 0: the kind has none. */
wh_real_t wh_fault_most(wh_fault_kind_t kind) WH_SYMBOL(wh_fault_most);

/* A fault that acts in the slices from <= seq < until, ready to be taken or to be changed further. `target`
 * is a gripper, a wafer, a door, a beam, a station or a robot; COMMAND_LOST has none (WH_NONE replaces it).
 * `value` counts for kinds with a wh_fault_most; for others 0 replaces it. `other` is WH_NONE, the offset the
 * identity; that of WAFER_MISSING points 100 m down, out of every cell. The caller sets the other values that
 * the kind needs: `other` and `offset` of WAFER_DOUBLED, `offset` of WAFER_CROSSED, _SHIFTED, _TILTED and
 * _PLACED, `other` of E84_*.
 * Nothing is checked: see wh_fault_validate. The pump of gripper 0 is dead from the first slice on:
 *
 *     physics.faults[0] = wh_fault_make(WH_FAULT_NO_VACUUM, 0, 0, 1, WH_FAULT_FOREVER);
 *     physics.fault_count = 1; */
wh_fault_t wh_fault_make(wh_fault_kind_t kind, int32_t target, wh_real_t value, int64_t from, int64_t until)
    WH_SYMBOL(wh_fault_make);

/* Returns WH_OK, or the reason why a cell with these counts, WH_DOORS doors, WH_BEAMS beams and
 * WH_FAULT_STATIONS stations and WH_FAULT_ROBOTS robots cannot have the fault. WH_STATUS_NULL_ARGUMENT;
 * WH_STATUS_NOT_FINITE or
 * WH_STATUS_NOT_A_ROTATION for an offset that wh_pose_validate refuses; WH_STATUS_OUT_OF_RANGE for kind,
 * target, other, from or until, for a `value` out of its range or NaN, and for an offset beyond
 * WH_FAULT_REACH, or other than the identity if the kind is not about a wafer. A fault that never acts
 * (until <= from) is valid. Cost: wh_pose_validate. */
wh_status_t wh_fault_validate(const wh_fault_t *fault, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_fault_validate);

/* Validates whole slots, such as those of a received state: WH_OK, WH_STATUS_NULL_ARGUMENT or
 * WH_STATUS_OUT_OF_RANGE. Cost: three times wh_pose_validate for each slot up to `count` in use. */
wh_status_t wh_faults_validate(const wh_faults_t *faults, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_faults_validate);

/* Frees all slots. Cost: the struct's size in bytes written. */
void wh_faults_clear(wh_faults_t *faults) WH_SYMBOL(wh_faults_clear);

/* Checks that all requests can be taken. Each must be a valid fault, for a slot that is free or over, or
 * for the slot that has this very fault, which then gets a new `until`. No two may name one slot. Returns
 * WH_OK, WH_STATUS_NULL_ARGUMENT, WH_STATUS_OUT_OF_RANGE, or the status of wh_fault_validate. Past slices
 * are no error, because an `until` in the past ends a fault at once. A new fault with such an `until` is
 * over in the slice that takes it: it never acts, and no event reports it. A test that wants to detect this
 * compares `until` with the command's seq. Cost: wh_fault_validate for each request. */
wh_status_t wh_faults_check(const wh_faults_t *faults, const wh_fault_request_t requests[], size_t count,
                            size_t gripper_count, size_t wafer_count) WH_SYMBOL(wh_faults_check);

/* Takes requests that wh_faults_check has accepted. Nothing is checked. Cost: a copy of each. */
void wh_faults_take(wh_faults_t *faults, const wh_fault_request_t requests[], size_t count)
    WH_SYMBOL(wh_faults_take);

/* Begins and ends the faults that are due in slice `seq`; moves wafers of the table. Nothing is checked:
 * wh_faults_validate must accept the faults for this table. Cost: one test for each slot up to `count`; one
 * more for each that acts on a wafer; 36 products and wh_grasp_place for each wafer that is moved. */
wh_fault_changes_t wh_faults_advance(wh_faults_t *faults, wh_grasp_t *table, int64_t seq)
    WH_SYMBOL(wh_faults_advance);

/* The effect of the acting faults on a gripper's vacuum. Nothing is checked. Cost: one test for each slot
 * up to `count`, also for the two functions below. */
wh_vacuum_fault_t wh_faults_of_vacuum(const wh_faults_t *faults, size_t gripper)
    WH_SYMBOL(wh_faults_of_vacuum);

/* Makes stuck valves, stopped axes and lost commands overrule the inputs of a slice. `vacuum` has the valves
 * before; both arrays have an entry for each gripper of the table. */
void wh_faults_overrule(const wh_faults_t *faults, const wh_grasp_t *table, const wh_vacuum_t vacuum[],
                        wh_gripper_input_t inputs[]) WH_SYMBOL(wh_faults_overrule);

/* The acting fault of this kind and target, with the largest value if there are several; null: there is
 * none. Nothing is checked. Cost: one test for each slot up to `count`. */
const wh_fault_t *wh_faults_find(const wh_faults_t *faults, wh_fault_kind_t kind, int32_t target)
    WH_SYMBOL(wh_faults_find);

/* The speed to which the acting faults limit an edge grip's plunger, mm/s; 1e4 without one. Nothing is
 * checked. */
double wh_faults_plunger(const wh_faults_t *faults, size_t gripper) WH_SYMBOL(wh_faults_plunger);

/* The sensors' signals, given those of sensors without faults: bit g for gripper g, up to WH_GRIPPERS. */
uint32_t wh_faults_sensors(const wh_faults_t *faults, uint32_t sensors) WH_SYMBOL(wh_faults_sensors);

WH_HEADER_END

#endif
