/* Fits a flat's chord by Gauss and Newton's steps, and finds the nominal flat that it is. */
#include "angle_internal.h"
#include "marks.h"
#include "rays_internal.h"
#include "solve_internal.h"

/* The largest deviation of a chord's length from the nominal one, mm, and of the angle between two
 * flats. */
#define LENGTH_OFF 3.5
#define DIRECTION_OFF (5 * WH_ALIGN_PI / 180)
/* Samples next to a flat's ends do not count. */
#define ENDS ((size_t)3)
#define LEAST_USED 12
#define CUT 6
#define STEPS 25

typedef struct {
    double axis_x, axis_y; /* to the middle of the chord */
    double height;         /* of the chord above the circle's centre */
    wh_normal_t normal;
    double step, weights, squares;
    size_t used;
} chord_t;

/* ------------------------------------------------------------------------------------------------ the fit */

static size_t place_of(const wh_rim_scan_t *scan, const wh_dent_t *dent, size_t k) {
    return (dent->first + k) % scan->count;
}

/* Begins with the middle of the dent, and the height of a chord between its ends. */
static void begin(const wh_scanned_t *of, const wh_dent_t *dent, chord_t *chord) {
    const wh_rim_ray_t *first = &of->rays[dent->first];
    const wh_rim_ray_t *last = &of->rays[place_of(of->scan, dent, dent->count - 1)];
    const double x = first->cosine + last->cosine;
    const double y = first->sine + last->sine;
    const double length = sqrt(x * x + y * y);
    chord->axis_x = x / length;
    chord->axis_y = y / length;
    chord->height = of->circle->radius * length / 2;
}

static void add(const wh_scanned_t *of, size_t i, double cut, chord_t *chord) {
    const wh_rim_ray_t *ray = &of->rays[i];
    double x;
    double y;
    wh_scanned_place(of, i, &x, &y);
    const double off = x * chord->axis_x + y * chord->axis_y - chord->height;
    const double slope = ray->cosine * chord->axis_x + ray->sine * chord->axis_y;
    const double residual = off / slope;
    const double part = residual / cut;
    if (fabs(part) < 1) {
        const double weight = (1 - part * part) * (1 - part * part);
        const double across = y * chord->axis_x - x * chord->axis_y;
        const double slope_by = ray->sine * chord->axis_x - ray->cosine * chord->axis_y;
        const double by[2] = {(residual * slope_by - across) / slope, 1 / slope};
        wh_normal_add(&chord->normal, by, residual, weight);
        chord->weights += weight;
        chord->squares += weight * residual * residual;
        ++chord->used;
    }
}

static bool step(const wh_scanned_t *of, const wh_dent_t *dent, double cut, chord_t *chord) {
    wh_normal_begin(&chord->normal, 2);
    chord->weights = 0;
    chord->squares = 0;
    chord->used = 0;
    for (size_t k = ENDS; k + ENDS < dent->count; ++k) {
        const size_t i = place_of(of->scan, dent, k);
        if (wh_scanned_counts(of, i)) {
            add(of, i, cut, chord);
        }
    }
    if (chord->used < LEAST_USED || !wh_normal_solve(&chord->normal)) {
        return false;
    }
    const double *by = chord->normal.right;
    wh_align_turn(by[0], &chord->axis_x, &chord->axis_y);
    chord->height += by[1];
    chord->step = fabs(by[0]) * of->circle->radius + fabs(by[1]);
    return chord->height > 0 && chord->height < of->circle->radius;
}

/* Fits a chord; true if most of the dent is on it. */
static bool fit(const wh_scanned_t *of, const wh_dent_t *dent, chord_t *chord) {
    static const double cuts[] = {2, 1, 0.3};
    const double last = CUT * of->circle->scatter;
    begin(of, dent, chord);
    for (size_t i = 0; i < STEPS; ++i) {
        if (!step(of, dent, i < 3 && cuts[i] > last ? cuts[i] : last, chord)) {
            return false;
        }
        if (i > 3 && chord->step < 1e-9) {
            const double square = of->circle->scatter * of->circle->scatter;
            return 10 * chord->used > 7 * (dent->count - 2 * ENDS) &&
                   chord->squares < 1.7 * square * chord->weights;
        }
    }
    return false;
}

static wh_flat_t tell(const wh_scanned_t *of, const chord_t *chord) {
    const wh_circle_t *circle = of->circle;
    const double radius = circle->radius;
    const double aside = circle->sd_centre / chord->height;
    const double own = circle->scatter * circle->scatter * chord->normal.matrix[0][0];
    wh_flat_t flat;
    flat.direction = wh_align_atan2(chord->axis_y, chord->axis_x);
    flat.sd_direction = sqrt(own + aside * aside);
    flat.length = 2 * sqrt(radius * radius - chord->height * chord->height);
    flat.used = chord->used;
    return flat;
}

/* ------------------------------------------------------------------------------------------------ which */

/* The nominal flat with this length; WH_RIM_FLATS if none fits, or more than one could. */
static size_t which(const wh_flat_shape_t *nominal, double length) {
    size_t found = WH_RIM_FLATS;
    for (size_t f = 0; f < WH_RIM_FLATS; ++f) {
        if (nominal[f].length > 0 && fabs(length - nominal[f].length) <= LENGTH_OFF) {
            if (found < WH_RIM_FLATS) {
                return WH_RIM_FLATS;
            }
            found = f;
        }
    }
    return found;
}

/* A dent of this width is a flat or something else of its size, and no chip. */
static bool is_wide(const wh_scanned_t *of, const wh_flat_shape_t *nominal, const wh_dent_t *dent) {
    double least = 1e9;
    for (size_t f = 0; f < WH_RIM_FLATS; ++f) {
        least = nominal[f].length > 0 && nominal[f].length < least ? nominal[f].length : least;
    }
    return (double)dent->count * wh_scanned_spacing(of) > 0.6 * least;
}

static bool agree(const wh_flat_shape_t *nominal, const wh_flat_t *flats) {
    if (flats[0].length == 0 || flats[1].length == 0) {
        return true;
    }
    const double wanted = nominal[1].direction - nominal[0].direction;
    return fabs(wh_align_wrap(flats[1].direction - flats[0].direction - wanted)) <= DIRECTION_OFF;
}

/* The flats found, and whether anything contradicts them. */
typedef struct {
    wh_flat_t flats[WH_RIM_FLATS];
    size_t count;
    bool sure;
} found_t;

static void judge(const wh_scanned_t *of, const wh_flat_shape_t *nominal, const wh_dent_t *dent,
                  found_t *found) {
    chord_t chord;
    if (!fit(of, dent, &chord)) {
        found->sure = false;
        return;
    }
    const wh_flat_t flat = tell(of, &chord);
    const size_t f = which(nominal, flat.length);
    if (f < WH_RIM_FLATS && found->flats[f].length == 0) {
        found->flats[f] = flat;
        ++found->count;
    } else {
        found->sure = false;
    }
}

wh_status_t wh_flats_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_flat_shape_t nominal[WH_RIM_FLATS], wh_flat_t flats[WH_RIM_FLATS]) {
    const wh_scanned_t of = {scan, rays, circle, circle->radius};
    const wh_dents_t dents = wh_dents_find(&of);
    found_t found = {{{0, 0, 0, 0}, {0, 0, 0, 0}}, 0, dents.whole};
    for (size_t d = 0; d < dents.count; ++d) {
        if (is_wide(&of, nominal, &dents.dents[d])) {
            judge(&of, nominal, &dents.dents[d], &found);
        }
    }
    if (found.count > 0 && found.sure && agree(nominal, found.flats)) {
        for (size_t f = 0; f < WH_RIM_FLATS; ++f) {
            flats[f] = found.flats[f];
        }
        return WH_OK;
    }
    const bool may_be = found.count > 0 || !found.sure || !wh_scanned_is_whole(&of);
    return may_be ? WH_STATUS_NOTCH_NOT_SURE : WH_STATUS_NO_NOTCH;
}
