/* The rays of a scan, and the places where its rim is inside of its circle; internal to the room. */
#ifndef WH_ALIGN_RAYS_INTERNAL_H
#define WH_ALIGN_RAYS_INTERNAL_H

#include "angle_internal.h"
#include "circle.h"

/* Sets each ray's sine and cosine, and weight 1 if it sees the rim. */
void wh_rays_begin(const wh_rim_scan_t *scan, wh_rim_ray_t *rays) WH_SYMBOL(wh_rays_begin);

/* More dents than this are ignored. */
#define WH_DENTS 24

/* Neighbouring samples: `count` of them from `first` on; the scan's first sample follows its last one. */
typedef struct {
    size_t first, count;
    double depth; /* of the deepest sample that is not alone, mm */
} wh_dent_t;

typedef struct {
    wh_dent_t dents[WH_DENTS];
    size_t count;
    bool whole; /* no dent was left out */
} wh_dents_t;

/* A scan, its rays and its circle, as the fits of marks use them. `deepest`: a sample further in than this
 * is light through glass, or belongs to something else. */
typedef struct {
    const wh_rim_scan_t *scan;
    const wh_rim_ray_t *rays;
    const wh_circle_t *circle;
    double deepest;
} wh_scanned_t;

/* The place of a sample's rim, from the circle's centre. */
static inline void wh_scanned_place(const wh_scanned_t *of, size_t i, double *x, double *y) {
    const wh_rim_ray_t *ray = &of->rays[i];
    const double radius = of->scan->points[i].radius;
    *x = radius * ray->cosine - of->scan->offset * ray->sine - of->circle->x;
    *y = radius * ray->sine + of->scan->offset * ray->cosine - of->circle->y;
}

/* True if a sample sees the rim, and no deeper than a mark may be. */
static inline bool wh_scanned_counts(const wh_scanned_t *of, size_t i) {
    return of->scan->points[i].sight == WH_SIGHT_RIM && of->rays[i].residual > 0 - of->deepest;
}

/* The distance on the rim from one sample to the next, mm. */
static inline double wh_scanned_spacing(const wh_scanned_t *of) {
    const wh_rim_scan_t *scan = of->scan;
    const double turned = fabs(scan->points[scan->count - 1].angle - scan->points[0].angle);
    return turned * of->circle->radius / (double)(scan->count - 1);
}

/* True if a whole turn was scanned, and at most three samples do not see the rim. */
static inline bool wh_scanned_is_whole(const wh_scanned_t *of) {
    const wh_rim_scan_t *scan = of->scan;
    const double turned = fabs(scan->points[scan->count - 1].angle - scan->points[0].angle);
    return of->circle->seen + 3 >= scan->count &&
           turned * (double)(scan->count + 2) >= WH_ALIGN_TURN * (double)scan->count;
}

/* The dents of more than 6 standard deviations and 0.05 mm, in the order of the scan. */
wh_dents_t wh_dents_find(const wh_scanned_t *of) WH_SYMBOL(wh_dents_find);

#endif
