/* The edge sensor beside a chuck, sampled while the chuck turns.
 *
 * A command arms the sensor of one chuck. From sample number `first` on it takes `count` samples, each once
 * and in order, when the chuck's turn passes the angle at which the sample is due (align/sensing.h). The
 * encoder's steps lie within slices, so one turn gives equal samples in slices of any length. The exception
 * is the speed that the latency uses. Each state carries the samples of its own slice.
 *
 * The chuck's turn comes from its gripper's pose, so faults that stop an axis stop the sampling, too. Whole
 * turns are counted while the sensor is armed, for a chuck that turns by less than half a turn in a slice.
 *
 * A simulator has sensors after wh_simulator_set_scanning (simulator.h). A firmware that does not call it
 * does not link this file, nor lib/align.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_scanning_validate            280    272     256    392
 *     stack of wh_scanning_check                 8     32       8     32
 *     stack of wh_scanning_step               1264   1248    1296   1456
 *     stack of wh_scanning_hash                272    288     280    280
 *     size of wh_scan_t                        304            304
 *     size of wh_scanner_t                     336            288
 */
#ifndef WH_SIM_SCANNING_H
#define WH_SIM_SCANNING_H

#include "../align/sensing.h"
#include "../grasp/grasp.h"
#include "faults.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(scanning);

/* The most samples of a slice, and the highest speed of a chuck, rad/s. More of either ends the scan. */
#define WH_SCAN_SLICE 64
#define WH_SCAN_SPEED 100
/* The most turns of a scan, and the most turns from 0 at which it may begin. */
#define WH_SCAN_TURNS 10
#define WH_SCAN_REACH 1000
/* The greatest distance of a wafer above or below the chuck's plane at which its rim is seen, mm. */
#define WH_SCAN_GAP 10

typedef enum WH_FOUR_BYTES {
    WH_SCAN_KEEP, /* no order; a zeroed order is this */
    WH_SCAN_ARM,
    WH_SCAN_DISARM /* after it no sensor is armed, whatever the state was */
} wh_scan_order_kind_t;

/* The order of a command to the sensors. */
typedef struct {
    wh_scan_order_kind_t kind;
    int32_t gripper; /* ARM: the gripper of the chuck, which has a sensor */
    /* ARM: the number of samples, up to WH_SCAN_TURNS turns of them. Above 0 the chuck turns
     * counter-clockwise and their numbers rise from `first`; below 0 it turns clockwise and they fall. */
    int32_t count;
    int64_t first; /* ARM: within WH_SCAN_REACH turns. Whole turns do not matter to the chuck. */
} wh_scan_order_t;

/* A sensor at its place. */
typedef struct {
    wh_sensor_t sensor;
    int32_t gripper;             /* the chuck's gripper */
    uint64_t seed;               /* names the noise, with the scan's number */
    wh_pose_t base_from_station; /* of the chuck, at turn 0 */
} wh_scanner_t;

/* The fixed values of a run: the caller's arrays. */
typedef struct {
    const wh_scanner_t *scanners; /* at most one for each gripper; with none, no order is accepted */
    size_t scanner_count;
    const wh_rim_t *const *rims; /* for each wafer; several may share one */
} wh_scanning_t;

/* The scan after the last slice. All zero before the first. */
typedef struct {
    uint32_t number; /* how many scans have begun */
    bool armed;      /* false also if all samples are taken, or the scan has ended early */
    int32_t gripper, count;
    int64_t first;
    int32_t taken; /* so far, including the samples of this slice */
    double turn;   /* of the chuck, rad; 0 unless armed */
    int32_t sample_count;
    int32_t samples[WH_SCAN_SLICE]; /* of this slice: the last sample_count samples taken, then 0 */
} wh_scan_t;

/* Returns WH_OK, or the error for a cell with these counts: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY
 * for more scanners than grippers; the status of wh_pose_validate, wh_sensor_validate and wh_rim_validate;
 * and WH_STATUS_OUT_OF_RANGE for a gripper that does not exist, or that has two. Without scanners rims are
 * ignored. Cost: wh_rim_validate for each wafer. */
wh_status_t wh_scanning_validate(const wh_scanning_t *scanning, size_t gripper_count, size_t wafer_count)
    WH_SYMBOL(wh_scanning_validate);

/* Returns WH_OK for an order that can be accepted, otherwise WH_STATUS_OUT_OF_RANGE. No argument may be
 * null. */
wh_status_t wh_scanning_check(const wh_scanning_t *scanning, const wh_scan_order_t *order)
    WH_SYMBOL(wh_scanning_check);

/* Call it after a slice of `slice_s` seconds. It takes the samples that the chuck has passed in the slice,
 * then the order, which wh_scanning_check has accepted. So a sensor that is armed in this slice samples
 * from the slice's end on. The sensor sees the wafer that the chuck's gripper holds. Otherwise it sees the
 * wafer nearest to the chuck's plane of those in the sensor's gap, WH_SCAN_GAP up and down. Either must be
 * off the axis by less than half its radius, less 1 mm. Without one each sample is 0, whatever hides the
 * line. A wafer that lies face down is seen mirrored; its tilt is ignored. A scan may end early, with fewer
 * samples than ordered. This happens in a slice that has more than WH_SCAN_SLICE of them, turns the chuck
 * faster than WH_SCAN_SPEED, or moves it beyond 9000 rad. Those faults of edge sensors count that act in
 * this slice. No argument may be null. Cost: for an armed scan an arc tangent, linear in wafers if the
 * chuck's gripper holds none, and wh_sensor_read for each sample. */
void wh_scanning_step(const wh_scanning_t *scanning, const wh_grasp_t *table, const wh_faults_t *faults,
                      wh_real_t slice_s, const wh_scan_order_t *order, wh_scan_t *scan)
    WH_SYMBOL(wh_scanning_step);

/* Continues a hash (math/hash.h) with all fixed values that a run's scans depend on. Nothing is checked.
 * Cost: 50 words for each scanner and wafer. */
uint64_t wh_scanning_hash(const wh_scanning_t *scanning, size_t wafer_count, uint64_t hash)
    WH_SYMBOL(wh_scanning_hash);

/* A simulator calls the functions above through these pointers, so that one without sensors does not link
 * them. */
typedef struct {
    wh_status_t (*check)(const wh_scanning_t *scanning, const wh_scan_order_t *order);
    /* wh_scanning_step of a wh_simulator_t by a wh_command_t */
    void (*step)(void *simulator, const void *command);
    uint64_t (*hash)(const wh_scanning_t *scanning, size_t wafer_count, uint64_t hash);
} wh_scanning_calls_t;

WH_HEADER_END

#endif
