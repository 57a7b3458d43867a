/* A notch's V by Gauss and Newton's steps, then flanks and bottom together. */
#include "vee_internal.h"

#include "angle_internal.h"
#include "mismatch_internal.h"

/* The standard deviation of the opening's half, known beforehand. */
#define HALF_OPENING_SD (0.75 * WH_ALIGN_PI / 180)
/* The bottom's radius is the nominal one, with this deviation, mm. If the squares of flanks and bottom are
 * this many times those of noise, that is not chance. If they are this part of the limit that chance exceeds
 * once in a million times (the part: once in ten thousand), it is a chip. */
#define BOTTOM_SD 0.08
#define CHANCE 1.5
#define CHIPPED 0.8
/* The most steps, and the last one's length, mm. After CHOICES steps the flank samples and their weights
 * are fixed, even if they would still change. */
#define STEPS 32
#define STILL 1e-11
#define CHOICES 26

wh_vee_point_t wh_vee_hold_against(const wh_vee_search_t *search, const wh_vee_t *vee, size_t i) {
    const wh_rim_ray_t *ray = &search->of.rays[i];
    double x;
    double y;
    wh_scanned_place(&search->of, i, &x, &y);
    const double along = x * vee->axis_x + y * vee->axis_y;
    const double across = y * vee->axis_x - x * vee->axis_y;
    const double ray_along = ray->cosine * vee->axis_x + ray->sine * vee->axis_y;
    const double ray_across = ray->sine * vee->axis_x - ray->cosine * vee->axis_y;
    const double k = across < 0 ? -1 : 1;
    const double ks = k * vee->sine;
    const double kc = k * vee->cosine;
    /* The flank's normal is (-ks, cosine); `off` is the distance from it, `slope` the ray's along it. */
    const double from_apex = along - vee->apex;
    const double off = vee->cosine * across - ks * from_apex;
    const double slope = vee->cosine * ray_across - ks * ray_along;
    wh_vee_point_t against;
    against.side = across < 0 ? 0 : 1;
    against.residual = off / slope;
    against.depth = against.residual - ray->residual;
    const double off_by[3] = {-ks * across - vee->cosine * along, ks, -kc * from_apex - vee->sine * across};
    const double slope_by[3] = {-ks * ray_across - vee->cosine * ray_along, 0,
                                -kc * ray_along - vee->sine * ray_across};
    for (size_t p = 0; p < 3; ++p) {
        against.by[p] = (against.residual * slope_by[p] - off_by[p]) / slope;
    }
    return against;
}

/* --------------------------------------------------------------------------------------------- the fit */

/* Begins with the dent's centroid and depth. */
static void begin(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee) {
    double sum_x = 0;
    double sum_y = 0;
    for (size_t k = 0; k < dent->count; ++k) {
        const size_t i = wh_vee_place(search->of.scan, dent, k, 0);
        if (wh_scanned_counts(&search->of, i)) {
            double x;
            double y;
            wh_scanned_place(&search->of, i, &x, &y);
            sum_x -= x * search->of.rays[i].residual;
            sum_y -= y * search->of.rays[i].residual;
        }
    }
    const double length = sqrt(sum_x * sum_x + sum_y * sum_y);
    vee->axis_x = sum_x / length;
    vee->axis_y = sum_y / length;
    wh_vee_set_half(vee, search->half);
    vee->apex = search->of.circle->radius - dent->depth - wh_vee_below_bottom(vee, search->nominal);
}

static double tukey(double residual, double cut) {
    const double part = residual / cut;
    const double rest = 1 - part * part;
    return rest > 0 ? rest * rest : 0;
}

/* Takes a step with a choice's flank samples under a cut. The known opening counts as one more sample. */
static bool step(const wh_vee_search_t *search, const wh_dent_t *dent, const wh_vee_t *choice, double cut,
                 wh_vee_t *vee) {
    const double sigma = search->of.circle->scatter;
    const double depth = wh_vee_depth(search, choice);
    wh_normal_begin(&vee->normal, 3);
    vee->used = 0;
    for (size_t k = 0; k < dent->count; ++k) {
        const size_t i = wh_vee_place(search->of.scan, dent, k, 0);
        if (wh_scanned_counts(&search->of, i)) {
            const wh_vee_point_t against = wh_vee_hold_against(search, vee, i);
            const wh_vee_point_t chosen = wh_vee_hold_against(search, choice, i);
            const double weight = wh_vee_is_flank(&chosen, depth) ? tukey(chosen.residual, cut) : 0;
            wh_normal_add(&vee->normal, against.by, against.residual, weight);
            vee->used += weight > 0 ? 1 : 0;
        }
    }
    const double known[3] = {0, 0, 1};
    const double part = sigma / HALF_OPENING_SD;
    wh_normal_add(&vee->normal, known, search->half - vee->half, part * part);
    if (vee->used < 2 || !wh_normal_solve(&vee->normal)) {
        return false;
    }
    const double *by = vee->normal.right;
    wh_align_turn(by[0], &vee->axis_x, &vee->axis_y);
    vee->apex += by[1];
    wh_vee_set_half(vee, vee->half + by[2]);
    vee->step = fabs(by[0]) * search->of.circle->radius + fabs(by[1]) + fabs(by[2]);
    return fabs(vee->half - search->half) < 1 && vee->step < 2;
}

bool wh_vee_fit(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee) {
    static const double cuts[] = {0.4, 0.15};
    const double last = WH_VEE_CUT * search->of.circle->scatter;
    begin(search, dent, vee);
    wh_vee_t choice = *vee;
    for (size_t i = 0; i < STEPS; ++i) {
        if (!step(search, dent, &choice, i < 2 && cuts[i] > last ? cuts[i] : last, vee)) {
            return false;
        }
        if (i > 2 && vee->step < STILL) {
            return true;
        }
        if (i < CHOICES) {
            choice = *vee;
        }
    }
    return false;
}

/* ---------------------------------------------------------------------------------- does the bottom agree */

/* A sample relative to the arc that rounds the V's bottom and touches both flanks. */
typedef struct {
    double residual;
    double by[4]; /* the arc's derivatives there: axis, apex, half, its radius */
} against_arc_t;

/* True on the arc, false beside it on a flank. */
static bool is_on_arc(const wh_vee_search_t *search, const wh_vee_t *vee, double across) {
    return fabs(across) < search->nominal->bottom * vee->cosine;
}

static against_arc_t hold_against_arc(const wh_vee_search_t *search, const wh_vee_t *vee, size_t i) {
    const wh_rim_ray_t *ray = &search->of.rays[i];
    const double radius = search->nominal->bottom;
    double x;
    double y;
    wh_scanned_place(&search->of, i, &x, &y);
    const double across = y * vee->axis_x - x * vee->axis_y;
    const double centre = vee->apex + radius / vee->sine;
    const double from_centre = x * vee->axis_x + y * vee->axis_y - centre;
    const double distance = sqrt(from_centre * from_centre + across * across);
    against_arc_t against;
    if (!is_on_arc(search, vee, across)) {
        const wh_vee_point_t flank = wh_vee_hold_against(search, vee, i);
        against.residual = flank.residual;
        for (size_t p = 0; p < 3; ++p) {
            against.by[p] = flank.by[p];
        }
        against.by[3] = 0;
        return against;
    }
    /* The direction towards the arc's centre, and the ray's part along it. */
    const double in = -from_centre / distance;
    const double aside = -across / distance;
    const double slope = in * (ray->cosine * vee->axis_x + ray->sine * vee->axis_y) +
                         aside * (ray->sine * vee->axis_x - ray->cosine * vee->axis_y);
    const double opens = radius * vee->cosine / (vee->sine * vee->sine);
    against.residual = (radius - distance) / slope;
    against.by[0] = aside * centre / slope;
    against.by[1] = in / slope;
    against.by[2] = -in * opens / slope;
    against.by[3] = (in / vee->sine - 1) / slope;
    return against;
}

/* Adds a sample to the fit with the bottom, unless light fell through there. */
static bool add_rounded(const wh_vee_search_t *search, const wh_vee_t *vee, size_t i, wh_normal_t *normal,
                        double *squares) {
    const double sigma = search->of.circle->scatter;
    if (!wh_scanned_counts(&search->of, i) ||
        wh_vee_hold_against(search, vee, i).depth < WH_VEE_FLANK_FROM * wh_vee_depth(search, vee)) {
        return false;
    }
    const against_arc_t against = hold_against_arc(search, vee, i);
    if (search->glass && against.residual < -WH_VEE_CUT * sigma) {
        return false;
    }
    wh_normal_add(normal, against.by, against.residual, 1);
    *squares += against.residual * against.residual;
    return true;
}

bool wh_vee_has_bottom(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee) {
    static const double opening[4] = {0, 0, 1, 0};
    static const double bottom[4] = {0, 0, 0, 1};
    const double sigma = search->of.circle->scatter;
    const double part = sigma / HALF_OPENING_SD * sigma / HALF_OPENING_SD;
    const double more = search->half - vee->half;
    double squares = part * more * more;
    size_t count = 0;
    wh_normal_t normal;
    wh_normal_begin(&normal, 4);
    wh_normal_add(&normal, opening, more, part);
    wh_normal_add(&normal, bottom, 0, sigma / BOTTOM_SD * sigma / BOTTOM_SD);
    for (size_t k = 0; k < dent->count; ++k) {
        const size_t i = wh_vee_place(search->of.scan, dent, k, 0);
        count += add_rounded(search, vee, i, &normal, &squares) ? 1 : 0;
    }
    double right[4];
    for (size_t p = 0; p < 4; ++p) {
        right[p] = normal.right[p];
    }
    if (count < 3 || !wh_normal_solve(&normal)) {
        return false;
    }
    for (size_t p = 0; p < 4; ++p) {
        squares -= normal.right[p] * right[p];
    }
    const double spare = (double)(count - 2);
    const double times = squares / (sigma * sigma * spare);
    vee->inflation = times > CHANCE ? times : 1;
    return times * spare <= CHIPPED * wh_mismatch_limit(spare);
}
