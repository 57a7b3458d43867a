/* Gauss and Newton's method for six unknowns; the guess counts among the measurements. */
#include "teaching.h"

#include "angle_internal.h"
#include "check_internal.h"
#include "mismatch_internal.h"
#include "solve_internal.h"

#define STEPS 20
/* x, y, z and yaw of the station, x and y of the beam. */
#define UNKNOWNS 6
/* The least cosine between the beam and a gripper's normal. */
#define LEAST_COSINE 0.5

typedef struct {
    double v[3];
} vector_t;

typedef struct {
    double m[3][3];
} matrix_t;

/* The present state of the fit: the station's frame by rows, and the shifts. */
typedef struct {
    const wh_teach_guess_t *guess;
    double unknown[UNKNOWNS];
    double sd[UNKNOWNS];
    matrix_t R;
    vector_t r;
} fit_t;

/* The residual of a measurement, and its derivatives by the unknowns. */
typedef struct {
    double off;
    double slope[UNKNOWNS];
} row_t;

static vector_t vector_of(const wh_vec3_t *from) {
    const vector_t to = {{(double)from->x, (double)from->y, (double)from->z}};
    return to;
}

static matrix_t matrix_of(const wh_mat3_t *from) {
    matrix_t to;
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
            to.m[i][j] = (double)from->m[i][j];
        }
    }
    return to;
}

static vector_t turn(const matrix_t *R, const vector_t *v) {
    vector_t to;
    for (size_t i = 0; i < 3; ++i) {
        to.v[i] = R->m[i][0] * v->v[0] + R->m[i][1] * v->v[1] + R->m[i][2] * v->v[2];
    }
    return to;
}

static vector_t turn_back(const wh_mat3_t *R, const vector_t *v) {
    vector_t to;
    for (size_t i = 0; i < 3; ++i) {
        to.v[i] = (double)R->m[0][i] * v->v[0] + (double)R->m[1][i] * v->v[1] + (double)R->m[2][i] * v->v[2];
    }
    return to;
}

static vector_t subtract(const vector_t *a, const vector_t *b) {
    const vector_t to = {{a->v[0] - b->v[0], a->v[1] - b->v[1], a->v[2] - b->v[2]}};
    return to;
}

static double dot(const vector_t *a, const vector_t *b) {
    return a->v[0] * b->v[0] + a->v[1] * b->v[1] + a->v[2] * b->v[2];
}

/* The station's frame with the present shifts: turned about base's z through its origin. */
static void place_station(fit_t *fit) {
    const matrix_t R = matrix_of(&fit->guess->base_from_station.R);
    double s;
    double c;
    wh_align_sin_cos(fit->unknown[3], &s, &c);
    for (size_t j = 0; j < 3; ++j) {
        fit->R.m[0][j] = c * R.m[0][j] - s * R.m[1][j];
        fit->R.m[1][j] = s * R.m[0][j] + c * R.m[1][j];
        fit->R.m[2][j] = R.m[2][j];
    }
    fit->r = vector_of(&fit->guess->base_from_station.r);
    for (size_t i = 0; i < 3; ++i) {
        fit->r.v[i] += fit->unknown[i];
    }
}

/* -------------------------------------------------------------------------------------- the measurements */

static row_t touch(const fit_t *fit, const wh_teach_measurement_t *m) {
    const matrix_t R = matrix_of(&m->base_from_gripper.R);
    const vector_t inner = {{m->x, m->y, m->z}};
    const vector_t turned = turn(&R, &inner);
    const vector_t place = vector_of(&m->base_from_gripper.r);
    const vector_t ball = {{place.v[0] + turned.v[0], place.v[1] + turned.v[1], place.v[2] + turned.v[2]}};
    const vector_t from = subtract(&ball, &fit->r);
    const vector_t face = {{m->normal[0], m->normal[1], m->normal[2]}};
    const vector_t normal = turn(&fit->R, &face);
    const row_t row = {
        dot(&normal, &from) - m->distance - m->radius,
        {-normal.v[0], -normal.v[1], -normal.v[2], normal.v[0] * from.v[1] - normal.v[1] * from.v[0], 0, 0}};
    return row;
}

/* The beam's place in the gripper's plane, and its derivatives by the beam's x and y. */
static bool meet(const fit_t *fit, const wh_pose_t *gripper, double at[2], double slope[2][2]) {
    const wh_beam_t *beam = &fit->guess->beam;
    const vector_t place = vector_of(&gripper->r);
    const vector_t point = {{beam->x + fit->unknown[4], beam->y + fit->unknown[5], beam->z}};
    const vector_t direction = {{beam->ex, beam->ey, beam->ez}};
    const vector_t apart = subtract(&point, &place);
    const vector_t from = turn_back(&gripper->R, &apart);
    const vector_t along = turn_back(&gripper->R, &direction);
    if (!(fabs(along.v[2]) >= LEAST_COSINE)) {
        return false;
    }
    for (size_t i = 0; i < 2; ++i) {
        const double part = along.v[i] / along.v[2];
        at[i] = from.v[i] - part * from.v[2];
        for (size_t k = 0; k < 2; ++k) {
            slope[i][k] = (double)gripper->R.m[k][i] - part * (double)gripper->R.m[k][2];
        }
    }
    return true;
}

/* The centre of the taken part, in the gripper's frame, and its derivatives by the station's x, y, z,
 * yaw. */
static void carried(const fit_t *fit, const wh_teach_measurement_t *m, double centre[2], double slope[2][4]) {
    const vector_t inner = {{m->x, m->y, 0}};
    const vector_t arm = turn(&fit->R, &inner);
    const vector_t place = vector_of(&m->base_from_pick.r);
    const vector_t point = {{fit->r.v[0] + arm.v[0], fit->r.v[1] + arm.v[1], fit->r.v[2] + arm.v[2]}};
    const vector_t apart = subtract(&point, &place);
    const vector_t from = turn_back(&m->base_from_pick.R, &apart);
    for (size_t i = 0; i < 2; ++i) {
        const wh_mat3_t *R = &m->base_from_pick.R;
        centre[i] = from.v[i];
        for (size_t k = 0; k < 3; ++k) {
            slope[i][k] = (double)R->m[k][i];
        }
        slope[i][3] = (double)R->m[1][i] * arm.v[0] - (double)R->m[0][i] * arm.v[1];
    }
}

static bool cross(const fit_t *fit, const wh_teach_measurement_t *m, row_t *row) {
    double at[2];
    double at_slope[2][2];
    double centre[2] = {m->x, m->y};
    double slope[2][4] = {{0}};
    if (!meet(fit, &m->base_from_gripper, at, at_slope)) {
        return false;
    }
    if (m->kind == WH_TEACH_CARRIED) {
        carried(fit, m, centre, slope);
    }
    const double dx = at[0] - centre[0];
    const double dy = at[1] - centre[1];
    const double distance = sqrt(dx * dx + dy * dy);
    row->off = distance - m->radius;
    for (size_t k = 0; k < 4; ++k) {
        row->slope[k] = -(dx * slope[0][k] + dy * slope[1][k]) / distance;
    }
    for (size_t k = 0; k < 2; ++k) {
        row->slope[4 + k] = (dx * at_slope[0][k] + dy * at_slope[1][k]) / distance;
    }
    return distance > 0;
}

static bool look(const fit_t *fit, const wh_teach_measurement_t *m, row_t *row) {
    if (m->kind == WH_TEACH_TOUCH) {
        *row = touch(fit, m);
        return true;
    }
    return cross(fit, m, row);
}

/* ----------------------------------------------------------------------------------------------- the fit */

/* Adds a residual; the slopes' signs are inverted, because the step must undo it. */
static void add(wh_normal_t *normal, const row_t *row, double sd) {
    double derivatives[UNKNOWNS];
    for (size_t k = 0; k < UNKNOWNS; ++k) {
        derivatives[k] = -row->slope[k];
    }
    wh_normal_add(normal, derivatives, row->off, 1 / (sd * sd));
}

static bool step(fit_t *fit, const wh_teach_measurement_t *measurements, size_t count, wh_taught_t *taught,
                 double *moved) {
    wh_normal_t normal;
    wh_normal_begin(&normal, UNKNOWNS);
    taught->mismatch = 0;
    taught->largest = 0;
    taught->largest_index = WH_NONE;
    place_station(fit);
    for (size_t k = 0; k < UNKNOWNS; ++k) {
        row_t row = {fit->unknown[k], {0}};
        row.slope[k] = 1;
        add(&normal, &row, fit->sd[k]);
        taught->mismatch += row.off * row.off / (fit->sd[k] * fit->sd[k]);
    }
    for (size_t i = 0; i < count; ++i) {
        row_t row;
        if (!look(fit, &measurements[i], &row)) {
            return false;
        }
        const double deviations = row.off / measurements[i].sd;
        add(&normal, &row, measurements[i].sd);
        taught->mismatch += deviations * deviations;
        if (fabs(deviations) > taught->largest) {
            taught->largest = fabs(deviations);
            taught->largest_index = (int32_t)i;
        }
    }
    if (!wh_normal_solve(&normal)) {
        return false;
    }
    *moved = 0;
    for (size_t k = 0; k < UNKNOWNS; ++k) {
        fit->unknown[k] += normal.right[k];
        *moved += fabs(normal.right[k]);
    }
    for (size_t k = 0; k < 3; ++k) {
        taught->sd_shift[k] = sqrt(normal.matrix[k][k]);
    }
    taught->sd_yaw = sqrt(normal.matrix[3][3]);
    taught->sd_beam[0] = sqrt(normal.matrix[4][4]);
    taught->sd_beam[1] = sqrt(normal.matrix[5][5]);
    return *moved < 1e3;
}

/* ---------------------------------------------------------------------------------------------- refusals */

static wh_status_t check_guess(const wh_teach_guess_t *guess) {
    wh_field_check_t found = wh_field_check_begin();
    wh_field_check(&found, "sd_place", WH_NONE, guess->sd_place, 1e-6, 10);
    wh_field_check(&found, "sd_yaw", WH_NONE, guess->sd_yaw, 1e-9, 0.2);
    wh_field_check(&found, "sd_beam", WH_NONE, guess->sd_beam, 1e-6, 10);
    if (found.status != WH_OK) {
        return found.status;
    }
    const wh_status_t status = wh_pose_validate(&guess->base_from_station);
    return status == WH_OK ? wh_beam_validate(&guess->beam) : status;
}

static wh_status_t check_measurement(const wh_teach_measurement_t *m) {
    wh_field_check_t found = wh_field_check_begin();
    const bool is_touch = m->kind == WH_TEACH_TOUCH;
    wh_field_check(&found, "kind", WH_NONE, (double)m->kind, WH_TEACH_TOUCH, WH_TEACH_CARRIED);
    wh_field_check(&found, "sd", WH_NONE, m->sd, 1e-5, 1);
    wh_field_check(&found, "x", WH_NONE, m->x, -1e3, 1e3);
    wh_field_check(&found, "y", WH_NONE, m->y, -1e3, 1e3);
    wh_field_check(&found, "radius", WH_NONE, m->radius, is_touch ? 0 : 0.5, 300);
    if (is_touch && found.status == WH_OK) {
        const double *n = m->normal;
        wh_field_check(&found, "z", WH_NONE, m->z, -1e3, 1e3);
        wh_field_check(&found, "normal", WH_NONE, n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 0.99999, 1.00001);
        wh_field_check(&found, "distance", WH_NONE, m->distance, -1e3, 1e3);
    }
    if (found.status != WH_OK) {
        return found.status;
    }
    const wh_status_t status = wh_pose_validate(&m->base_from_gripper);
    return status == WH_OK && m->kind == WH_TEACH_CARRIED ? wh_pose_validate(&m->base_from_pick) : status;
}

/* --------------------------------------------------------------------------------------------- the whole */

wh_teach_guess_t wh_teach_guess_at(const wh_pose_t *base_from_station, double x, double y) {
    const wh_teach_guess_t guess = {.base_from_station = *base_from_station,
                                    .sd_place = 0.25,
                                    .sd_yaw = 0.5 * WH_ALIGN_PI / 180,
                                    .beam = wh_beam_at(base_from_station, x, y, -100, 100),
                                    .sd_beam = 0.5};
    return guess;
}

static void tell(const fit_t *fit, wh_taught_t *taught) {
    wh_pose_t *station = &taught->base_from_station;
    for (size_t i = 0; i < 3; ++i) {
        taught->shift[i] = fit->unknown[i];
        for (size_t j = 0; j < 3; ++j) {
            station->R.m[i][j] = (wh_real_t)fit->R.m[i][j];
        }
    }
    station->r = wh_vec3((wh_real_t)fit->r.v[0], (wh_real_t)fit->r.v[1], (wh_real_t)fit->r.v[2]);
    taught->yaw = fit->unknown[3];
    taught->beam_x = fit->unknown[4];
    taught->beam_y = fit->unknown[5];
}

/* The number of remaining deviations equals the number of measurements, because the guess of each unknown
 * also counts as one. */
static wh_status_t solve(const wh_teach_guess_t *guess, const wh_teach_measurement_t *measurements,
                         size_t count, wh_taught_t *taught) {
    fit_t fit = {.guess = guess};
    for (size_t k = 0; k < UNKNOWNS; ++k) {
        fit.sd[k] = k < 3 ? guess->sd_place : guess->sd_beam;
    }
    fit.sd[3] = guess->sd_yaw;
    double moved = 1;
    for (int i = 0; i < STEPS && moved > 1e-10; ++i) {
        if (!step(&fit, measurements, count, taught, &moved)) {
            return WH_STATUS_CENTRE_NOT_SURE;
        }
    }
    place_station(&fit);
    tell(&fit, taught);
    const bool good = moved <= 1e-10 && taught->mismatch <= wh_mismatch_limit((double)count);
    return good ? WH_OK : WH_STATUS_CENTRE_NOT_SURE;
}

static wh_status_t check(const wh_teach_guess_t *guess, const wh_teach_measurement_t *measurements,
                         size_t count, int32_t *bad) {
    wh_status_t status = check_guess(guess);
    if (status == WH_OK && count > WH_TEACH_MEASUREMENTS) {
        status = WH_STATUS_OUT_OF_RANGE;
    }
    if (status == WH_OK && count == 0) {
        status = WH_STATUS_TOO_FEW_SAMPLES;
    }
    for (size_t i = 0; status == WH_OK && i < count; ++i) {
        status = check_measurement(&measurements[i]);
        *bad = status == WH_OK ? WH_NONE : (int32_t)i;
    }
    return status;
}

wh_status_t wh_teach_solve(const wh_teach_guess_t *guess, const wh_teach_measurement_t *measurements,
                           size_t count, wh_taught_t *taught, int32_t *bad) {
    if (guess == NULL || measurements == NULL || taught == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    int32_t worst = WH_NONE;
    wh_status_t status = check(guess, measurements, count, &worst);
    if (status == WH_OK) {
        wh_taught_t found = {.largest_index = WH_NONE};
        status = solve(guess, measurements, count, &found);
        if (status == WH_OK) {
            *taught = found;
            return WH_OK;
        }
        worst = found.largest_index;
    }
    if (bad != NULL) {
        *bad = worst;
    }
    return status;
}
