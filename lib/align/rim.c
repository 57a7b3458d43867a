/* The outline in pieces, each at the place where a ray from the centre meets it, and the point where a line
 * leaves it. */
#include "rim.h"

#include <string.h>

#include "../math/hash.h"
#include "angle_internal.h"
#include "check_internal.h"

/* From this radius on wafers have a notch, mm; below, flats of these lengths. */
#define LEAST_NOTCHED 100

static const struct {
    double radius, length;
} primary_flats[] = {{75, 57.5}, {62.5, 42.5}, {50, 32.5}, {38.1, 22.22}, {0, 15.88}};

wh_rim_t wh_rim_nominal(double radius) {
    wh_rim_t rim = {.radius = radius};
    if (radius >= LEAST_NOTCHED) {
        const wh_notch_shape_t notch = {0, 1.0, WH_ALIGN_PI / 2, 0.9, 0.1};
        rim.notch = notch;
    } else {
        size_t size = 0;
        while (radius < primary_flats[size].radius) {
            ++size;
        }
        rim.flats[0].length = primary_flats[size].length;
    }
    return rim;
}

/* ------------------------------------------------------------------------------------------- the notch */

/* One half of a notch in the frame of its axis: x outwards, y >= 0 across. The flank begins at the apex,
 * where both flanks would meet, and goes along (cosine, sine). */
typedef struct {
    double cosine, sine;
    double apex;          /* its x; y is 0 */
    double bottom_centre; /* its x; y is 0 */
    double low, high;     /* the straight part of the flank, from the apex */
    double corner_x, corner_y;
} outline_t;

static outline_t notch_outline(const wh_rim_t *rim) {
    const wh_notch_shape_t *notch = &rim->notch;
    outline_t o;
    wh_align_sin_cos(notch->opening / 2, &o.sine, &o.cosine);
    o.bottom_centre = rim->radius - notch->depth + notch->bottom;
    o.apex = o.bottom_centre - notch->bottom / o.sine;
    o.low = notch->bottom * o.cosine / o.sine;
    /* The corner's centre has the distance `corner` from the flank and from the circle, inside the
     * wafer. */
    const double reach = rim->radius - notch->corner;
    const double along = o.apex * o.cosine;
    const double x = o.apex - notch->corner * o.sine;
    const double y = notch->corner * o.cosine;
    const double root = along * along - (x * x + y * y) + reach * reach;
    o.high = sqrt(root > 0 ? root : 0) - along;
    o.corner_x = x + o.high * o.cosine;
    o.corner_y = y + o.high * o.sine;
    return o;
}

/* The point's distance to the left of the ray (cosine, sine), times its distance. */
static double left_of(double cosine, double sine, double x, double y) {
    return cosine * y - sine * x;
}

static double notch_radius(const wh_rim_t *rim, double aside) {
    const wh_notch_shape_t *notch = &rim->notch;
    const outline_t o = notch_outline(rim);
    double s;
    double c;
    wh_align_sin_cos(aside, &s, &c);
    if (left_of(c, s, o.corner_x, o.corner_y) <= 0) {
        return rim->radius;
    }
    if (left_of(c, s, o.apex + o.high * o.cosine, o.high * o.sine) <= 0) {
        const double miss = left_of(c, s, o.corner_x, o.corner_y);
        const double square = notch->corner * notch->corner - miss * miss;
        return c * o.corner_x + s * o.corner_y + sqrt(square > 0 ? square : 0);
    }
    if (left_of(c, s, o.apex + o.low * o.cosine, o.low * o.sine) <= 0) {
        return o.apex * o.sine / (o.sine * c - o.cosine * s);
    }
    const double miss = s * o.bottom_centre;
    return c * o.bottom_centre - sqrt(notch->bottom * notch->bottom - miss * miss);
}

/* Beyond this angle from its axis there is certainly no notch. */
static double notch_reach(const wh_rim_t *rim) {
    return 3 * (rim->notch.depth + rim->notch.bottom + rim->notch.corner) / rim->radius;
}

/* -------------------------------------------------------------------------------------------- the whole */

static double flat_radius(const wh_rim_t *rim, const wh_flat_shape_t *flat, double aside) {
    double s;
    double c;
    wh_align_sin_cos(aside, &s, &c);
    const double height = sqrt(rim->radius * rim->radius - flat->length * flat->length / 4);
    return c * rim->radius > height ? height / c : rim->radius;
}

/* The distance in the wafer's own plane. */
static double flat_out_radius(const wh_rim_t *rim, double direction) {
    double least = rim->radius;
    if (rim->notch.depth > 0) {
        const double aside = fabs(wh_align_wrap(direction - rim->notch.direction));
        if (aside < notch_reach(rim)) {
            least = notch_radius(rim, aside);
        }
    }
    for (size_t f = 0; f < WH_RIM_FLATS; ++f) {
        if (rim->flats[f].length > 0) {
            const double aside = wh_align_wrap(direction - rim->flats[f].direction);
            const double radius = flat_radius(rim, &rim->flats[f], aside);
            least = radius < least ? radius : least;
        }
    }
    for (int32_t i = 0; i < rim->chip_count; ++i) {
        const wh_chip_t *chip = &rim->chips[i];
        const double part = 2 * rim->radius * wh_align_wrap(direction - chip->direction) / chip->width;
        const double radius = rim->radius - chip->depth * (1 - part * part);
        least = radius < least ? radius : least;
    }
    return least;
}

double wh_rim_height(const wh_rim_t *rim, double direction) {
    if (rim->saddle == 0) {
        return rim->bow;
    }
    double s;
    double c;
    wh_align_sin_cos(2 * (direction - rim->saddle_direction), &s, &c);
    return rim->bow + rim->saddle * c;
}

/* A radius that rises as z = h (r / R)^2 looks shorter by 2 h^2 / (3 R) from above. */
double wh_rim_radius(const wh_rim_t *rim, double direction) {
    const double radius = flat_out_radius(rim, direction);
    const double height = wh_rim_height(rim, direction);
    return height == 0 ? radius : radius - 2 * height * height / (3 * rim->radius);
}

/* A line that begins at its point nearest to the axis, seen from the wafer's centre and e1. */
typedef struct {
    double x, y, cosine, sine;
} line_t;

/* The distance of the line's point outside of the rim. */
static double outside(const wh_rim_t *rim, const line_t *line, double distance) {
    const double x = line->x + distance * line->cosine;
    const double y = line->y + distance * line->sine;
    return sqrt(x * x + y * y) - wh_rim_radius(rim, wh_align_atan2(y, x));
}

/* The root between a point inside and one outside, by the rule of Illinois. */
static double way_out(const wh_rim_t *rim, const line_t *line, double from, double over) {
    double far = from;
    double far_outside = over;
    double step = 2 * over + 0.01;
    double near = far - step;
    double inside = outside(rim, line, near);
    for (int i = 0; i < 12 && inside > 0; ++i) {
        far = near;
        far_outside = inside;
        step *= 2;
        near -= step;
        inside = outside(rim, line, near);
    }
    int side = 0;
    for (int i = 0; i < 100 && far - near > 1e-10; ++i) {
        const double middle = (near * far_outside - far * inside) / (far_outside - inside);
        const double value = outside(rim, line, middle);
        if (value == 0) {
            return middle;
        }
        if (value > 0) {
            inside = side > 0 ? inside / 2 : inside;
            far = middle;
            far_outside = value;
            side = 1;
        } else {
            far_outside = side < 0 ? far_outside / 2 : far_outside;
            near = middle;
            inside = value;
            side = -1;
        }
        if (fabs(value) < 1e-11) {
            return middle;
        }
    }
    return (near + far) / 2;
}

double wh_rim_distance(const wh_rim_t *rim, const wh_placement_t *placement, double aside, double look) {
    double sine;
    double cosine;
    wh_align_sin_cos(look, &sine, &cosine);
    double turn_sine;
    double turn_cosine;
    wh_align_sin_cos(placement->turn, &turn_sine, &turn_cosine);
    const double x = -aside * sine - placement->x;
    const double y = aside * cosine - placement->y;
    const line_t line = {turn_cosine * x + turn_sine * y, turn_cosine * y - turn_sine * x,
                         turn_cosine * cosine + turn_sine * sine, turn_cosine * sine - turn_sine * cosine};
    const double along = line.x * line.cosine + line.y * line.sine;
    const double miss = line.cosine * line.y - line.sine * line.x;
    const double circle = sqrt(rim->radius * rim->radius - miss * miss) - along;
    const double over = outside(rim, &line, circle);
    return over > 1e-10 ? way_out(rim, &line, circle, over) : circle;
}

/* --------------------------------------------------------------------------------------------- refusals */

static void check_notch(wh_field_check_t *found, const wh_rim_t *rim) {
    const wh_notch_shape_t *notch = &rim->notch;
    wh_field_check(found, "notch.depth", WH_NONE, notch->depth, notch->depth == 0 ? 0 : 0.2, 3);
    if (found->status == WH_OK && notch->depth > 0) {
        wh_field_check(found, "notch.direction", WH_NONE, notch->direction, -WH_ALIGN_TURN, WH_ALIGN_TURN);
        wh_field_check(found, "notch.opening", WH_NONE, notch->opening, 1, 2.1);
        wh_field_check(found, "notch.bottom", WH_NONE, notch->bottom, 0, 2);
        wh_field_check(found, "notch.corner", WH_NONE, notch->corner, 0, 1);
    }
    if (found->status == WH_OK && notch->depth > 0) {
        const outline_t o = notch_outline(rim);
        const bool corners = notch->corner > notch->bottom;
        wh_field_check(found, corners ? "notch.corner" : "notch.bottom", WH_NONE,
                       o.high - o.low > 0.01 ? 0 : 1, 0, 0);
    }
}

wh_status_t wh_rim_validate(const wh_rim_t *rim, wh_bad_field_t *bad) {
    if (rim == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_field_check_t found = wh_field_check_begin();
    wh_field_check(&found, "radius", WH_NONE, rim->radius, 10, 300);
    check_notch(&found, rim);
    for (int32_t f = 0; f < WH_RIM_FLATS; ++f) {
        const wh_flat_shape_t *flat = &rim->flats[f];
        wh_field_check(&found, "flats.length", f, flat->length, flat->length == 0 ? 0 : 2, 1.4 * rim->radius);
        wh_field_check(&found, "flats.direction", f, flat->direction, -WH_ALIGN_TURN, WH_ALIGN_TURN);
    }
    wh_field_check(&found, "chip_count", WH_NONE, rim->chip_count, 0, WH_RIM_CHIPS);
    for (int32_t i = 0; found.status == WH_OK && i < rim->chip_count; ++i) {
        const wh_chip_t *chip = &rim->chips[i];
        wh_field_check(&found, "chips.direction", i, chip->direction, -WH_ALIGN_TURN, WH_ALIGN_TURN);
        wh_field_check(&found, "chips.width", i, chip->width, 0.01, 30);
        wh_field_check(&found, "chips.depth", i, chip->depth, 0, chip->width < 5 ? chip->width : 5);
    }
    wh_field_check(&found, "bow", WH_NONE, rim->bow, -2, 2);
    wh_field_check(&found, "saddle", WH_NONE, rim->saddle, -2, 2);
    wh_field_check(&found, "saddle_direction", WH_NONE, rim->saddle_direction, -WH_ALIGN_TURN, WH_ALIGN_TURN);
    wh_field_check(&found, "transmission", WH_NONE, rim->transmission, 0, 0.9);
    return wh_field_check_end(&found, bad);
}

/* --------------------------------------------------------------------------------------------------- hash */

uint64_t wh_rim_hash(const wh_rim_t *rim, uint64_t hash) {
    const double values[] = {rim->radius,        rim->notch.direction, rim->notch.depth,
                             rim->notch.opening, rim->notch.bottom,    rim->notch.corner,
                             rim->bow,           rim->saddle,          rim->saddle_direction,
                             rim->transmission};
    hash = wh_hash_doubles(hash, values, sizeof values / sizeof values[0]);
    for (size_t i = 0; i < WH_RIM_FLATS; ++i) {
        const double flat[] = {rim->flats[i].direction, rim->flats[i].length};
        hash = wh_hash_doubles(hash, flat, 2);
    }
    for (int32_t i = 0; i < rim->chip_count; ++i) {
        const double chip[] = {rim->chips[i].direction, rim->chips[i].width, rim->chips[i].depth};
        hash = wh_hash_doubles(hash, chip, 3);
    }
    return wh_hash_int(hash, rim->chip_count);
}
