#include "scanning.h"

#include <string.h>

#include "../math/hash.h"
#include "../math/trig.h"
#include "setting_internal.h"
#include "simulator.h"

#define TURN (2 * 3.14159265358979323846)

/* rad: more than WH_SCAN_REACH and WH_SCAN_TURNS turns, less than the limit of align/sensing.h. */
#define FARTHEST 9000

/* ----------------------------------------------------------------------------------------------- validity */

static const wh_scanner_t *find_scanner(const wh_scanning_t *scanning, int32_t gripper) {
    for (size_t i = 0; i < scanning->scanner_count; ++i) {
        if (scanning->scanners[i].gripper == gripper) {
            return &scanning->scanners[i];
        }
    }
    return NULL;
}

static wh_status_t check_scanner(const wh_scanning_t *scanning, size_t i, size_t gripper_count) {
    const wh_scanner_t *scanner = &scanning->scanners[i];
    if (scanner->gripper < 0 || (size_t)scanner->gripper >= gripper_count ||
        find_scanner(scanning, scanner->gripper) != scanner) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_status_t status = wh_pose_validate(&scanner->base_from_station);
    return status == WH_OK ? wh_sensor_validate(&scanner->sensor, NULL) : status;
}

static wh_status_t check_rims(const wh_scanning_t *scanning, size_t wafer_count) {
    wh_status_t status = scanning->rims || wafer_count == 0 ? WH_OK : WH_STATUS_NULL_ARGUMENT;
    for (size_t w = 0; status == WH_OK && w < wafer_count; ++w) {
        status = wh_rim_validate(scanning->rims[w], NULL);
    }
    return status;
}

wh_status_t wh_scanning_validate(const wh_scanning_t *scanning, size_t gripper_count, size_t wafer_count) {
    if (!scanning || (!scanning->scanners && scanning->scanner_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (scanning->scanner_count > gripper_count) {
        return WH_STATUS_BAD_CAPACITY;
    }
    wh_status_t status = WH_OK;
    for (size_t i = 0; status == WH_OK && i < scanning->scanner_count; ++i) {
        status = check_scanner(scanning, i, gripper_count);
    }
    return status == WH_OK && scanning->scanner_count > 0 ? check_rims(scanning, wafer_count) : status;
}

wh_status_t wh_scanning_check(const wh_scanning_t *scanning, const wh_scan_order_t *order) {
    if (order->kind != WH_SCAN_ARM) {
        const bool known = order->kind == WH_SCAN_KEEP || order->kind == WH_SCAN_DISARM;
        return known ? WH_OK : WH_STATUS_OUT_OF_RANGE;
    }
    const wh_scanner_t *scanner = find_scanner(scanning, order->gripper);
    if (!scanner) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const int32_t most = WH_SCAN_TURNS * scanner->sensor.samples;
    const int64_t reach = (int64_t)WH_SCAN_REACH * scanner->sensor.samples;
    const bool good = order->count != 0 && order->count >= -most && order->count <= most &&
                      order->first >= -reach && order->first <= reach;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* ----------------------------------------------------------------------------------------- what is there */

/* The chuck's turn, with the whole turns that bring it nearest to `near`. */
static double turn_next_to(const wh_scanner_t *scanner, const wh_grasp_t *table, double near) {
    const wh_mat3_t *chuck = &table->storage.grippers[scanner->gripper].base_from_gripper.R;
    const wh_vec3_t x = wh_mat3_column(&scanner->base_from_station.R, 0);
    const wh_vec3_t y = wh_mat3_column(&scanner->base_from_station.R, 1);
    const wh_vec3_t points = wh_mat3_column(chuck, 0);
    const double turn = (double)wh_atan2(wh_vec3_dot(&y, &points), wh_vec3_dot(&x, &points));
    const double turns = (near - turn) / TURN;
    return turn + TURN * (double)(int64_t)(turns < 0 ? turns - 0.5 : turns + 0.5);
}

/* A wafer's frame in the chuck's. A wafer that the chuck holds does not move in it, to the last bit. */
static wh_pose_t chuck_from_wafer(const wh_grasp_t *table, int32_t gripper, size_t wafer) {
    const wh_gripper_t *chuck = &table->storage.grippers[gripper];
    return chuck->wafer == (int32_t)wafer
               ? chuck->gripper_from_wafer
               : wh_pose_relative(&chuck->base_from_gripper, &table->storage.wafers[wafer].base_from_wafer);
}

static bool is_in_gap(const wh_pose_t *lies, double radius) {
    const double most = radius / 2 - 1;
    const double x = (double)lies->r.x;
    const double y = (double)lies->r.y;
    return x * x + y * y < most * most && lies->r.z <= WH_SCAN_GAP && lies->r.z >= -WH_SCAN_GAP;
}

/* The rim that the sensor sees; null if there is no wafer. */
static const wh_rim_t *find_rim(const wh_scanning_t *scanning, const wh_grasp_t *table, int32_t gripper,
                                wh_pose_t *lies) {
    const int32_t held = table->storage.grippers[gripper].wafer;
    const wh_rim_t *found = NULL;
    *lies = wh_pose_identity();
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        if (held != WH_NONE && (size_t)held != w) {
            continue;
        }
        const wh_pose_t pose = chuck_from_wafer(table, gripper, w);
        if (is_in_gap(&pose, scanning->rims[w]->radius) &&
            (!found || wh_real_abs(pose.r.z) < wh_real_abs(lies->r.z))) {
            found = scanning->rims[w];
            *lies = pose;
        }
    }
    return found;
}

/* Mirrors the rim, as seen from the back. */
static void mirror(wh_rim_t *rim) {
    rim->notch.direction = -rim->notch.direction;
    for (size_t i = 0; i < WH_RIM_FLATS; ++i) {
        rim->flats[i].direction = -rim->flats[i].direction;
    }
    for (size_t i = 0; i < WH_RIM_CHIPS; ++i) {
        rim->chips[i].direction = -rim->chips[i].direction;
    }
    rim->bow = -rim->bow;
    rim->saddle = -rim->saddle;
    rim->saddle_direction = -rim->saddle_direction;
}

/* -------------------------------------------------------------------------------------------------- scans */

/* The objects of a sensor in a slice. */
typedef struct {
    const wh_rim_t *rim; /* null: nothing */
    wh_placement_t placement;
    double turn; /* turn of the chuck at which the wafer lies like that */
    bool is_held;
    const wh_fault_t *stuck, *late; /* null: the sensor has no such fault */
} scanned_t;

/* A wafer that the chuck does not hold stays where it is while the chuck turns under it. */
static wh_placement_t placement_at(const scanned_t *sight, double turn) {
    wh_placement_t placement = sight->placement;
    if (!sight->is_held) {
        wh_real_t s;
        wh_real_t c;
        wh_sin_cos((wh_real_t)(sight->turn - turn), &s, &c);
        placement.x = (double)c * sight->placement.x - (double)s * sight->placement.y;
        placement.y = (double)s * sight->placement.x + (double)c * sight->placement.y;
        placement.turn += sight->turn - turn;
    }
    return placement;
}

/* Reads the next sample, which is due. */
static int32_t read_sample(const wh_scanner_t *scanner, const scanned_t *sight, double speed,
                           const wh_scan_t *scan) {
    const wh_sensor_t *sensor = &scanner->sensor;
    const int64_t k = scan->first + (scan->count > 0 ? scan->taken : -scan->taken);
    const double angle = wh_sensor_angle(sensor, k);
    const double own = sight->is_held ? speed : 0;
    const double late = sight->late ? own * (double)sight->late->value : 0;
    if (sight->stuck) {
        return (int32_t)((double)sight->stuck->value * wh_sensor_pixels(sensor));
    }
    const wh_placement_t placement = placement_at(sight, angle);
    const wh_glance_t glance = {angle + late, own, {scanner->seed, scan->number}, (uint32_t)scan->taken};
    return sight->rim ? wh_sensor_read(sensor, sight->rim, &placement, &glance) : 0;
}

/* Reads this number of samples, which are due. */
static void read_samples(const wh_scanner_t *scanner, const scanned_t *sight, double speed, size_t count,
                         wh_scan_t *scan) {
    for (size_t i = 0; i < count; ++i) {
        scan->samples[i] = read_sample(scanner, sight, speed, scan);
        ++scan->taken;
    }
    scan->sample_count = (int32_t)count;
}

static void look(const wh_scanning_t *scanning, const wh_scanner_t *scanner, const wh_grasp_t *table,
                 const wh_faults_t *faults, double speed, size_t count, wh_scan_t *scan) {
    wh_pose_t lies;
    wh_rim_t rim;
    const wh_rim_t *seen = find_rim(scanning, table, scan->gripper, &lies);
    if (seen && lies.R.m[2][2] < 0) {
        rim = *seen;
        mirror(&rim);
        seen = &rim;
    }
    const scanned_t sight = {
        seen,
        {(double)lies.r.x, (double)lies.r.y, (double)wh_atan2(lies.R.m[1][0], lies.R.m[0][0])},
        scan->turn,
        table->storage.grippers[scan->gripper].wafer != WH_NONE,
        wh_faults_find(faults, WH_FAULT_EDGE_SENSOR_STUCK, scan->gripper),
        wh_faults_find(faults, WH_FAULT_EDGE_SENSOR_LATE, scan->gripper)};
    read_samples(scanner, &sight, speed, count, scan);
}

static void end_scan(wh_scan_t *scan) {
    scan->armed = false;
    scan->turn = 0;
}

/* The number of samples that the scan takes on the chuck's way. */
static size_t count_due(const wh_sensor_t *sensor, const wh_scan_t *scan, double to) {
    const bool up = scan->count > 0;
    int64_t first = 0;
    size_t due =
        to == scan->turn || (to > scan->turn) != up ? 0 : wh_sensor_due(sensor, scan->turn, to, &first);
    const int64_t next = scan->first + (up ? scan->taken : -scan->taken);
    const int64_t passed = up ? next - first : first - next; /* samples that the scan does not wait for */
    if (due == 0 || passed < 0 || passed >= (int64_t)due) {
        return 0;
    }
    due -= (size_t)passed;
    const int32_t left = (up ? scan->count : -scan->count) - scan->taken;
    return due < (size_t)left ? due : (size_t)left;
}

/* Takes the samples of this slice, for an armed scan. */
static void take_samples(const wh_scanning_t *scanning, const wh_grasp_t *table, const wh_faults_t *faults,
                         wh_real_t slice_s, wh_scan_t *scan) {
    const wh_scanner_t *scanner = find_scanner(scanning, scan->gripper);
    if (!scanner) {
        end_scan(scan);
        return;
    }
    const double turn = turn_next_to(scanner, table, scan->turn);
    const double speed = (turn - scan->turn) / (double)slice_s;
    const size_t due = count_due(&scanner->sensor, scan, turn);
    const bool fast = speed > WH_SCAN_SPEED || speed < -WH_SCAN_SPEED;
    if (due > WH_SCAN_SLICE || fast || turn > FARTHEST || turn < -FARTHEST) {
        end_scan(scan);
        return;
    }
    scan->turn = turn;
    if (due > 0) {
        look(scanning, scanner, table, faults, speed, due, scan);
    }
    if (scan->taken == (scan->count > 0 ? scan->count : -scan->count)) {
        end_scan(scan);
    }
}

static void take_order(const wh_scanning_t *scanning, const wh_grasp_t *table, const wh_scan_order_t *order,
                       wh_scan_t *scan) {
    const uint32_t number = scan->number;
    const wh_scanner_t *scanner = find_scanner(scanning, order->gripper);
    if (order->kind == WH_SCAN_DISARM) {
        end_scan(scan);
    } else if (order->kind == WH_SCAN_ARM && scanner) {
        memset(scan, 0, sizeof *scan);
        scan->number = number + 1;
        scan->armed = true;
        scan->gripper = order->gripper;
        scan->count = order->count;
        scan->first = order->first;
        scan->turn = turn_next_to(scanner, table, wh_sensor_angle(&scanner->sensor, order->first));
    }
}

void wh_scanning_step(const wh_scanning_t *scanning, const wh_grasp_t *table, const wh_faults_t *faults,
                      wh_real_t slice_s, const wh_scan_order_t *order, wh_scan_t *scan) {
    if (scan->sample_count > 0) {
        scan->sample_count = 0;
        memset(scan->samples, 0, sizeof scan->samples);
    }
    if (scan->armed) {
        take_samples(scanning, table, faults, slice_s, scan);
    }
    take_order(scanning, table, order, scan);
}

/* --------------------------------------------------------------------------------------------------- hash */

static uint64_t hash_sensor(uint64_t hash, const wh_sensor_t *sensor) {
    const double values[] = {sensor->direction,  sensor->middle,     sensor->length,
                             sensor->pixel,      sensor->samples,    sensor->encoder,
                             sensor->noise,      sensor->tilt,       sensor->error.offset,
                             sensor->error.zero, sensor->error.gain, sensor->error.latency};
    hash = wh_hash_doubles(hash, values, sizeof values / sizeof values[0]);
    for (int32_t i = 0; i < sensor->hidden_count; ++i) {
        const double arc[] = {sensor->hidden[i].from, sensor->hidden[i].width};
        hash = wh_hash_doubles(hash, arc, 2);
    }
    return wh_hash_int(hash, sensor->hidden_count);
}

uint64_t wh_scanning_hash(const wh_scanning_t *scanning, size_t wafer_count, uint64_t hash) {
    for (size_t i = 0; i < scanning->scanner_count; ++i) {
        const wh_scanner_t *scanner = &scanning->scanners[i];
        hash = wh_hash_int(hash, scanner->gripper);
        hash = wh_hash_word(hash, scanner->seed);
        hash = wh_hash_pose(hash, &scanner->base_from_station);
        hash = hash_sensor(hash, &scanner->sensor);
    }
    for (size_t w = 0; scanning->scanner_count > 0 && w < wafer_count; ++w) {
        hash = wh_rim_hash(scanning->rims[w], hash);
    }
    return hash;
}

/* ----------------------------------------------------------------------------------------- in a simulator */

static void step(void *of, const void *by) {
    wh_simulator_t *simulator = of;
    const wh_command_t *command = by;
    wh_scanning_step(&simulator->given.scanning, &simulator->table, &simulator->physics.faults,
                     simulator->slice_s, &command->scan, &simulator->physics.scan);
}

wh_status_t wh_simulator_set_scanning(wh_simulator_t *simulator, const wh_scanning_t *scanning) {
    static const wh_scanning_calls_t calls = {wh_scanning_check, step, wh_scanning_hash};
    wh_status_t status = wh_simulator_check_setting(simulator, scanning);
    if (status != WH_OK) {
        return status;
    }
    const wh_grasp_storage_t *storage = &simulator->table.storage;
    status = wh_scanning_validate(scanning, storage->gripper_count, storage->wafer_count);
    if (status == WH_OK) {
        simulator->given.scanning = *scanning;
        simulator->given.scans = scanning->scanner_count > 0 ? &calls : NULL;
        simulator->given.hash = wh_physics_state_hash_given;
    }
    return status;
}
