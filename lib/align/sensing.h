/* A line sensor beside a chuck: its readings of a wafer's rim while the chuck turns, and their meaning.
 *
 * The sensor's line lies in the chuck's plane. It points away from the chuck's axis and is dark as far as
 * the wafer extends: a sample is the number of dark pixels from its inner end. Sample k is due when the
 * chuck has turned by wh_sensor_angle(k), for either sign of k. So a turn can begin anywhere and go in
 * either direction, and stepping it slice by slice gives equal samples for any length of slice.
 *
 * The chuck's frame turns with the chuck and the wafer. At turn 0 it is the station's frame, in which the
 * sensor is fixed. Lengths are in mm, angles in rad, seen from above. It uses no heap and no state, and has
 * equal bits on every machine: noise is drawn by name and number (math/deviate.h).
 */
#ifndef WH_ALIGN_SENSING_H
#define WH_ALIGN_SENSING_H

#include "../math/deviate.h"
#include "rim.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(sensing);

#define WH_SENSOR_ARCS 8

/* The most samples of a turn. */
#define WH_SENSOR_SAMPLES 36000

/* Deviations from the drawing: the true ones, or those that a calibration assumes. */
typedef struct {
    double offset;  /* the line passes the axis at this distance, to the left of its direction, -1 to 1 */
    double zero;    /* its inner end is this much farther out, -1 to 1 */
    double gain;    /* its pixels are longer by this part of their length, -0.01 to 0.01 */
    double latency; /* a sample is taken this much later than the encoder's signal, s, -0.001 to 0.001 */
} wh_sensor_error_t;

/* A part of the chuck's frame, counter-clockwise from `from`. */
typedef struct {
    double from;  /* -2 pi to 2 pi */
    double width; /* above 0, up to 2 pi */
} wh_arc_t;

typedef struct {
    double direction; /* direction of the line from the axis, station's frame, -2 pi to 2 pi */
    double middle;    /* middle of the line, from the axis: the nominal wafer's radius, 10 to 300 */
    double length;    /* 2 to 100, at most twice the middle */
    double pixel;     /* 0.001 to 0.1 */
    int32_t samples;  /* in a turn, 90 to WH_SENSOR_SAMPLES */
    int32_t encoder;  /* counts in a turn, samples to 1e7: a sample waits for a count; 0: continuous */
    double noise;     /* of one sample, standard deviation, 0 to 0.1 */
    double tilt;      /* of the light against the vertical, outwards going up, -0.5 to 0.5 */
    wh_sensor_error_t error;
    wh_arc_t hidden[WH_SENSOR_ARCS]; /* a carrier covers the line here */
    int32_t hidden_count;            /* 0 to WH_SENSOR_ARCS */
} wh_sensor_t;

/* A moment at which a sample is taken. */
typedef struct {
    double turn;      /* of the chuck, by its encoder, |turn| up to 1e4 */
    double speed;     /* of the chuck, rad/s, |speed| up to 100 */
    wh_trial_t trial; /* names the noise: seed, and the scan */
    uint32_t index;   /* number of the sample in the scan */
} wh_glance_t;

/* The kind of a sample's reading. */
typedef enum WH_FOUR_BYTES {
    WH_SIGHT_RIM,     /* the rim is between the ends of the line */
    WH_SIGHT_NOTHING, /* no pixel is dark: the rim is further in, or there is no wafer */
    WH_SIGHT_COVERED  /* all are dark: the rim is further out, or something else covers the line */
} wh_sight_t;

/* One sample as the estimate uses it. */
typedef struct {
    double angle;  /* direction of the line, chuck's frame */
    double radius; /* to the rim, along the line from next to the axis; WH_SIGHT_RIM only */
    wh_sight_t sight;
} wh_rim_point_t;

/* 3600 samples, no encoder steps, pixels of 7 um, a line of 28 mm about a nominal wafer's rim; no error, no
 * noise, nothing hidden. Nothing is checked. */
wh_sensor_t wh_sensor_nominal(double wafer_radius) WH_SYMBOL(wh_sensor_nominal);

/* Returns WH_OK; otherwise `bad`, which may be null, gives the first wrong field, as for
 * wh_rim_validate. */
wh_status_t wh_sensor_validate(const wh_sensor_t *sensor, wh_bad_field_t *bad) WH_SYMBOL(wh_sensor_validate);

/* The number of pixels of the line: the reading of a covered one. wh_sensor_validate must accept the sensor
 * for the functions below, and numbers must be within the ranges above; nothing is checked. */
int32_t wh_sensor_pixels(const wh_sensor_t *sensor) WH_SYMBOL(wh_sensor_pixels);

/* The chuck's turn at which sample k is due: k / samples of a turn, at the first count of the encoder from
 * there on. |k| is up to 1e9. */
double wh_sensor_angle(const wh_sensor_t *sensor, int64_t k) WH_SYMBOL(wh_sensor_angle);

/* The number of samples that are due on the chuck's way from a turn, which is excluded, to another, which
 * is included. *first is the earliest of them: going up they are first, first + 1, ..., going down first,
 * first - 1, .... If there are none *first is unchanged. */
size_t wh_sensor_due(const wh_sensor_t *sensor, double from, double to, int64_t *first)
    WH_SYMBOL(wh_sensor_due);

/* The sample: dark pixels, 0 to wh_sensor_pixels. `placement` is the wafer's, in the chuck's frame. Glass
 * (rim->transmission t) is seen with the noise divided by 1 - t. In a part t / 20 of the samples light
 * falls through it at some place, and the sample ends there. Cost: wh_rim_distance, and 100 ns for
 * noise. */
int32_t wh_sensor_read(const wh_sensor_t *sensor, const wh_rim_t *rim, const wh_placement_t *placement,
                       const wh_glance_t *glance) WH_SYMBOL(wh_sensor_read);

/* A sample as a point, minus the errors that a calibration assumes (null: none). The offset stays in,
 * because the estimate takes it. It uses the sensor's direction, middle, length and pixel, and the glance's
 * turn and speed: values that a controller knows. */
wh_rim_point_t wh_sensor_point(const wh_sensor_t *sensor, const wh_sensor_error_t *believed,
                               const wh_glance_t *glance, int32_t sample) WH_SYMBOL(wh_sensor_point);

WH_HEADER_END

#endif
