/* A robust start on few samples, then weighted Gauss and Newton on all of them. */
#include "circle.h"

#include "angle_internal.h"
#include "rays_internal.h"
#include "solve_internal.h"

/* The start: circles through three samples of at most this number; the one with the least median is
 * taken. */
#define START_SAMPLES 96
#define START_CIRCLES 48
/* The most steps from there on the same samples. */
#define SETTLING 10
/* The most steps with constant weights. */
#define STEPS 6
/* Tukey's weight is 0 from this number of standard deviations on; for normal noise it then sees this part
 * of the mean square. */
#define CUT 6
#define MEAN_SQUARE_SEEN 0.8924
/* The least weight of all samples together. */
#define LEAST_WEIGHT 12
/* The least standard deviation of a sample, mm. */
#define LEAST_SCATTER 1e-5
/* Blocks of neighbouring samples. Their squares show more than noise from this multiple of noise on. */
#define BLOCKS 24
#define CHANCE 2
/* A shape of the rim that a bow or a saddle may leave, root mean square, mm. */
#define SHAPE 0.03
/* Noise spreads the pixels if at least this part of the samples deviates by more than this number of
 * them. */
#define SPREAD 0.02
#define BEYOND 1.25
/* This number of neighbours of a sample off the circle does not count. */
#define NEIGHBOURS 2

/* ---------------------------------------------------------------------------------- is it a scan at all */

static bool is_point(const wh_rim_point_t *point) {
    return wh_align_is_finite(point->angle) && fabs(point->angle) < 1e5 &&
           (unsigned)point->sight <= WH_SIGHT_COVERED &&
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

/* Returns false if one is not a valid point. It counts those that see the rim, and finds whether their
 * radii differ. */
static bool look_through(const wh_rim_scan_t *scan, size_t *seen, bool *differ) {
    double least = 1e9;
    double most = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        const wh_rim_point_t *point = &scan->points[i];
        if (!is_point(point)) {
            return false;
        }
        if (point->sight == WH_SIGHT_RIM) {
            ++*seen;
            least = point->radius < least ? point->radius : least;
            most = point->radius > most ? point->radius : most;
        }
    }
    *differ = most > least;
    return true;
}

static bool are_apart(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays) {
    const wh_extent_t points = {scan->points, scan->count * sizeof *scan->points};
    return !wh_extents_overlap(points, (wh_extent_t){rays, scan->count * sizeof *rays});
}

static bool is_in_range(const wh_rim_scan_t *scan) {
    return scan->count <= WH_SENSOR_SAMPLES && scan->offset >= -1 && scan->offset <= 1 && scan->pixel >= 0 &&
           scan->pixel <= 0.1;
}

static wh_status_t check_scan(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, size_t *seen) {
    if (!is_in_range(scan)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (!are_apart(scan, rays)) {
        return WH_STATUS_OVERLAP;
    }
    bool differ = false;
    if (!look_through(scan, seen, &differ)) {
        return WH_STATUS_BAD_SCAN;
    }
    if (*seen < WH_SCAN_LEAST) {
        return WH_STATUS_TOO_FEW_SAMPLES;
    }
    return differ && is_ordered(scan) ? WH_OK : WH_STATUS_BAD_SCAN;
}

/* ---------------------------------------------------------------------------------------------- the model */

double wh_circle_radius(const wh_circle_t *circle, double offset, double cosine, double sine) {
    const double p = circle->x * cosine + circle->y * sine;
    const double q = offset + circle->x * sine - circle->y * cosine;
    return p + sqrt(circle->radius * circle->radius - q * q);
}

/* ---------------------------------------------------------------------------------------------- the start */

/* Places of the start's samples in the scan. */
typedef struct {
    size_t count;
    uint16_t index[START_SAMPLES];
} start_t;

/* Chooses an even share of the samples that see the rim. */
static start_t choose_samples(const wh_rim_scan_t *scan, size_t seen) {
    start_t chosen;
    chosen.count = 0;
    const size_t wanted = seen < START_SAMPLES ? seen : START_SAMPLES;
    size_t passed = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        if (scan->points[i].sight != WH_SIGHT_RIM) {
            continue;
        }
        if (passed == chosen.count * seen / wanted) {
            chosen.index[chosen.count] = (uint16_t)i;
            ++chosen.count;
        }
        ++passed;
    }
    return chosen;
}

/* The place of a sample's rim, chuck's frame. */
static void place(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, size_t i, double *x, double *y) {
    *x = scan->points[i].radius * rays[i].cosine - scan->offset * rays[i].sine;
    *y = scan->points[i].radius * rays[i].sine + scan->offset * rays[i].cosine;
}

/* Returns false if the three are nearly on a line, or the circle does not enclose the axis. */
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

/* The k-th smallest of the first `count` residuals; it reorders them. */
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
            rays[i].residual = rays[j].residual;
            rays[j].residual = swap;
            ++i;
            --j;
        }
        if (k <= j) {
            high = j;
        } else {
            low = j + 1;
        }
    }
    return rays[k].residual;
}

/* The median distance of the chosen samples from a circle; residuals are used as memory. */
static double median_off(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const start_t *chosen,
                         const wh_circle_t *circle) {
    for (size_t k = 0; k < chosen->count; ++k) {
        const size_t i = chosen->index[k];
        const double rho = wh_circle_radius(circle, scan->offset, rays[i].cosine, rays[i].sine);
        const double off = fabs(scan->points[i].radius - rho);
        rays[k].residual = off - off == 0 ? off : 1e9;
    }
    return kth_residual(rays, chosen->count, chosen->count * 2 / 5);
}

/* Chooses three that are far from each other, and different ones each time. */
static void choose_three(const start_t *chosen, size_t turn, size_t index[3]) {
    const size_t count = chosen->count;
    const size_t first = turn * 37;
    const size_t second = first + count / 5 + turn * 7 % (count / 5);
    const size_t third = first + count / 2 + turn * 11 % (count / 4);
    index[0] = chosen->index[first % count];
    index[1] = chosen->index[second % count];
    index[2] = chosen->index[third % count];
}

/* Finds the best circle, and its median; false if there is none. */
static bool start(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const start_t *chosen, wh_circle_t *circle,
                  double *median) {
    *median = 1e9;
    for (size_t turn = 0; turn < START_CIRCLES; ++turn) {
        size_t index[3];
        wh_circle_t tried = *circle;
        choose_three(chosen, turn, index);
        if (through_three(scan, rays, index, &tried)) {
            const double off = median_off(scan, rays, chosen, &tried);
            if (off < *median) {
                *median = off;
                *circle = tried;
            }
        }
    }
    return *median < 1;
}

/* -------------------------------------------------------------------------------------------------- steps */

/* The sums of one pass, their solution, and its results. */
typedef struct {
    wh_normal_t normal;
    double weights; /* the sum of the weights */
    double squares; /* weight times square, before the step */
    double step;    /* the largest motion of the centre or the radius */
} pass_t;

/* Tukey's weight; 0 stays 0. */
static double weight_of(double residual, double cut) {
    const double part = residual / cut;
    const double rest = 1 - part * part;
    return rest > 0 ? rest * rest : 0;
}

static void begin(pass_t *pass) {
    wh_normal_begin(&pass->normal, 3);
    pass->weights = 0;
    pass->squares = 0;
}

/* Adds one sample, with the weight of its residual under `cut`, or (0) its present weight. */
static inline void add(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, size_t i, const wh_circle_t *circle,
                       double cut, pass_t *pass) {
    wh_rim_ray_t *ray = &rays[i];
    const double c = ray->cosine;
    const double s = ray->sine;
    const double q = scan->offset + circle->x * s - circle->y * c;
    const double root = sqrt(circle->radius * circle->radius - q * q);
    const double residual = scan->points[i].radius - (circle->x * c + circle->y * s + root);
    if (cut > 0) {
        ray->weight = weight_of(residual, cut);
    }
    ray->residual = residual;
    const double w = ray->weight;
    const double inverse = 1 / root;
    const double dx = c - q * inverse * s;
    const double dy = s + q * inverse * c;
    const double dr = circle->radius * inverse;
    wh_normal_t *normal = &pass->normal;
    normal->matrix[0][0] += w * dx * dx;
    normal->matrix[0][1] += w * dx * dy;
    normal->matrix[0][2] += w * dx * dr;
    normal->matrix[1][1] += w * dy * dy;
    normal->matrix[1][2] += w * dy * dr;
    normal->matrix[2][2] += w * dr * dr;
    normal->right[0] += w * dx * residual;
    normal->right[1] += w * dy * residual;
    normal->right[2] += w * dr * residual;
    pass->weights += w;
    pass->squares += w * residual * residual;
}

/* Takes the step of the sums; false if they give no circle. The squares are then those after the step. */
static bool step(wh_circle_t *circle, pass_t *pass) {
    const double right[3] = {pass->normal.right[0], pass->normal.right[1], pass->normal.right[2]};
    if (!(pass->weights > LEAST_WEIGHT) || !wh_normal_solve(&pass->normal)) {
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

/* Takes a step by all samples that see the rim. */
static bool step_all(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle, double cut,
                     pass_t *pass) {
    begin(pass);
    for (size_t i = 0; i < scan->count; ++i) {
        if (scan->points[i].sight == WH_SIGHT_RIM && rays[i].weight > 0) {
            add(scan, rays, i, circle, cut, pass);
        }
    }
    return step(circle, pass);
}

/* Takes a step by all of the start's samples. */
static bool step_chosen(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const start_t *chosen,
                        wh_circle_t *circle, double cut) {
    pass_t pass;
    begin(&pass);
    for (size_t k = 0; k < chosen->count; ++k) {
        add(scan, rays, chosen->index[k], circle, cut, &pass);
    }
    return step(circle, &pass);
}

static double least_scatter(const wh_rim_scan_t *scan) {
    return sqrt(scan->pixel * scan->pixel / 12 + LEAST_SCATTER * LEAST_SCATTER);
}

static double scatter_of(const wh_rim_scan_t *scan, const pass_t *pass) {
    const double square = pass->squares / MEAN_SQUARE_SEEN / (pass->weights - 3);
    const double least = least_scatter(scan);
    return square > least * least ? sqrt(square) : least;
}

/* The scatter from the median of the magnitudes, assuming a normal distribution. With a wafer in the middle
 * most samples may count equal pixels, and a circle through them has no median at all: a value within half
 * a pixel is not known. */
static double scatter_from(const wh_rim_scan_t *scan, double median) {
    const double least = scan->pixel / 2 + LEAST_SCATTER;
    return 1.907 * median > least ? 1.907 * median : least;
}

/* A sample off the circle no longer counts, nor do its neighbours. */
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

/* ---------------------------------------------------------------------------------------------- the whole */

/* The counting samples of those chosen move the circle while their median falls. */
static void settle(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, const start_t *chosen, wh_circle_t *circle,
                   double *median) {
    bool sinks = true;
    for (int i = 0; i < SETTLING && sinks; ++i) {
        wh_circle_t tried = *circle;
        sinks = step_chosen(scan, rays, chosen, &tried, CUT * scatter_from(scan, *median));
        const double off = sinks ? median_off(scan, rays, chosen, &tried) : *median;
        sinks = off < *median;
        if (sinks) {
            *circle = tried;
            *median = off;
        }
    }
    for (size_t k = 0; k < chosen->count; ++k) {
        rays[k].residual = 0; /* it was memory for the medians */
        rays[chosen->index[k]].weight = 1;
    }
}

/* Turns the start's circle into the fit's; passes on the last pass and the scatter. */
static bool refine(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle, double median,
                   pass_t *pass) {
    const double first = scatter_from(scan, median);
    if (!step_all(scan, rays, circle, CUT * first, pass)) {
        return false;
    }
    mask(scan, rays, CUT * first);
    if (!step_all(scan, rays, circle, CUT * scatter_of(scan, pass), pass)) {
        return false;
    }
    circle->scatter = scatter_of(scan, pass);
    for (int i = 0; i < STEPS; ++i) {
        if (!step_all(scan, rays, circle, 0, pass)) {
            return false;
        }
        if (pass->step < 1e-7) { /* the next step would be about its square */
            return true;
        }
    }
    return false;
}

static double root_of(double square) {
    return sqrt(square > 0 ? square : 0);
}

/* Sums of independent residuals have squares as large as the sum of the residuals' squares. Returns the
 * factor by which the sums of blocks have larger ones: 1 as long as that may be chance. */
static double inflation_of(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, size_t used) {
    const size_t size = used / BLOCKS + 1;
    double together = 0;
    double apart = 0;
    double block = 0;
    size_t in_block = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        const double weighted = rays[i].weight * rays[i].residual;
        apart += weighted * weighted;
        block += weighted;
        in_block += rays[i].weight > 0 ? 1 : 0;
        if (in_block == size || i + 1 == scan->count) {
            together += block * block;
            block = 0;
            in_block = 0;
        }
    }
    const double times = together * BLOCKS / (BLOCKS - 3);
    return times > CHANCE * apart ? times / apart : 1;
}

/* The rounding's share in the square of a sample's deviation. Where noise does not spread the pixels,
 * rounding follows the rim. The error of e cos(a), rounded to p, has a first harmonic of 2 p / pi times
 * Bessel's J1 of 2 pi e / p and its multiples: up to 0.37 p, and p sqrt(p / e) / 5 for a large e. A third
 * of its square counts. */
static double rounding_of(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle) {
    size_t off = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        off += rays[i].weight > 0 && fabs(rays[i].residual) > BEYOND * scan->pixel ? 1 : 0;
    }
    if (scan->pixel == 0 || (double)off >= SPREAD * (double)circle->used) {
        return 0;
    }
    const double far = sqrt(circle->x * circle->x + circle->y * circle->y) / scan->pixel;
    const double part = far > 0.3 ? 0.041 / far : 0.137;
    return part * scan->pixel * scan->pixel / 3 * (double)circle->used / 2;
}

/* The residuals are not noise: the circle is of something else, such as a rim and a flat. */
static bool has_shape(const wh_circle_t *circle) {
    const double size = (double)circle->used / BLOCKS + 1;
    return circle->scatter * circle->scatter * (circle->inflation - 1) > SHAPE * SHAPE * size;
}

/* Completes the last step: also gives the residuals of samples that do not count. */
static void complete(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle) {
    circle->used = 0;
    for (size_t i = 0; i < scan->count; ++i) {
        wh_rim_ray_t *ray = &rays[i];
        if (ray->weight > 0) {
            ++circle->used;
        } else if (scan->points[i].sight == WH_SIGHT_RIM) {
            const double rho = wh_circle_radius(circle, scan->offset, ray->cosine, ray->sine);
            ray->residual = scan->points[i].radius - rho;
        }
    }
}

static void tell(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const pass_t *pass,
                 wh_circle_t *circle) {
    const double sample = circle->scatter * circle->scatter;
    const double square = sample * circle->inflation + rounding_of(scan, rays, circle);
    circle->inflation = square / sample;
    const double xx = pass->normal.matrix[0][0] * square;
    const double yy = pass->normal.matrix[1][1] * square;
    const double xy = pass->normal.matrix[0][1] * square;
    circle->sd_x = sqrt(xx);
    circle->sd_y = sqrt(yy);
    circle->sd_radius = sqrt(pass->normal.matrix[2][2] * square);
    circle->sd_centre = root_of((xx + yy) / 2 + root_of((xx - yy) * (xx - yy) / 4 + xy * xy));
}

wh_status_t wh_circle_fit(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle) {
    if (scan == NULL || scan->points == NULL || rays == NULL || circle == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_circle_t fit = {0};
    const wh_status_t status = check_scan(scan, rays, &fit.seen);
    if (status != WH_OK) {
        return status;
    }
    wh_rays_begin(scan, rays);
    const start_t chosen = choose_samples(scan, fit.seen);
    double median;
    pass_t pass;
    if (!start(scan, rays, &chosen, &fit, &median)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    settle(scan, rays, &chosen, &fit, &median);
    if (!refine(scan, rays, &fit, median, &pass)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    complete(scan, rays, &fit);
    fit.inflation = inflation_of(scan, rays, fit.used);
    if (2 * fit.used < fit.seen || has_shape(&fit)) {
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    tell(scan, rays, &pass, &fit);
    *circle = fit;
    return WH_OK;
}
