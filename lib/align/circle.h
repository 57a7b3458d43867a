/* The circle of a scan: a wafer's centre and radius by the exact model, from any visible part of the rim.
 *
 * Along the line of a sensor that looks in direction a and passes the axis at the distance d to its left, a
 * circle of radius R about (x, y) ends at
 *
 *     rho(a) = p + sqrt(R^2 - q^2),   p = x cos a + y sin a,   q = d + x sin a - y cos a
 *
 * For d = 0 this is e cos(a - phi) + sqrt(R^2 - e^2 sin^2(a - phi)). The fit begins with the best of some
 * circles through three samples (the least of their two-fifth quantiles). So two fifths of the samples may
 * be off the circle: notch, flats, chips, light through glass. From there Gauss and Newton's steps minimise
 * the weighted squares, with Tukey's weights: a sample that is 6 standard deviations away, and its
 * neighbours, do not count. The standard deviations are those of independent noise. They are enlarged where
 * neighbouring samples deviate together, and where many count equal pixels because there is no noise. A
 * shape below a micrometre, such as a small saddle's, cannot be told from noise: with half of the turn
 * hidden it may move the centre by more than they say.
 */
#ifndef WH_ALIGN_CIRCLE_H
#define WH_ALIGN_CIRCLE_H

#include "sensing.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(circle);

/* The fewest samples that see the rim. */
#define WH_SCAN_LEAST 48

/* A scan. Angles strictly rise or fall, within one turn. */
typedef struct {
    const wh_rim_point_t *points;
    size_t count;  /* up to WH_SENSOR_SAMPLES */
    double offset; /* of the sensor's line, as assumed, -1 to 1 */
    double pixel;  /* a radius is a whole number of these, 0 to 0.1; 0: not rounded */
} wh_rim_scan_t;

/* The values that the fit keeps for each point, in the caller's memory. */
typedef struct {
    double cosine, sine; /* of its angle */
    double weight;       /* 0 to 1; 0 for a sample that does not see the rim or is off the circle */
    double residual;     /* distance of the rim outside of the fitted model, mm; 0 if it is not seen */
} wh_rim_ray_t;

typedef struct {
    double x, y;   /* chuck's frame, mm */
    double radius; /* mm */
    double sd_x, sd_y, sd_radius;
    double sd_centre; /* in the direction in which it is largest */
    double scatter;   /* standard deviation of a sample that counts, mm */
    double inflation; /* of their squares: 1, more if neighbours deviate, or are rounded, together */
    size_t seen;      /* samples that see the rim */
    size_t used;      /* samples that also count */
} wh_circle_t;

/* WH_OK; WH_STATUS_NULL_ARGUMENT; WH_STATUS_OUT_OF_RANGE for an offset or a count out of range;
 * WH_STATUS_OVERLAP for rays among the points;
 * WH_STATUS_TOO_FEW_SAMPLES: fewer than WH_SCAN_LEAST see the rim; WH_STATUS_BAD_SCAN: a number is NaN or
 * infinite, a sight is none, a radius is not from 1 to 1e3, angles are out of order or leave one turn, or
 * all samples are the same; WH_STATUS_CENTRE_NOT_SURE: no circle is near half of the samples, or what
 * remains has a shape of more than 0.03 mm. If it fails, `circle` is unchanged; `rays`, `count` of them,
 * are not. Cost for 3600 samples: about 200 us, of which a third are sines. */
wh_status_t wh_circle_fit(const wh_rim_scan_t *scan, wh_rim_ray_t *rays, wh_circle_t *circle)
    WH_SYMBOL(wh_circle_fit);

/* rho in the direction of a ray, by the model without a shape. */
double wh_circle_radius(const wh_circle_t *circle, double offset, double cosine, double sine)
    WH_SYMBOL(wh_circle_radius);

WH_HEADER_END

#endif
