/* A robust start on few samples, then weighted Gauss and Newton on all of them. */
#include "circle.h"

#include "angle_internal.h"
#include "solve_internal.h"

/* The start: circles through three of at most so many samples, and the one with the least median is taken. */
#define START_SAMPLES 96
#define START_CIRCLES 24
/* Steps with the weights as they stand, at most. */
#define STEPS 6
/* Tukey's weight is 0 from so many standard deviations on; of normal noise it then sees this part of the
 * mean square. */
#define CUT 6
#define MEAN_SQUARE_SEEN 0.8924
/* The least standard deviation of a sample, mm. */
#define LEAST_SCATTER 1e-5
/* So many neighbours of a sample off the circle do not count. */
#define NEIGHBOURS 2

/* ---------------------------------------------------------------------------------- is it a scan at all */

static bool is_point(const wh_rim_point_t *point) {
    return wh_align_is_finite(point->angle) && fabs(point->angle) < 1e5 &&
           (point->sight != WH_SIGHT_RIM || (point->radius >= 1 && point->radius <= 1e3));
}

static bool is_ordered(const wh_rim_scan_t *scan) {
    const wh_rim_point_t *points = scan->points;
    const double sign = points[scan->count - 1].angle > points[0].angle ? 1 : -1;
    for (size_t i = 1; i < scan->count; ++i) {
        if (!(sign * (points[i].angle - points[i - 1].angle) > 0)) {
            return false;
        }
    }
    return sign * (points[scan->count - 1].angle - points[0].angle) < WH_ALIGN_TURN;
}

static wh_status_t check_scan(const wh_rim_scan_t *scan, size_t *seen) {
    if (scan->count > WH_SENSOR_SAMPLES || !(scan->offset >= -1 && scan->offset <= 1) ||
        !(scan->pixel >= 0 && scan->pixel <= 0.1)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    double least = 1e9;
    double most = 0;
    *seen = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        const wh_rim_point_t *point = &scan->points[i];
        if (!is_point(point)) {
            return WH_STATUS_BAD_SCAN;
        }
        if (point->sight == WH_SIGHT_RIM) {
            ++*seen;
            least = point->radius < least ? point->radius : least;
            most = point->radius > most ? point->radius : most;
        }
    }
    if (*seen < WH_SCAN_LEAST) {
        return WH_STATUS_TOO_FEW_SAMPLES;
    }
    return is_ordered(scan) && most > least ? WH_OK : WH_STATUS_BAD_SCAN;
}

/* ------------------------------------------------------------------------------------------------ the model */

double wh_circle_radius(const wh_circle_t *circle, double offset, double cosine, double sine) {
    const double p = circle->x * cosine + circle->y * sine;
    const double q = offset + circle->x * sine - circle->y * cosine;
    return p + sqrt(circle->radius * circle->radius - q * q);
}

/* ------------------------------------------------------------------------------------------------ the start */

/* Their places in the scan. */
typedef struct {
    size_t count;
    uint16_t index[START_SAMPLES];
} start_t;

/* An even share of those that see the rim. */
static start_t choose_samples(const wh_rim_scan_t *scan, size_t seen) {
    start_t chosen;
    chosen.count = 0;
    const size_t wanted = seen < START_SAMPLES ? seen : START_SAMPLES;
    size_t passed = 0;
    for (size_t i = 0; chosen.count < wanted; ++i) {
        if (scan->points[i].sight == WH_SIGHT_RIM && passed++ == chosen.count * seen / wanted) {
            chosen.index[chosen.count++] = (uint16_t)i;
        }
    }
    return chosen;
}

/* Where a sample's rim is, chuck's frame. */
static void place(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, size_t i, double *x, double *y) {
    *x = scan->points[i].radius * rays[i].cosine - scan->offset * rays[i].sine;
    *y = scan->points[i].radius * rays[i].sine + scan->offset * rays[i].cosine;
}

/* False if the three are nearly on a line, or the circle leaves out the axis. */
static bool through_three(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const size_t index[3],
                          wh_circle_t *circle) {
    double x[3];
    double y[3];
    for (size_t k = 0; k < 3; ++k) {
        place(scan, rays, index[k], &x[k], &y[k]);
    }
    const double x1 = x[1] - x[0];
    const double y1 = y[1] - y[0];
    const double x2 = x[2] - x[0];
    const double y2 = y[2] - y[0];
    const double area = 2 * (x1 * y2 - x2 * y1);
    if (fabs(area) < 1) {
        return false;
    }
    const double square1 = x1 * x1 + y1 * y1;
    const double square2 = x2 * x2 + y2 * y2;
    const double dx = (y2 * square1 - y1 * square2) / area;
    const double dy = (x1 * square2 - x2 * square1) / area;
    circle->x = x[0] + dx;
    circle->y = y[0] + dy;
    circle->radius = sqrt(dx * dx + dy * dy);
    return circle->x * circle->x + circle->y * circle->y < circle->radius * circle->radius / 4;
}

/* The k-th smallest of the first `count` residuals; they change their places. */
static double kth_residual(wh_rim_ray_t *rays, size_t count, size_t k) {
    size_t low = 0;
    size_t high = count - 1;
    while (low < high) {
        const double pivot = rays[(low + high) / 2].residual;
        size_t i = low;
        size_t j = high;
        for (;;) {
            while (rays[i].residual < pivot) {
                ++i;
            }
            while (rays[j].residual > pivot) {
                --j;
            }
            if (i >= j) {
                break;
            }
            const double swap = rays[i].residual;
            rays[i++].residual = rays[j].residual;
            rays[j--].residual = swap;
        }
        if (k <= j) {
            high = j;
        } else {
            low = j + 1;
        }
    }
    return rays[k].residual;
}

/* The median of how far the chosen samples are from a circle; residuals are used as memory. */
static double median_off(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const start_t *chosen,
                         const wh_circle_t *circle) {
    for (size_t k = 0; k < chosen->count; ++k) {
        const size_t i = chosen->index[k];
        const double rho = wh_circle_radius(circle, scan->offset, rays[i].cosine, rays[i].sine);
        const double off = fabs(scan->points[i].radius - rho);
        rays[k].residual = off - off == 0 ? off : 1e9;
    }
    return kth_residual(rays, chosen->count, chosen->count / 2);
}

/* Three that are far from each other, other ones each time. */
static void choose_three(const start_t *chosen, size_t turn, size_t index[3]) {
    const size_t count = chosen->count;
    const size_t first = turn * 37;
    const size_t second = first + count / 5 + turn * 7 % (count / 5);
    const size_t third = first + count / 2 + turn * 11 % (count / 4);
    index[0] = chosen->index[first % count];
    index[1] = chosen->index[second % count];
    index[2] = chosen->index[third % count];
}

/* The best circle, and its median; false if there is none. */
static bool start(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle, double *median) {
    const start_t chosen = choose_samples(scan, circle->seen);
    *median = 1e9;
    for (size_t turn = 0; turn < START_CIRCLES; ++turn) {
        size_t index[3];
        wh_circle_t tried = *circle;
        choose_three(&chosen, turn, index);
        if (through_three(scan, rays, index, &tried)) {
            const double off = median_off(scan, rays, &chosen, &tried);
            if (off < *median) {
                *median = off;
                *circle = tried;
            }
        }
    }
    for (size_t k = 0; k < chosen.count; ++k) {
        rays[k].residual = 0;
    }
    return *median < 1;
}

/* -------------------------------------------------------------------------------------------------- steps */

/* The sums of one pass, their solution, and what it tells. */
typedef struct {
    wh_normal_t normal;
    double weights; /* their sum */
    double squares; /* weight times square, before the step */
    double step;    /* how far the centre or the radius moved, at most */
} pass_t;

/* Tukey's; 0 stays 0. */
static double weight_of(double residual, double cut) {
    const double part = residual / cut;
    const double rest = 1 - part * part;
    return rest > 0 ? rest * rest : 0;
}

/* Sums with the weights that the residuals have under `cut`, or with those that stand there (cut 0). */
static void add_up(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const wh_circle_t *circle, double cut,
                   pass_t *pass) {
    double xx = 0;
    double xy = 0;
    double xr = 0;
    double yy = 0;
    double yr = 0;
    double rr = 0;
    double x0 = 0;
    double y0 = 0;
    double r0 = 0;
    pass->weights = pass->squares = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        wh_rim_ray_t *ray = &rays[i];
        if (scan->points[i].sight != WH_SIGHT_RIM) {
            continue;
        }
        const double c = ray->cosine;
        const double s = ray->sine;
        const double q = scan->offset + circle->x * s - circle->y * c;
        const double root = sqrt(circle->radius * circle->radius - q * q);
        const double residual = scan->points[i].radius - (circle->x * c + circle->y * s + root);
        ray->residual = residual;
        if (cut > 0 && ray->weight > 0) {
            ray->weight = weight_of(residual, cut);
        }
        const double w = ray->weight;
        const double inverse = 1 / root;
        const double dx = c - q * inverse * s;
        const double dy = s + q * inverse * c;
        const double dr = circle->radius * inverse;
        xx += w * dx * dx;
        xy += w * dx * dy;
        xr += w * dx * dr;
        yy += w * dy * dy;
        yr += w * dy * dr;
        rr += w * dr * dr;
        x0 += w * dx * residual;
        y0 += w * dy * residual;
        r0 += w * dr * residual;
        pass->weights += w;
        pass->squares += w * residual * residual;
    }
    wh_normal_begin(&pass->normal, 3);
    const double sums[3][3] = {{xx, xy, xr}, {xy, yy, yr}, {xr, yr, rr}};
    const double right[3] = {x0, y0, r0};
    for (size_t i = 0; i < 3; ++i) {
        pass->normal.right[i] = right[i];
        for (size_t j = 0; j < 3; ++j) {
            pass->normal.matrix[i][j] = sums[i][j];
        }
    }
}

/* One step; false if the samples do not tell a circle. The squares are then those after the step. */
static bool step(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle, double cut,
                 pass_t *pass) {
    add_up(scan, rays, circle, cut, pass);
    const double right[3] = {pass->normal.right[0], pass->normal.right[1], pass->normal.right[2]};
    if (!(pass->weights > WH_SCAN_LEAST / 2) || !wh_normal_solve(&pass->normal)) {
        return false;
    }
    const double *by = pass->normal.right;
    pass->squares -= by[0] * right[0] + by[1] * right[1] + by[2] * right[2];
    pass->step = fabs(by[0]) > fabs(by[1]) ? fabs(by[0]) : fabs(by[1]);
    pass->step = fabs(by[2]) > pass->step ? fabs(by[2]) : pass->step;
    circle->x += by[0];
    circle->y += by[1];
    circle->radius += by[2];
    return circle->x * circle->x + circle->y * circle->y < circle->radius * circle->radius / 4;
}

static double scatter_of(const wh_rim_scan_t *scan, const pass_t *pass) {
    const double square = pass->squares / MEAN_SQUARE_SEEN / (pass->weights - 3);
    const double least = scan->pixel * scan->pixel / 12 + LEAST_SCATTER * LEAST_SCATTER;
    return sqrt(square > least ? square : least);
}

/* A sample that is off the circle does not count any more, nor do its neighbours. */
static void mask(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, double cut) {
    size_t after = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        if (scan->points[i].sight == WH_SIGHT_RIM && fabs(rays[i].residual) > cut) {
            for (size_t k = i < NEIGHBOURS ? 0 : i - NEIGHBOURS; k < i; ++k) {
                rays[k].weight = 0;
            }
            after = NEIGHBOURS + 1;
        }
        if (after > 0) {
            rays[i].weight = 0;
            --after;
        }
    }
}

/* ------------------------------------------------------------------------------------------------ the whole */

/* Sine and cosine of a step of at most SMALL_STEP turn the ray before; every FRESH rays both are new. */
#define SMALL_STEP 0.02
#define FRESH 32

static void turn_ray(const wh_rim_ray_t *before, double angle, wh_rim_ray_t *ray) {
    const double square = angle * angle;
    const double sine = angle * (1 - square / 6 * (1 - square / 20));
    const double versine = square / 2 * (1 - square / 12 * (1 - square / 30));
    ray->cosine = before->cosine - (before->cosine * versine + before->sine * sine);
    ray->sine = before->sine - (before->sine * versine - before->cosine * sine);
}

static void begin_rays(const wh_rim_scan_t *scan, wh_rim_ray_t *rays) {
    for (size_t i = 0; i < scan->count; ++i) {
        const wh_rim_point_t *point = &scan->points[i];
        const double by = i % FRESH == 0 ? 1 : point->angle - scan->points[i - 1].angle;
        if (fabs(by) < SMALL_STEP) {
            turn_ray(&rays[i - 1], by, &rays[i]);
        } else {
            wh_align_sin_cos(point->angle, &rays[i].sine, &rays[i].cosine);
        }
        rays[i].weight = point->sight == WH_SIGHT_RIM ? 1 : 0;
        rays[i].residual = 0;
    }
}

/* The start's circle becomes the fit's; the last pass and the scatter are handed on. */
static bool refine(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle, double median,
                   pass_t *pass) {
    const double least = sqrt(scan->pixel * scan->pixel / 12 + LEAST_SCATTER * LEAST_SCATTER);
    const double first = 1.4826 * median > least ? 1.4826 * median : least;
    if (!step(scan, rays, circle, CUT * first, pass)) {
        return false;
    }
    mask(scan, rays, CUT * first);
    if (!step(scan, rays, circle, CUT * scatter_of(scan, pass), pass)) {
        return false;
    }
    circle->scatter = scatter_of(scan, pass);
    for (int i = 0; i < STEPS; ++i) {
        if (!step(scan, rays, circle, 0, pass)) {
            return false;
        }
        if (pass->step < 1e-7) { /* the next one would be of its square */
            return true;
        }
    }
    return false;
}

static double root_of(double square) {
    return sqrt(square > 0 ? square : 0);
}

static void tell(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const pass_t *pass,
                 wh_circle_t *circle) {
    const double square = circle->scatter * circle->scatter;
    const double xx = pass->normal.matrix[0][0] * square;
    const double yy = pass->normal.matrix[1][1] * square;
    const double xy = pass->normal.matrix[0][1] * square;
    circle->sd_x = sqrt(xx);
    circle->sd_y = sqrt(yy);
    circle->sd_radius = sqrt(pass->normal.matrix[2][2] * square);
    circle->sd_centre = root_of((xx + yy) / 2 + root_of((xx - yy) * (xx - yy) / 4 + xy * xy));
    circle->used = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        circle->used += rays[i].weight > 0 ? 1 : 0;
    }
}

wh_status_t wh_circle_fit(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle) {
    if (scan == NULL || scan->points == NULL || rays == NULL || circle == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_circle_t fit = {0};
    const wh_status_t status = check_scan(scan, &fit.seen);
    if (status != WH_OK) {
        return status;
    }
    begin_rays(scan, rays);
    double median;
    pass_t pass;
    if (!start(scan, rays, &fit, &median) || !refine(scan, rays, &fit, median, &pass)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    tell(scan, rays, &pass, &fit);
    if (2 * fit.used < fit.seen) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    *circle = fit;
    return WH_OK;
}
