/* A notch's V: its known values, the fit, and its bottom; internal to the room. */
#ifndef WH_ALIGN_VEE_INTERNAL_H
#define WH_ALIGN_VEE_INTERNAL_H

#include "marks.h"
#include "rays_internal.h"
#include "solve_internal.h"

/* The part of its depth in which a flank is straight, for all roundings that SEMI M1 allows. */
#define WH_VEE_FLANK_FROM 0.08
#define WH_VEE_FLANK_TO 0.70
/* Tukey's cut, in standard deviations. */
#define WH_VEE_CUT 6

/* Fitted values: the axis, from the circle's centre to the apex, half of the opening. */
typedef struct {
    double axis_x, axis_y;
    double apex;
    double half, sine, cosine;
    wh_normal_t normal;
    double step;
    size_t used;
    double inflation; /* of the squares of its deviations: more than 1 if the samples deviate more */
} wh_vee_t;

/* The constant values: the scan, and the values known beforehand. */
typedef struct {
    wh_scanned_t of;
    const wh_notch_shape_t *nominal;
    double half;    /* expected */
    double spacing; /* of samples on the rim, mm */
    bool glass;
} wh_vee_search_t;

/* A sample relative to a V. */
typedef struct {
    double residual; /* distance of the rim outside of it, along the ray */
    double depth;    /* of the V below the circle there */
    double by[3];    /* the V's derivatives there: axis, apex, half */
    int side;
} wh_vee_point_t;

static inline void wh_vee_set_half(wh_vee_t *vee, double half) {
    vee->half = half;
    wh_align_sin_cos(half, &vee->sine, &vee->cosine);
}

/* From the bottom to the apex, with the nominal bottom. */
static inline double wh_vee_below_bottom(const wh_vee_t *vee, const wh_notch_shape_t *nominal) {
    return nominal->bottom * (1 / vee->sine - 1);
}

static inline double wh_vee_depth(const wh_vee_search_t *search, const wh_vee_t *vee) {
    return search->of.circle->radius - vee->apex - wh_vee_below_bottom(vee, search->nominal);
}

static inline bool wh_vee_is_flank(const wh_vee_point_t *against, double depth) {
    return against->depth >= WH_VEE_FLANK_FROM * depth && against->depth <= WH_VEE_FLANK_TO * depth;
}

/* The place in the scan of a dent's sample, or of one beside it. */
static inline size_t wh_vee_place(const wh_rim_scan_t *scan, const wh_dent_t *dent, size_t k, size_t before) {
    return (dent->first + scan->count - before + k) % scan->count;
}

wh_vee_point_t wh_vee_hold_against(const wh_vee_search_t *search, const wh_vee_t *vee, size_t i)
    WH_SYMBOL(wh_vee_hold_against);

/* Fits the V of a dent. False, with meaningless numbers, if there is none. */
bool wh_vee_fit(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee) WH_SYMBOL(wh_vee_fit);

/* Fits flanks and bottom with one V, all samples with equal weight: a chip that looks like a flank has its
 * bottom at another place. Sets the inflation; false if it cannot be chance. The known opening and radius
 * count as two more samples. */
bool wh_vee_has_bottom(const wh_vee_search_t *search, const wh_dent_t *dent, wh_vee_t *vee)
    WH_SYMBOL(wh_vee_has_bottom);

#endif
