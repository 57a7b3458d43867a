/* Finds the notch among the dents: compares each sample of a dent, and beside it, with the dent's V. */
#include "angle_internal.h"
#include "vee_internal.h"

/* The known half of the opening: larger than the nominal one by this. */
#define HALF_OPENING_MORE (0.75 * WH_ALIGN_PI / 180)
#define HALF_OPENING_LESS (0.5 * WH_ALIGN_PI / 180)
/* A dent less deep than this part of the nominal depth is not a notch. A notch's depth may deviate by
 * this, mm, and half of its opening by this. */
#define DEEP 0.8
/* Samples that are farther apart than this, in depths, may all miss the part of a notch with this depth. */
#define FINE 0.42
#define SHALLOWER 0.15
#define DEEPER 0.4
#define OPENING_OFF (2.2 * WH_ALIGN_PI / 180)
/* With a scatter up to this, mm, the curved sides of a chip do not look like flanks, if it is as deep
 * as a notch to within SHARP_SHALLOWER. */
#define SHARP 0.008
#define SHARP_SHALLOWER 0.03
/* The largest deviation of a sample from the V: in standard deviations, and a further one in mm. */
#define MAY_BE_OFF 4.5
#define MAY_BE_OFF_MM 0.002
/* A corner's rounding takes away at most this. */
#define CORNER 0.03
/* Beside the notch the rim is examined up to this distance, mm. */
#define BESIDE 0.8
/* The most samples of a notch through which light falls. */
#define LIGHT 4

/* ------------------------------------------------------------------------------------ is it the notch */

/* The width of the smallest notch at a depth. */
static double least_width(const wh_vee_search_t *search, double depth) {
    const wh_notch_shape_t *notch = search->nominal;
    const double above = notch->depth - depth;
    wh_vee_t vee;
    wh_vee_set_half(&vee, notch->opening / 2 - HALF_OPENING_LESS);
    if (above > notch->bottom * (1 - vee.sine)) {
        return 2 * (above + wh_vee_below_bottom(&vee, notch)) * vee.sine / vee.cosine;
    }
    return 2 * sqrt(above * (2 * notch->bottom - above));
}

/* True if a notch may be in the dent, with or without chips: the dent has no rim where a notch would have
 * none. */
static bool may_hold_notch(const wh_vee_search_t *search, const wh_dent_t *dent, wh_notch_seen_t *seen) {
    static const double levels[] = {0.25, 0.5, 0.75};
    const double may_be = 1 + 2 * MAY_BE_OFF * search->of.circle->scatter / search->spacing;
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; ++l) {
        const double depth = levels[l] * search->nominal->depth;
        size_t wide = 0;
        for (size_t k = 0; k < dent->count; ++k) {
            const size_t i = wh_vee_place(search->of.scan, dent, k, 0);
            const bool is_rim = search->of.scan->points[i].sight == WH_SIGHT_RIM;
            wide += is_rim && search->of.rays[i].residual > -depth ? 0 : 1;
        }
        const double least = least_width(search, depth);
        if ((double)wide + may_be < least / search->spacing) {
            seen->narrow_at = depth;
            seen->width = (double)wide * search->spacing;
            seen->width_least = least;
            return false;
        }
    }
    return true;
}

/* Counts of the samples of a dent and beside it. */
typedef struct {
    size_t on_side[2]; /* on a flank, as expected */
    size_t light;      /* further in than expected: through glass */
    size_t off;        /* at another unexpected place */
} vee_look_t;

/* The deviation of a sample, and of the V there. */
static double may_be_off(const wh_vee_search_t *search, const wh_vee_t *vee, const wh_vee_point_t *against) {
    double square = 1;
    for (size_t p = 0; p < 3; ++p) {
        for (size_t q = 0; q < 3; ++q) {
            square += against->by[p] * vee->normal.matrix[p][q] * against->by[q];
        }
    }
    return MAY_BE_OFF * search->of.circle->scatter * sqrt(square) + MAY_BE_OFF_MM;
}

/* The allowed distance of a sample's rim below and above the V, or the circle if that is further in. */
static void allow(const wh_vee_point_t *against, double depth, double may_be, double *below, double *above) {
    *below = may_be;
    *above = may_be;
    if (against->depth < WH_VEE_FLANK_FROM * depth) {
        *below += CORNER;
    } else if (against->depth > WH_VEE_FLANK_TO * depth) {
        *above = against->depth - DEEP * WH_VEE_FLANK_TO * depth;
    }
}

static void look_at(const wh_vee_search_t *search, const wh_vee_t *vee, size_t i, vee_look_t *look) {
    if (search->of.scan->points[i].sight != WH_SIGHT_RIM) {
        ++look->off;
        return;
    }
    const wh_vee_point_t against = wh_vee_hold_against(search, vee, i);
    const double depth = wh_vee_depth(search, vee);
    const double off = against.depth < 0 ? search->of.rays[i].residual : against.residual;
    double below;
    double above;
    allow(&against, depth, may_be_off(search, vee, &against), &below, &above);
    if (off < -below && search->glass) {
        ++look->light;
    } else if (off < -below || off > above) {
        ++look->off;
    } else if (wh_vee_is_flank(&against, depth)) {
        ++look->on_side[against.side];
    }
}

static vee_look_t look_around(const wh_vee_search_t *search, const wh_dent_t *dent, const wh_vee_t *vee) {
    vee_look_t look = {{0, 0}, 0, 0};
    const size_t beside = (size_t)(BESIDE / search->spacing) + 2;
    for (size_t k = 0; k < dent->count + 2 * beside; ++k) {
        look_at(search, vee, wh_vee_place(search->of.scan, dent, k, beside), &look);
    }
    return look;
}

/* True if no sample contradicts a notch. */
static bool is_clean(const vee_look_t *look) {
    return look->off == 0 && look->light <= LIGHT;
}

static bool has_flanks(const wh_vee_search_t *search, const vee_look_t *look) {
    const size_t least = look->on_side[0] < look->on_side[1] ? look->on_side[0] : look->on_side[1];
    return search->glass ? least >= 1 && look->on_side[0] + look->on_side[1] > WH_NOTCH_FLANK_LEAST
                         : least >= WH_NOTCH_FLANK_LEAST;
}

/* True if depth and opening fit a notch. */
static bool has_shape(const wh_vee_search_t *search, const wh_vee_t *vee) {
    const double more = wh_vee_depth(search, vee) - search->nominal->depth;
    return more > -SHALLOWER && more < DEEPER && fabs(vee->half - search->half) < OPENING_OFF;
}

/* NONE: it has rim where a notch would have none. DOUBTFUL: it is a chip, or a chipped notch. UNSEEN: it has
 * too few samples. */
typedef enum { IS_NONE, IS_DOUBTFUL, IS_UNSEEN, IS_NOTCH } finding_t;
#define FINDINGS 4

/* True if a flank may have fewer samples than it needs, depending on their places. */
static bool is_coarse(const wh_vee_search_t *search) {
    wh_vee_t vee;
    wh_vee_set_half(&vee, search->nominal->opening / 2);
    const double flank =
        (WH_VEE_FLANK_TO - WH_VEE_FLANK_FROM) * search->nominal->depth * vee.sine / vee.cosine;
    return search->spacing * WH_NOTCH_FLANK_LEAST > flank;
}

static finding_t judge(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee,
                       wh_notch_seen_t *seen) {
    seen->depth = dent->depth;
    if (!may_hold_notch(search, dent, seen)) {
        return IS_NONE;
    }
    const finding_t doubt = is_coarse(search) ? IS_UNSEEN : IS_DOUBTFUL;
    if (!wh_vee_fit(search, dent, vee)) {
        return doubt;
    }
    const vee_look_t look = look_around(search, dent, vee);
    seen->depth = wh_vee_depth(search, vee);
    seen->flanks[0] = look.on_side[0];
    seen->flanks[1] = look.on_side[1];
    seen->off = look.off + look.light;
    if (!is_clean(&look)) {
        return doubt;
    }
    if (!has_flanks(search, &look)) {
        return IS_UNSEEN;
    }
    return has_shape(search, vee) && wh_vee_has_bottom(search, dent, vee) ? IS_NOTCH : doubt;
}

/* ------------------------------------------------------------------------------------------ the whole */

static void tell(const wh_vee_search_t *search, const wh_vee_t *vee, wh_notch_t *notch) {
    const wh_circle_t *circle = search->of.circle;
    const double aside = circle->sd_centre / vee->apex;
    const double own = circle->scatter * circle->scatter * vee->normal.matrix[0][0] * vee->inflation;
    notch->direction = wh_align_atan2(vee->axis_y, vee->axis_x);
    notch->sd_direction = sqrt(own + aside * aside);
    notch->depth = wh_vee_depth(search, vee);
    notch->opening = 2 * vee->half;
    notch->used = vee->used;
}

/* The number of dents deep enough for a notch, counts by finding, the first notch, and the data of the dent
 * most like one. */
typedef struct {
    size_t deep;
    size_t counts[FINDINGS];
    wh_notch_t first;
    finding_t likest;
    wh_notch_seen_t seen;
} tally_t;

static void see(tally_t *tally, finding_t finding, const wh_notch_seen_t *seen) {
    if (finding > tally->likest || (finding == tally->likest && seen->depth > tally->seen.depth)) {
        tally->likest = finding;
        tally->seen = *seen;
    }
}

static void judge_all(const wh_vee_search_t *search, const wh_dents_t *dents, tally_t *tally) {
    const double depth = search->nominal->depth;
    const wh_notch_seen_t none = {0, depth - SHALLOWER, depth + DEEPER, {0, 0}, 0, 0, 0, 0};
    *tally = (tally_t){0, {0, 0, 0, 0}, {0, 0, 0, 0, 0}, IS_NONE, none};
    for (size_t d = 0; d < dents->count; ++d) {
        const wh_dent_t *dent = &dents->dents[d];
        wh_notch_seen_t seen = none;
        finding_t finding = IS_NONE;
        seen.depth = dent->depth;
        if (dent->depth >= DEEP * depth) {
            wh_vee_t vee;
            finding = judge(search, dent, &vee, &seen);
            if (finding == IS_NOTCH && tally->counts[IS_NOTCH] == 0) {
                tell(search, &vee, &tally->first);
            }
            ++tally->counts[finding];
            ++tally->deep;
        }
        see(tally, finding, &seen);
    }
}

/* True if the found notch cannot be a chip: a possible chipped notch is then a chip. */
static bool is_sharp(const wh_vee_search_t *search, const tally_t *tally) {
    return search->of.circle->scatter <= SHARP &&
           tally->first.depth >= search->nominal->depth - SHARP_SHALLOWER;
}

/* True if no other dent may be the notch. */
static bool is_alone(const wh_vee_search_t *search, const wh_dents_t *dents, const tally_t *tally) {
    return dents->whole && tally->counts[IS_UNSEEN] == 0 &&
           (tally->counts[IS_DOUBTFUL] == 0 || is_sharp(search, tally));
}

/* The verdict from all dents. */
static wh_status_t conclude(const wh_vee_search_t *search, const wh_dents_t *dents, const tally_t *tally) {
    if (tally->counts[IS_NOTCH] > 1) {
        return WH_STATUS_TWO_NOTCHES;
    }
    if (tally->counts[IS_NOTCH] == 1) {
        return is_alone(search, dents, tally) ? WH_OK : WH_STATUS_NOTCH_NOT_SURE;
    }
    const bool fine = search->spacing <= FINE * search->nominal->depth;
    const bool may_be = tally->deep > 0 || !dents->whole || !fine || !wh_scanned_is_whole(&search->of);
    return may_be ? WH_STATUS_NOTCH_NOT_SURE : WH_STATUS_NO_NOTCH;
}

wh_status_t wh_notch_find(const wh_rim_scan_t *scan, const wh_rim_ray_t *rays, const wh_circle_t *circle,
                          const wh_notch_shape_t *nominal, bool glass, wh_notch_t *notch,
                          wh_notch_seen_t *seen) {
    const double deepest = glass ? nominal->depth + DEEPER + WH_VEE_CUT * circle->scatter : circle->radius;
    wh_vee_search_t search = {
        {scan, rays, circle, deepest}, nominal, nominal->opening / 2 + HALF_OPENING_MORE, 0, glass};
    search.spacing = wh_scanned_spacing(&search.of);
    const wh_dents_t dents = wh_dents_find(&search.of);
    tally_t tally;
    judge_all(&search, &dents, &tally);
    const wh_status_t status = conclude(&search, &dents, &tally);
    *seen = tally.seen;
    if (status == WH_OK) {
        *notch = tally.first;
    }
    return status;
}
