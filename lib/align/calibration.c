/* Fits the centres and radii of all scans, and finds the errors that explain them by Gauss and Newton's
 * steps. */
#include "calibration.h"

#include "angle_internal.h"
#include "mismatch_internal.h"
#include "solve_internal.h"

#define UNKNOWNS 6
#define STEPS 12
/* The last step is one that moves no centre, at an eccentricity of 10 mm, by more than this, mm. */
#define STILL 1e-9
/* At the end a sample may alternate between on and off the circle, which moves the centre by less than
 * this, mm. */
#define IN_TURN 2e-4
#define ECCENTRIC 10
/* The least standard deviation of a circle, mm: its shape is not known better. */
#define LEAST_SD 2e-5

/* The data of the solution. */
typedef struct {
    const wh_sensor_t *sensor;
    double radius;
    double sd_way;
    const wh_calibration_scan_t *scans;
    size_t count;
    wh_rim_point_t *points;
    wh_rim_ray_t *rays;
    int32_t bad;
} task_t;

/* ---------------------------------------------------------------------------------------------- bad input */

static wh_status_t in_range(double value, double least, double most) {
    if (!wh_align_is_finite(value)) {
        return WH_STATUS_NOT_FINITE;
    }
    return value >= least && value <= most ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t check_scan(const wh_calibration_scan_t *scan) {
    const double each[3][2] = {{scan->speed, 100}, {scan->way_x, 300}, {scan->way_y, 300}};
    if (scan->points == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    for (size_t i = 0; i < 3; ++i) {
        const wh_status_t status = in_range(each[i][0], -each[i][1], each[i][1]);
        if (status != WH_OK) {
            return status;
        }
    }
    return scan->count <= WH_SENSOR_SAMPLES ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* True if the wafer was moved far enough, and turned at different speeds. */
static bool tells_all(const task_t *task) {
    const wh_calibration_scan_t *first = &task->scans[0];
    double way = 0;
    double speed = 0;
    for (size_t i = 1; i < task->count; ++i) {
        const wh_calibration_scan_t *scan = &task->scans[i];
        const double dx = scan->way_x - first->way_x;
        const double dy = scan->way_y - first->way_y;
        const double square = dx * dx + dy * dy;
        way = square > way ? square : way;
        const double faster = fabs(scan->speed - first->speed);
        speed = faster > speed ? faster : speed;
    }
    return sqrt(way) >= WH_CALIBRATION_WAY && speed >= WH_CALIBRATION_SPEED;
}

/* Checks everything but the scans themselves. */
static wh_status_t check_numbers(const task_t *task) {
    wh_status_t status = wh_sensor_validate(task->sensor, NULL);
    if (status == WH_OK) {
        status = in_range(task->radius, 10, 300);
    }
    if (status == WH_OK) {
        status = in_range(task->sd_way, 0, 1);
    }
    if (status == WH_OK && task->count < WH_CALIBRATION_LEAST) {
        status = WH_STATUS_TOO_FEW_SAMPLES;
    }
    return status == WH_OK && task->count > WH_CALIBRATION_SCANS ? WH_STATUS_OUT_OF_RANGE : status;
}

static wh_status_t check(task_t *task) {
    wh_status_t status = check_numbers(task);
    for (size_t i = 0; status == WH_OK && i < task->count; ++i) {
        status = check_scan(&task->scans[i]);
        task->bad = status == WH_OK ? WH_NONE : (int32_t)i;
    }
    return status == WH_OK && !tells_all(task) ? WH_STATUS_CENTRE_NOT_SURE : status;
}

/* -------------------------------------------------------------------------------------------------- steps */

static double inner_end(const wh_sensor_t *sensor) {
    return sensor->middle - sensor->length / 2;
}

/* Fits the circle of a scan after subtracting the errors. */
static wh_status_t fit_corrected(const task_t *task, const wh_calibration_scan_t *scan,
                                 const wh_sensor_error_t *error, wh_circle_t *circle) {
    const double inner = inner_end(task->sensor);
    for (size_t k = 0; k < scan->count; ++k) {
        wh_rim_point_t point = scan->points[k];
        point.angle -= scan->speed * error->latency;
        if (point.sight == WH_SIGHT_RIM) {
            point.radius = inner + error->zero + (point.radius - inner) * (1 + error->gain);
        }
        task->points[k] = point;
    }
    const wh_rim_scan_t corrected = {task->points, scan->count, error->offset, task->sensor->pixel};
    return wh_circle_fit(&corrected, task->rays, circle);
}

/* The number of scans of this one's place; they share the error of its way. */
static double sharers(const task_t *task, const wh_calibration_scan_t *scan) {
    double count = 0;
    for (size_t i = 0; i < task->count; ++i) {
        const bool is_there = task->scans[i].way_x == scan->way_x && task->scans[i].way_y == scan->way_y;
        count += is_there ? 1 : 0;
    }
    return count;
}

static void add(wh_normal_t *normal, const double *by, double off, double square, double *mismatch) {
    wh_normal_add(normal, by, off, 1 / square);
    *mismatch += off * off / square;
}

/* Three equations of a scan: its centre's x and y, its radius. The unknowns are, in this order, the first
 * centre's x and y, offset, gain, latency, zero, each as the remaining correction. */
static void add_scan(const task_t *task, const wh_calibration_scan_t *scan, const wh_circle_t *circle,
                     const wh_calibration_t *now, wh_normal_t *normal, double *mismatch) {
    const double x = now->x + scan->way_x;
    const double y = now->y + scan->way_y;
    const double per_offset = 1 / task->radius;
    const double along_line = task->radius - inner_end(task->sensor);
    const double by_x[UNKNOWNS] = {1, 0, y * per_offset, -x, -y * scan->speed, 0};
    const double by_y[UNKNOWNS] = {0, 1, -x * per_offset, -y, x * scan->speed, 0};
    const double by_radius[UNKNOWNS] = {0, 0, 0, -along_line, 0, -1};
    const double of_way = task->sd_way * task->sd_way * sharers(task, scan) + LEAST_SD * LEAST_SD;
    add(normal, by_x, circle->x - x, circle->sd_x * circle->sd_x + of_way, mismatch);
    add(normal, by_y, circle->y - y, circle->sd_y * circle->sd_y + of_way, mismatch);
    add(normal, by_radius, circle->radius - task->radius,
        circle->sd_radius * circle->sd_radius + LEAST_SD * LEAST_SD, mismatch);
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* Takes one step; `moved` receives the largest motion of a centre. */
static wh_status_t step(task_t *task, wh_calibration_t *now, wh_normal_t *normal, double *moved) {
    double fastest = 0;
    wh_normal_begin(normal, UNKNOWNS);
    now->mismatch = 0;
    for (size_t i = 0; i < task->count; ++i) {
        const wh_calibration_scan_t *scan = &task->scans[i];
        wh_circle_t circle;
        const wh_status_t status = fit_corrected(task, scan, &now->error, &circle);
        if (status != WH_OK) {
            task->bad = (int32_t)i;
            return status;
        }
        add_scan(task, scan, &circle, now, normal, &now->mismatch);
        fastest = larger(fastest, fabs(scan->speed));
    }
    if (!wh_normal_solve(normal)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    const double *by = normal->right;
    now->x += by[0];
    now->y += by[1];
    now->error.offset += by[2];
    now->error.gain += by[3];
    now->error.latency += by[4];
    now->error.zero += by[5];
    const double turned = fabs(by[2]) / task->radius + fabs(by[4]) * fastest;
    *moved = larger(larger(fabs(by[0]), fabs(by[1])),
                    larger(fabs(by[5]), ECCENTRIC * larger(fabs(by[3]), turned)));
    const wh_sensor_error_t *error = &now->error;
    const bool is_error = fabs(error->offset) <= 1 && fabs(error->zero) <= 1 && fabs(error->gain) <= 0.01 &&
                          fabs(error->latency) <= 0.001;
    return is_error ? WH_OK : WH_STATUS_CENTRE_NOT_SURE;
}

static wh_status_t solve(task_t *task, wh_calibration_t *found) {
    wh_normal_t normal;
    double moved = 1;
    wh_normal_begin(&normal, UNKNOWNS);
    for (int i = 0; i < STEPS && moved > STILL; ++i) {
        const wh_status_t status = step(task, found, &normal, &moved);
        if (status != WH_OK) {
            return status;
        }
    }
    found->sd_offset = sqrt(normal.matrix[2][2]);
    found->sd_gain = sqrt(normal.matrix[3][3]);
    found->sd_latency = sqrt(normal.matrix[4][4]);
    found->sd_zero = sqrt(normal.matrix[5][5]);
    const double limit = wh_mismatch_limit((double)(3 * task->count - UNKNOWNS));
    return moved <= IN_TURN && found->mismatch <= limit ? WH_OK : WH_STATUS_CENTRE_NOT_SURE;
}

wh_status_t wh_calibration_solve(const wh_sensor_t *sensor, double radius, double sd_way,
                                 const wh_calibration_scan_t *scans, size_t count, wh_rim_point_t *points,
                                 wh_rim_ray_t *rays, wh_calibration_t *calibration, int32_t *bad) {
    if (sensor == NULL || scans == NULL || points == NULL || rays == NULL || calibration == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    task_t task = {sensor, radius, sd_way, scans, count, points, rays, WH_NONE};
    wh_calibration_t found = {{0, 0, 0, 0}, 0, 0, 0, 0, 0, 0, 0};
    wh_status_t status = check(&task);
    if (status == WH_OK) {
        status = solve(&task, &found);
    }
    if (status == WH_OK) {
        *calibration = found;
    } else if (bad != NULL) {
        *bad = task.bad;
    }
    return status;
}
