/* Conservative advancement: it moves from each instant as far as no body can have reached or left the
 * beam. */
#include "beam.h"

#include "angle_internal.h"

/* The least cosine between the beam and a body's normal. */
#define LEAST_COSINE 0.5
/* A rim approaches by at most this much for each mm of way: the steepest chip. */
#define STEEPEST 5
/* Longer than any slice. */
#define EVER 1e9
/* The largest number of free steps; after them each step is this part of the slice. */
#define STEPS 2000
#define SHORTEST 1e-6 /* mm */
#define EXACT 1e-10   /* mm */
#define LARGEST_TURN 0.1

wh_beam_t wh_beam_at(const wh_pose_t *base_from_station, double x, double y, double low, double high) {
    const wh_mat3_t *R = &base_from_station->R;
    const wh_vec3_t *r = &base_from_station->r;
    const wh_beam_t beam = {(double)r->x + (double)R->m[0][0] * x + (double)R->m[0][1] * y,
                            (double)r->y + (double)R->m[1][0] * x + (double)R->m[1][1] * y,
                            (double)r->z + (double)R->m[2][0] * x + (double)R->m[2][1] * y,
                            (double)R->m[0][2],
                            (double)R->m[1][2],
                            (double)R->m[2][2],
                            low,
                            high};
    return beam;
}

wh_status_t wh_beam_validate(const wh_beam_t *beam) {
    if (beam == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const double numbers[8] = {beam->x,  beam->y,  beam->z,   beam->ex,
                               beam->ey, beam->ez, beam->low, beam->high};
    bool good = true;
    for (size_t i = 0; i < 8; ++i) {
        if (!wh_align_is_finite(numbers[i])) {
            return WH_STATUS_NOT_FINITE;
        }
        good = good && fabs(numbers[i]) <= (i < 6 ? 1e5 : 1e4);
    }
    const double square = beam->ex * beam->ex + beam->ey * beam->ey + beam->ez * beam->ez;
    return good && fabs(square - 1) <= 2e-5 && beam->low < beam->high ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_blade_outline_validate(const wh_blade_outline_t *outline) {
    if (outline == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (outline->count != 0 && (outline->count < 3 || outline->count > WH_OUTLINE_POINTS)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    for (int32_t i = 0; i < outline->count; ++i) {
        if (!wh_align_is_finite(outline->x[i]) || !wh_align_is_finite(outline->y[i])) {
            return WH_STATUS_NOT_FINITE;
        }
        if (fabs(outline->x[i]) > 1e3 || fabs(outline->y[i]) > 1e3) {
            return WH_STATUS_OUT_OF_RANGE;
        }
    }
    return WH_OK;
}

/* -------------------------------------------------------------------------------------------- the motion */

typedef struct {
    double x, y, z;
} point_t;

/* transpose(R) * p */
static point_t turn_back(const wh_mat3_t *R, const point_t *p) {
    const point_t turned = {(double)R->m[0][0] * p->x + (double)R->m[1][0] * p->y + (double)R->m[2][0] * p->z,
                            (double)R->m[0][1] * p->x + (double)R->m[1][1] * p->y + (double)R->m[2][1] * p->z,
                            (double)R->m[0][2] * p->x + (double)R->m[1][2] * p->y +
                                (double)R->m[2][2] * p->z};
    return turned;
}

/* Entry (row, column) of begin^T end. */
static double turn_entry(const wh_slice_motion_t *motion, size_t row, size_t column) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        sum += (double)motion->begin->R.m[k][row] * (double)motion->end->R.m[k][column];
    }
    return sum;
}

wh_slice_motion_t wh_slice_motion_between(const wh_pose_t *begin, const wh_pose_t *end) {
    wh_slice_motion_t motion = {begin, end, 1, 0, 0, 0, 0};
    const double x = turn_entry(&motion, 2, 1) - turn_entry(&motion, 1, 2);
    const double y = turn_entry(&motion, 0, 2) - turn_entry(&motion, 2, 0);
    const double z = turn_entry(&motion, 1, 0) - turn_entry(&motion, 0, 1);
    const double square =
        1 + turn_entry(&motion, 0, 0) + turn_entry(&motion, 1, 1) + turn_entry(&motion, 2, 2);
    if (!(square > 0.02)) {
        motion.angle = -1;
        return motion;
    }
    /* w is root / 2. A float's rotation is never exact, so the length is divided out. */
    const double root = sqrt(square);
    const double length = sqrt(square + (x * x + y * y + z * z) / square);
    motion.w = root / length;
    motion.x = x / (root * length);
    motion.y = y / (root * length);
    motion.z = z / (root * length);
    const double sine = sqrt(motion.x * motion.x + motion.y * motion.y + motion.z * motion.z);
    motion.angle = 4 * sine / (1 + motion.w);
    return motion;
}

/* p turned back by the part t of the motion's turn. */
static point_t turn_back_part(const wh_slice_motion_t *motion, double t, const point_t *p) {
    if (motion->angle == 0) {
        return *p;
    }
    const double w = 1 - t + t * motion->w;
    const double x = -t * motion->x;
    const double y = -t * motion->y;
    const double z = -t * motion->z;
    const double f = 2 / (w * w + x * x + y * y + z * z);
    /* p + f (w v x p + v x (v x p)) */
    const double cx = y * p->z - z * p->y;
    const double cy = z * p->x - x * p->z;
    const double cz = x * p->y - y * p->x;
    const point_t turned = {p->x + f * (w * cx + y * cz - z * cy), p->y + f * (w * cy + z * cx - x * cz),
                            p->z + f * (w * cz + x * cy - y * cx)};
    return turned;
}

/* A line seen from a frame. */
typedef struct {
    point_t from, along;
} ray_t;

static ray_t line_in_gripper(const wh_beam_t *beam, const wh_slice_motion_t *motion, double part) {
    const double t = motion->angle < 0 ? 1 : part;
    const wh_vec3_t *r = &motion->begin->r;
    const wh_vec3_t *to = &motion->end->r;
    const point_t from = {beam->x - ((double)r->x + t * ((double)to->x - (double)r->x)),
                          beam->y - ((double)r->y + t * ((double)to->y - (double)r->y)),
                          beam->z - ((double)r->z + t * ((double)to->z - (double)r->z))};
    const point_t along = {beam->ex, beam->ey, beam->ez};
    const wh_mat3_t *R = motion->angle < 0 ? &motion->end->R : &motion->begin->R;
    const point_t turned_from = turn_back(R, &from);
    const point_t turned_along = turn_back(R, &along);
    const ray_t line = {turn_back_part(motion, t, &turned_from), turn_back_part(motion, t, &turned_along)};
    return line;
}

static ray_t line_in_body(const wh_beam_t *beam, const wh_shade_t *shade, double part) {
    ray_t line = line_in_gripper(beam, &shade->motion, part);
    const wh_pose_t *inner = shade->gripper_from_wafer;
    if (inner != NULL) {
        const point_t from = {line.from.x - (double)inner->r.x, line.from.y - (double)inner->r.y,
                              line.from.z - (double)inner->r.z};
        line.from = turn_back(&inner->R, &from);
        line.along = turn_back(&inner->R, &line.along);
    }
    return line;
}

/* The point where the line meets the plane z = 0: x and y there, and z is the distance along the line. */
static point_t meet(const ray_t *line) {
    const double t = -line->from.z / line->along.z;
    const point_t at = {line->from.x + t * line->along.x, line->from.y + t * line->along.y, t};
    return at;
}

/* --------------------------------------------------------------------------------------- near and inside */

/* A lower bound of the distance to a change, mm: above 0 until the beam breaks, below 0 until it becomes
 * free. */
static double rim_distance(const wh_rim_t *rim, const point_t *at) {
    const double distance = sqrt(at->x * at->x + at->y * at->y);
    if (distance > rim->radius) {
        return distance - rim->radius;
    }
    return (distance - wh_rim_radius(rim, wh_align_atan2(at->y, at->x))) / STEEPEST;
}

static double outline_distance(const wh_blade_outline_t *outline, const point_t *at) {
    bool inside = false;
    double least = EVER;
    size_t before = (size_t)outline->count - 1;
    for (size_t i = 0; i < (size_t)outline->count; ++i) {
        const double x = outline->x[before] - at->x;
        const double y = outline->y[before] - at->y;
        const double dx = outline->x[i] - outline->x[before];
        const double dy = outline->y[i] - outline->y[before];
        const double square = dx * dx + dy * dy;
        double part = square > 0 ? -(x * dx + y * dy) / square : 0;
        part = part < 0 ? 0 : part;
        part = part > 1 ? 1 : part;
        const double near = (x + part * dx) * (x + part * dx) + (y + part * dy) * (y + part * dy);
        least = near < least ? near : least;
        if ((y > 0) != (y + dy > 0) && x - y / dy * dx > 0) {
            inside = !inside;
        }
        before = i;
    }
    return inside ? -sqrt(least) : sqrt(least);
}

static double distance_at(const wh_beam_t *beam, const wh_shade_t *shade, double part) {
    const ray_t line = line_in_body(beam, shade, part);
    const point_t at = meet(&line);
    const double aside =
        shade->rim != NULL ? rim_distance(shade->rim, &at) : outline_distance(shade->outline, &at);
    const double below = beam->low - at.z;
    const double above = at.z - beam->high;
    const double outside = below > above ? below : above;
    return aside > outside ? aside : outside;
}

/* The largest way of the beam through the body's plane in the whole slice, mm. It is EVER if that is not
 * known, 0 if nothing moves; negative: the body breaks no beam in this slice. */
static double way_of(const wh_beam_t *beam, const wh_shade_t *shade) {
    const wh_slice_motion_t *motion = &shade->motion;
    const ray_t first = line_in_body(beam, shade, 0);
    const ray_t last = line_in_body(beam, shade, 1);
    const double cosine = fabs(first.along.z) < fabs(last.along.z) ? fabs(first.along.z) : fabs(last.along.z);
    if (!(cosine >= LEAST_COSINE)) {
        return -1;
    }
    if (motion->angle < 0) {
        return 0;
    }
    if (motion->angle > LARGEST_TURN) {
        return EVER;
    }
    const double dx = (double)motion->end->r.x - (double)motion->begin->r.x;
    const double dy = (double)motion->end->r.y - (double)motion->begin->r.y;
    const double dz = (double)motion->end->r.z - (double)motion->begin->r.z;
    const double travel = sqrt(dx * dx + dy * dy + dz * dz);
    /* A body's point moves by the travel, and by the turn about the gripper. The place where the beam meets
     * the plane moves by that divided by the plane's cosine, which the turn reduces. */
    const wh_pose_t *inner = shade->gripper_from_wafer;
    const point_t at = meet(&first);
    const double arm =
        inner == NULL ? 0 : fabs((double)inner->r.x) + fabs((double)inner->r.y) + fabs((double)inner->r.z);
    const double slope = 1 + 1 / (cosine - motion->angle);
    const double reach = sqrt(at.x * at.x + at.y * at.y) + arm;
    return slope * (travel + motion->angle * reach) / (1 - slope * motion->angle);
}

/* -------------------------------------------------------------------------------------------- the search */

typedef struct {
    const wh_beam_t *beam;
    const wh_shade_t *shades;
    size_t count;
    double ways[WH_SHADES];
    double longest; /* of the known ways */
    double least;   /* the shortest step, as a part of the slice */
} look_t;

static look_t look_begin(const wh_beam_t *beam, const wh_shade_t *shades, size_t count) {
    look_t look = {.beam = beam, .shades = shades, .count = count};
    bool all_known = true;
    for (size_t i = 0; i < count; ++i) {
        look.ways[i] = way_of(beam, &shades[i]);
        all_known = all_known && look.ways[i] < EVER;
        look.longest = look.ways[i] > look.longest && look.ways[i] < EVER ? look.ways[i] : look.longest;
    }
    const bool fine = all_known && look.longest * STEPS > SHORTEST;
    look.least = fine ? SHORTEST / look.longest : 1.0 / STEPS;
    return look;
}

/* The least part of the slice for which the beam stays free, above 0, or broken, below 0. */
static double holds(const look_t *look, double part) {
    double broken = 0;
    double clear = EVER;
    bool any = false;
    for (size_t i = 0; i < look->count; ++i) {
        const double way = look->ways[i];
        if (way < 0) {
            continue;
        }
        const double distance = distance_at(look->beam, &look->shades[i], part);
        const double hold = way > 0 ? fabs(distance) / way : EVER;
        if (distance < 0) {
            any = true;
            broken = hold > broken ? hold : broken;
        } else {
            clear = hold < clear ? hold : clear;
        }
    }
    return any ? -broken : clear;
}

/* Bisects between two instants; only the second is after the change. */
static double bisect(const look_t *look, double first, double last, bool broken) {
    const double exact = look->longest > 0 ? EXACT / look->longest : 0;
    double before = first;
    double after = last;
    for (int i = 0; i < 60 && after - before > exact; ++i) {
        const double middle = (before + after) / 2;
        if ((holds(look, middle) < 0) == broken) {
            before = middle;
        } else {
            after = middle;
        }
    }
    return after;
}

bool wh_beam_next(const wh_beam_t *beam, const wh_shade_t *shades, size_t count, double *part, bool *broken) {
    look_t look = look_begin(beam, shades, count);
    double at = *part;
    double hold = holds(&look, at);
    for (int i = 0; (hold < 0) == *broken; ++i) {
        if (at >= 1 || fabs(hold) >= 1 - at) {
            return false;
        }
        look.least = i >= STEPS ? 1.0 / STEPS : look.least;
        const double before = at;
        at += fabs(hold) > look.least ? fabs(hold) : look.least;
        at = at < 1 ? at : 1;
        hold = holds(&look, at);
        if ((hold < 0) != *broken) {
            at = bisect(&look, before, at, *broken);
        }
    }
    *part = at;
    *broken = !*broken;
    return true;
}

bool wh_beam_crossing(const wh_beam_t *beam, const wh_slice_motion_t *motion, double part, double slice_s,
                      wh_crossing_t *crossing) {
    const double parts[3] = {part, 0, 1};
    point_t at[3];
    for (size_t i = 0; i < 3; ++i) {
        const ray_t line = line_in_gripper(beam, motion, parts[i]);
        if (!(fabs(line.along.z) >= LEAST_COSINE)) {
            return false;
        }
        at[i] = meet(&line);
    }
    crossing->x = at[0].x;
    crossing->y = at[0].y;
    crossing->vx = (at[2].x - at[1].x) / slice_s;
    crossing->vy = (at[2].y - at[1].y) / slice_s;
    return true;
}
