/* A notch's V by Gauss and Newton's steps, then each sample of the dent held against it. */
#include "angle_internal.h"
#include "marks.h"
#include "mismatch_internal.h"
#include "rays_internal.h"
#include "solve_internal.h"

/* The part of its depth in which a flank is straight, whatever SEMI M1 leaves open of its roundings. */
#define FLANK_FROM 0.08
#define FLANK_TO 0.70
/* What is known of the opening's half: more than the nominal one by this, give or take as much. */
#define HALF_OPENING_MORE (0.75 * WH_ALIGN_PI / 180)
#define HALF_OPENING_SD (0.75 * WH_ALIGN_PI / 180)
#define HALF_OPENING_LESS (0.5 * WH_ALIGN_PI / 180)
/* A dent less deep than this part of the nominal depth is no notch; by so much a notch's depth may be off,
 * mm, and half of its opening. */
#define DEEP 0.8
/* Samples that are farther apart, in depths, may all miss the part of a notch that is so deep. */
#define FINE 0.42
#define SHALLOWER 0.15
#define DEEPER 0.4
#define OPENING_OFF (2.2 * WH_ALIGN_PI / 180)
/* The bottom's radius is the nominal one, give or take this, mm. If the squares of flanks and bottom are so
 * many times noise's, that is no chance any more; if they are this part of what chance does once in a million
 * times (now once in ten thousand), it is a chip. */
#define BOTTOM_SD 0.08
#define CHANCE 1.5
#define CHIPPED 0.8
/* With samples so good, mm, no chip's curved sides pass for flanks, if it is as deep as a notch but for
 * this. */
#define SHARP 0.008
#define SHARP_SHALLOWER 0.03
/* Tukey's cut, in standard deviations, and how far a sample may be off the V. */
#define CUT 6
#define MAY_BE_OFF 4.5
#define MAY_BE_OFF_MM 0.002
/* A corner's rounding takes away at most so much. */
#define CORNER 0.03
/* Beside the notch the rim is looked at as far as this, mm. */
#define BESIDE 0.8
/* Samples of a notch through which light falls, at most. */
#define LIGHT 4
/* Steps, and the last one's length, mm; after so many of them it stands which samples are flanks, and their
 * weights, even if they come and go. */
#define STEPS 32
#define STILL 1e-11
#define CHOICES 26

/* Fitted values: the axis, from the circle's centre to the apex, half of the opening. */
typedef struct {
    double axis_x, axis_y;
    double apex;
    double half, sine, cosine;
    wh_normal_t normal;
    double step;
    size_t used;
    double inflation; /* of the squares of its deviations: more than 1 if the samples are off by more */
} vee_t;

/* What does not change: the scan, what is known beforehand. */
typedef struct {
    wh_scanned_t of;
    const wh_notch_shape_t *nominal;
    double half;    /* expected */
    double spacing; /* of samples on the rim, mm */
    bool glass;
} vee_search_t;

/* A sample against a V. */
typedef struct {
    double residual; /* how far the rim is outside of it, along the ray */
    double depth;    /* of the V below the circle there */
    double by[3];    /* the V's derivatives there: axis, apex, half */
    int side;
} vee_point_t;

typedef enum { IS_NONE, IS_DOUBTFUL, IS_NOTCH } finding_t;

static void set_half(vee_t *vee, double half) {
    vee->half = half;
    wh_align_sin_cos(half, &vee->sine, &vee->cosine);
}

/* From the bottom to the apex, with the nominal bottom. */
static double below_bottom(const vee_t *vee, const wh_notch_shape_t *nominal) {
    return nominal->bottom * (1 / vee->sine - 1);
}

static double depth_of(const vee_search_t *search, const vee_t *vee) {
    return search->of.circle->radius - vee->apex - below_bottom(vee, search->nominal);
}

static vee_point_t hold_against(const vee_search_t *search, const vee_t *vee, size_t i) {
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
    vee_point_t against;
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

static bool is_flank(const vee_point_t *against, double depth) {
    return against->depth >= FLANK_FROM * depth && against->depth <= FLANK_TO * depth;
}

/* The place in the scan of a dent's sample, or of one beside it. */
static size_t place_of(const wh_rim_scan_t *scan, const wh_dent_t *dent, size_t k, size_t before) {
    return (dent->first + scan->count - before + k) % scan->count;
}

/* --------------------------------------------------------------------------------------------- the fit */

/* From the dent's centroid and depth. */
static void begin(const vee_search_t *search, const wh_dent_t *dent, vee_t *vee) {
    double sum_x = 0;
    double sum_y = 0;
    for (size_t k = 0; k < dent->count; ++k) {
        const size_t i = place_of(search->of.scan, dent, k, 0);
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
    set_half(vee, search->half);
    vee->apex = search->of.circle->radius - dent->depth - below_bottom(vee, search->nominal);
}

static double tukey(double residual, double cut) {
    const double part = residual / cut;
    const double rest = 1 - part * part;
    return rest > 0 ? rest * rest : 0;
}

/* A step with a choice's flank samples under a cut. What is known of the opening counts as one more. */
static bool step(const vee_search_t *search, const wh_dent_t *dent, const vee_t *choice, double cut,
                 vee_t *vee) {
    const double sigma = search->of.circle->scatter;
    const double depth = depth_of(search, choice);
    wh_normal_begin(&vee->normal, 3);
    vee->used = 0;
    for (size_t k = 0; k < dent->count; ++k) {
        const size_t i = place_of(search->of.scan, dent, k, 0);
        if (wh_scanned_counts(&search->of, i)) {
            const vee_point_t against = hold_against(search, vee, i);
            const vee_point_t chosen = hold_against(search, choice, i);
            const double weight = is_flank(&chosen, depth) ? tukey(chosen.residual, cut) : 0;
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
    set_half(vee, vee->half + by[2]);
    vee->step = fabs(by[0]) * search->of.circle->radius + fabs(by[1]) + fabs(by[2]);
    return fabs(vee->half - search->half) < 1 && vee->step < 2;
}

static bool fit(const vee_search_t *search, const wh_dent_t *dent, vee_t *vee) {
    static const double cuts[] = {0.4, 0.15};
    const double last = CUT * search->of.circle->scatter;
    begin(search, dent, vee);
    vee_t choice = *vee;
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

/* A sample against the arc that rounds the V's bottom and touches both flanks. */
typedef struct {
    double residual;
    double by[4]; /* the arc's derivatives there: axis, apex, half, its radius */
} against_arc_t;

/* On the arc, not beside it on a flank. */
static bool is_on_arc(const vee_search_t *search, const vee_t *vee, double across) {
    return fabs(across) < search->nominal->bottom * vee->cosine;
}

static against_arc_t hold_against_arc(const vee_search_t *search, const vee_t *vee, size_t i) {
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
        const vee_point_t flank = hold_against(search, vee, i);
        against.residual = flank.residual;
        for (size_t p = 0; p < 3; ++p) {
            against.by[p] = flank.by[p];
        }
        against.by[3] = 0;
        return against;
    }
    /* Towards the centre of the arc, and the ray along that. */
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

/* One sample more for the fit that has the bottom, too, unless light fell through there. */
static bool add_rounded(const vee_search_t *search, const vee_t *vee, size_t i, wh_normal_t *normal,
                        double *squares) {
    const double sigma = search->of.circle->scatter;
    if (!wh_scanned_counts(&search->of, i) ||
        hold_against(search, vee, i).depth < FLANK_FROM * depth_of(search, vee)) {
        return false;
    }
    const against_arc_t against = hold_against_arc(search, vee, i);
    if (search->glass && against.residual < -CUT * sigma) {
        return false;
    }
    wh_normal_add(normal, against.by, against.residual, 1);
    *squares += against.residual * against.residual;
    return true;
}

/* Flanks and bottom by one V, all samples alike: a chip that looks like a flank leaves the bottom elsewhere.
 * Sets the inflation; false if it cannot be chance. What is known of opening and radius counts as two samples
 * more. */
static bool has_bottom(const vee_search_t *search, const wh_dent_t *dent, vee_t *vee) {
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
        const size_t i = place_of(search->of.scan, dent, k, 0);
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

/* ------------------------------------------------------------------------------------ is it the notch */

/* How wide the smallest notch is at a depth. */
static double least_width(const vee_search_t *search, double depth) {
    const wh_notch_shape_t *notch = search->nominal;
    const double above = notch->depth - depth;
    vee_t vee;
    set_half(&vee, notch->opening / 2 - HALF_OPENING_LESS);
    if (above > notch->bottom * (1 - vee.sine)) {
        return 2 * (above + below_bottom(&vee, notch)) * vee.sine / vee.cosine;
    }
    return 2 * sqrt(above * (2 * notch->bottom - above));
}

/* A notch may be in there, with chips at it or without: nowhere is the rim where a notch would have none. */
static bool may_hold_notch(const vee_search_t *search, const wh_dent_t *dent) {
    static const double levels[] = {0.25, 0.5, 0.75};
    const double may_be = 1 + 2 * MAY_BE_OFF * search->of.circle->scatter / search->spacing;
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; ++l) {
        const double depth = levels[l] * search->nominal->depth;
        size_t wide = 0;
        for (size_t k = 0; k < dent->count; ++k) {
            const size_t i = place_of(search->of.scan, dent, k, 0);
            const bool is_rim = search->of.scan->points[i].sight == WH_SIGHT_RIM;
            wide += is_rim && search->of.rays[i].residual > -depth ? 0 : 1;
        }
        if ((double)wide + may_be < least_width(search, depth) / search->spacing) {
            return false;
        }
    }
    return true;
}

/* What was seen of the samples of a dent and beside it. */
typedef struct {
    size_t on_side[2]; /* on a flank, as it should be */
    size_t light;      /* further in than it should be: through glass */
    size_t off;        /* elsewhere than it should be */
} vee_look_t;

/* A sample's deviation and that of the V there. */
static double may_be_off(const vee_search_t *search, const vee_t *vee, const vee_point_t *against) {
    double square = 1;
    for (size_t p = 0; p < 3; ++p) {
        for (size_t q = 0; q < 3; ++q) {
            square += against->by[p] * vee->normal.matrix[p][q] * against->by[q];
        }
    }
    return MAY_BE_OFF * search->of.circle->scatter * sqrt(square) + MAY_BE_OFF_MM;
}

/* How far below and above the V, or the circle where that is further in, a sample's rim may be. */
static void allow(const vee_point_t *against, double depth, double may_be, double *below, double *above) {
    *below = may_be;
    *above = may_be;
    if (against->depth < FLANK_FROM * depth) {
        *below += CORNER;
    } else if (against->depth > FLANK_TO * depth) {
        *above = against->depth - DEEP * FLANK_TO * depth;
    }
}

static void look_at(const vee_search_t *search, const vee_t *vee, size_t i, vee_look_t *look) {
    if (search->of.scan->points[i].sight != WH_SIGHT_RIM) {
        ++look->off;
        return;
    }
    const vee_point_t against = hold_against(search, vee, i);
    const double depth = depth_of(search, vee);
    const double off = against.depth < 0 ? search->of.rays[i].residual : against.residual;
    double below;
    double above;
    allow(&against, depth, may_be_off(search, vee, &against), &below, &above);
    if (off < -below && search->glass) {
        ++look->light;
    } else if (off < -below || off > above) {
        ++look->off;
    } else if (is_flank(&against, depth)) {
        ++look->on_side[against.side];
    }
}

static vee_look_t look_around(const vee_search_t *search, const wh_dent_t *dent, const vee_t *vee) {
    vee_look_t look = {{0, 0}, 0, 0};
    const size_t beside = (size_t)(BESIDE / search->spacing) + 2;
    for (size_t k = 0; k < dent->count + 2 * beside; ++k) {
        look_at(search, vee, place_of(search->of.scan, dent, k, beside), &look);
    }
    return look;
}

static bool has_flanks(const vee_search_t *search, const vee_look_t *look) {
    const size_t least = look->on_side[0] < look->on_side[1] ? look->on_side[0] : look->on_side[1];
    if (look->off > 0 || look->light > LIGHT) {
        return false;
    }
    return search->glass ? least >= 1 && look->on_side[0] + look->on_side[1] >= 3 : least >= 2;
}

/* As deep and as open as a notch. */
static bool has_shape(const vee_search_t *search, const vee_t *vee) {
    const double more = depth_of(search, vee) - search->nominal->depth;
    return more > -SHALLOWER && more < DEEPER && fabs(vee->half - search->half) < OPENING_OFF;
}

static finding_t judge(const vee_search_t *search, const wh_dent_t *dent, vee_t *vee) {
    if (!may_hold_notch(search, dent)) {
        return IS_NONE;
    }
    if (!fit(search, dent, vee)) {
        return IS_DOUBTFUL;
    }
    const vee_look_t look = look_around(search, dent, vee);
    if (has_flanks(search, &look) && has_shape(search, vee) && has_bottom(search, dent, vee)) {
        return IS_NOTCH;
    }
    return IS_DOUBTFUL;
}

/* ------------------------------------------------------------------------------------------ the whole */

static void tell(const vee_search_t *search, const vee_t *vee, wh_notch_t *notch) {
    const wh_circle_t *circle = search->of.circle;
    const double aside = circle->sd_centre / vee->apex;
    const double own = circle->scatter * circle->scatter * vee->normal.matrix[0][0] * vee->inflation;
    notch->direction = wh_align_atan2(vee->axis_y, vee->axis_x);
    notch->sd_direction = sqrt(own + aside * aside);
    notch->depth = depth_of(search, vee);
    notch->opening = 2 * vee->half;
    notch->used = vee->used;
}

/* How many dents are deep enough to be the notch, and what they are; the first notch. */
typedef struct {
    size_t deep;
    size_t counts[3];
    wh_notch_t first;
} tally_t;

static tally_t judge_all(const vee_search_t *search, const wh_dents_t *dents) {
    tally_t tally = {0, {0, 0, 0}, {0, 0, 0, 0, 0}};
    for (size_t d = 0; d < dents->count; ++d) {
        const wh_dent_t *dent = &dents->dents[d];
        if (dent->depth >= DEEP * search->nominal->depth) {
            vee_t vee;
            const finding_t finding = judge(search, dent, &vee);
            if (finding == IS_NOTCH && tally.counts[IS_NOTCH] == 0) {
                tell(search, &vee, &tally.first);
            }
            ++tally.counts[finding];
            ++tally.deep;
        }
    }
    return tally;
}

/* What may be a chipped notch is a chip if the notch cannot be one. */
static bool is_sharp(const vee_search_t *search, const tally_t *tally) {
    return search->of.circle->scatter <= SHARP &&
           tally->first.depth >= search->nominal->depth - SHARP_SHALLOWER;
}

/* What the dents say together. */
static wh_status_t conclude(const vee_search_t *search, const wh_dents_t *dents, const tally_t *tally) {
    if (tally->counts[IS_NOTCH] > 1) {
        return WH_STATUS_TWO_NOTCHES;
    }
    if (tally->counts[IS_NOTCH] == 1) {
        const bool is_one = tally->counts[IS_DOUBTFUL] == 0 || is_sharp(search, tally);
        return is_one && dents->whole ? WH_OK : WH_STATUS_NOTCH_NOT_SURE;
    }
    const bool fine = search->spacing <= FINE * search->nominal->depth;
    const bool may_be = tally->deep > 0 || !dents->whole || !fine || !wh_scanned_is_whole(&search->of);
    return may_be ? WH_STATUS_NOTCH_NOT_SURE : WH_STATUS_NO_NOTCH;
}

wh_status_t wh_notch_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_notch_shape_t *nominal, bool glass, wh_notch_t *notch) {
    const double deepest = glass ? nominal->depth + DEEPER + CUT * circle->scatter : circle->radius;
    vee_search_t search = {
        {scan, rays, circle, deepest}, nominal, nominal->opening / 2 + HALF_OPENING_MORE, 0, glass};
    search.spacing = wh_scanned_spacing(&search.of);
    const wh_dents_t dents = wh_dents_find(&search.of);
    const tally_t tally = judge_all(&search, &dents);
    const wh_status_t status = conclude(&search, &dents, &tally);
    if (status == WH_OK) {
        *notch = tally.first;
    }
    return status;
}
