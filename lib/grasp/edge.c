#include "edge.h"

#include "../math/hash.h"

#define PI 3.14159265358979323846
#define DEGREE (PI / 180)
/* Halvings of a distance of a few mm, down to less than a number's last place. */
#if defined(WH_FLOAT)
#define HALVINGS 30
#else
#define HALVINGS 60
#endif

/* The path is computed in the library's numbers, so that a processor without double needs no software for
 * it. */
typedef struct {
    wh_real_t x, y;
} spot_t;

typedef struct {
    wh_real_t radius, rest, plunger, alpha, clearance, retracted, gripped_from, gripped_to, end, speed;
} grip_t;

typedef struct {
    wh_real_t radius, x, y, depth, opening, bottom, notch_x, notch_y;
} disk_t;

static grip_t grip_of(const wh_edge_t *edge) {
    const grip_t grip = {(wh_real_t)edge->radius,       (wh_real_t)edge->rest,
                         (wh_real_t)edge->plunger,      (wh_real_t)edge->alpha,
                         (wh_real_t)edge->clearance,    (wh_real_t)edge->retracted,
                         (wh_real_t)edge->gripped_from, (wh_real_t)edge->gripped_to,
                         (wh_real_t)edge->end,          (wh_real_t)edge->speed};
    return grip;
}

static disk_t disk_of(const wh_edge_wafer_t *wafer) {
    const disk_t disk = {(wh_real_t)wafer->radius,  (wh_real_t)wafer->x,       (wh_real_t)wafer->y,
                         (wh_real_t)wafer->depth,   (wh_real_t)wafer->opening, (wh_real_t)wafer->bottom,
                         (wh_real_t)wafer->notch_x, (wh_real_t)wafer->notch_y};
    return disk;
}

static spot_t point(wh_real_t x, wh_real_t y) {
    const spot_t p = {x, y};
    return p;
}

static wh_real_t length(wh_real_t x, wh_real_t y) {
    return wh_real_sqrt(x * x + y * y);
}

/* Series up to x^23, for angles up to 60 degrees, exact to rounding. */
static spot_t direction(wh_real_t angle) {
    const wh_real_t square = angle * angle;
    spot_t d = {1, 1};
    for (int k = 22; k > 0; k -= 2) {
        d.x = 1 - d.x * square / (wh_real_t)(k * (k - 1));
        d.y = 1 - d.y * square / (wh_real_t)(k * (k + 1));
    }
    d.y *= angle;
    return d;
}

wh_edge_t wh_edge_default(double radius) {
    const wh_edge_t edge = {radius, 1.5, 1.5, 30 * DEGREE, 2.5, -8, -0.25, 1.3, 4, 40};
    return edge;
}

wh_edge_wafer_t wh_edge_wafer_nominal(double radius) {
    wh_edge_wafer_t wafer = {radius, 0, 0, 0, 0, 0, 0, 1};
    if (radius >= 100) {
        wafer.depth = 1;
        wafer.opening = 90 * DEGREE;
        wafer.bottom = 0.9;
    }
    return wafer;
}

static bool is_within(wh_real_t value, wh_real_t least, wh_real_t most) {
    return value >= least && value <= most;
}

static bool are_finite(const wh_real_t numbers[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (!(numbers[i] - numbers[i] == 0)) {
            return false;
        }
    }
    return true;
}

static bool are_pins(const grip_t *edge) {
    return is_within(edge->radius, 10, 300) && is_within(edge->rest, WH_REAL(0.1), 20) &&
           is_within(edge->plunger, WH_REAL(0.1), 20) &&
           is_within(edge->alpha, WH_REAL(25 * DEGREE - 1e-12), WH_REAL(60 * DEGREE + 1e-12)) &&
           is_within(edge->clearance, 0, 10) && edge->clearance <= edge->radius / 10;
}

static bool is_stroke(const grip_t *edge) {
    const wh_real_t least = -(edge->clearance + 1);
    return is_within(edge->retracted, -50, least) && is_within(edge->gripped_from, -5, 5) &&
           edge->gripped_from > edge->retracted && is_within(edge->gripped_to, edge->gripped_from, 5) &&
           edge->end > edge->gripped_to && edge->end <= 10 &&
           is_within(edge->speed, WH_REAL(0.01), WH_REAL(1e4));
}

static wh_status_t judge_grip(const grip_t *edge) {
    const wh_real_t numbers[] = {edge->radius,    edge->rest,      edge->plunger,      edge->alpha,
                                 edge->clearance, edge->retracted, edge->gripped_from, edge->gripped_to,
                                 edge->end,       edge->speed};
    if (!are_finite(numbers, sizeof numbers / sizeof numbers[0])) {
        return WH_STATUS_NOT_FINITE;
    }
    return are_pins(edge) && is_stroke(edge) ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_edge_validate(const wh_edge_t *edge) {
    if (!edge) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const grip_t grip = grip_of(edge);
    return judge_grip(&grip);
}

static bool is_notch(const grip_t *edge, const disk_t *wafer) {
    const wh_real_t smaller = edge->rest < edge->plunger ? edge->rest : edge->plunger;
    return wafer->depth == 0 ||
           (is_within(wafer->depth, WH_REAL(0.2), edge->radius / 50) &&
            is_within(wafer->opening, WH_REAL(85 * DEGREE - 1e-12), WH_REAL(120 * DEGREE + 1e-12)) &&
            is_within(wafer->bottom, 0, smaller) &&
            is_within(length(wafer->notch_x, wafer->notch_y), WH_REAL(1 - 1e-6), WH_REAL(1 + 1e-6)));
}

/* The notch's outline, on one side of its axis: a flank through the apex (apex, 0) with the direction
 * (cosine, sine), up to the corner. */
typedef struct {
    wh_real_t apex, cosine, sine;
    wh_real_t flank; /* from the apex to the corner */
    spot_t corner;
} dip_t;

static dip_t outline_of(const disk_t *wafer) {
    const spot_t half = direction(wafer->opening / 2);
    dip_t outline = {0, 0, 0, 0, {0, 0}};
    if (wafer->depth > 0) {
        outline.cosine = half.x;
        outline.sine = half.y;
        outline.apex = wafer->radius - wafer->depth - wafer->bottom * (1 / half.y - 1);
        const wh_real_t aside = outline.apex * half.y;
        outline.flank = wh_real_sqrt(wafer->radius * wafer->radius - aside * aside) - outline.apex * half.x;
        outline.corner = point(outline.apex + outline.flank * half.x, outline.flank * half.y);
    }
    return outline;
}

/* The straight part of a flank is longer than this, mm, as in wh_rim_validate. */
#define LEAST_FLANK WH_REAL(0.01)

/* True if the rounded bottom leaves a straight part of each flank. */
static bool has_flanks(const disk_t *wafer) {
    const dip_t outline = outline_of(wafer);
    return wafer->depth == 0 || outline.flank - wafer->bottom * outline.cosine / outline.sine > LEAST_FLANK;
}

static wh_status_t judge_disk(const grip_t *edge, const disk_t *wafer) {
    const wh_real_t numbers[] = {wafer->radius,  wafer->x,      wafer->y,       wafer->depth,
                                 wafer->opening, wafer->bottom, wafer->notch_x, wafer->notch_y};
    if (!are_finite(numbers, sizeof numbers / sizeof numbers[0])) {
        return WH_STATUS_NOT_FINITE;
    }
    const wh_real_t half = edge->radius / 2 < 50 ? edge->radius / 2 : 50;
    const bool good = is_within(wafer->radius, edge->radius - 1, edge->radius + 1) &&
                      is_within(wafer->x, -half, half) && is_within(wafer->y, -half, half) &&
                      is_notch(edge, wafer) && has_flanks(wafer);
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_edge_wafer_validate(const wh_edge_t *edge, const wh_edge_wafer_t *wafer) {
    if (!edge || !wafer) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const grip_t grip = grip_of(edge);
    const disk_t disk = disk_of(wafer);
    return judge_disk(&grip, &disk);
}

/* A pin's place from the wafer's centre, along the notch's axis and aside of it. */
static spot_t from_notch(const disk_t *wafer, spot_t pin) {
    return point(pin.x * wafer->notch_x + pin.y * wafer->notch_y,
                 wh_real_abs(pin.y * wafer->notch_x - pin.x * wafer->notch_y));
}

/* Always false without a notch, because the corner is then at 0. */
static bool is_over_notch(const dip_t *outline, spot_t p) {
    return p.x > 0 && p.y * outline->corner.x < p.x * outline->corner.y;
}

bool wh_edge_meets_notch(const wh_edge_wafer_t *wafer, double pin_x, double pin_y) {
    const disk_t disk = disk_of(wafer);
    const dip_t outline = outline_of(&disk);
    const spot_t pin = point((wh_real_t)pin_x - disk.x, (wh_real_t)pin_y - disk.y);
    return is_over_notch(&outline, from_notch(&disk, pin));
}

/* The values from which the path is computed. */
typedef struct {
    const grip_t *edge;
    const disk_t *wafer;
    dip_t outline;
    spot_t rests[2]; /* at +y and -y */
    wh_real_t rest_reach,
        plunger_reach; /* from a pin's centre to the centre of a round wafer that it touches */
    wh_real_t off;     /* distance off centre, at the begin */
    int first;         /* the rest that the wafer meets first */
    spot_t begin;      /* the wafer's centre when the plunger meets the rim */
    spot_t rolls;      /* and when it meets the first rest */
    spot_t plain;      /* the seated centre of a round wafer */
    spot_t seated;     /* the wafer's */
    int sunk;          /* the rest that is over the notch; -1: none */
    wh_real_t ahead;   /* lead of the plunger, if the notch is there */
    wh_real_t s_begin, s_plain, s_seated; /* the plunger's place then */
} path_t;

static spot_t minus(spot_t a, spot_t b) {
    return point(a.x - b.x, a.y - b.y);
}

/* The distance of a pin of this radius from the wafer's outline, with its centre at `pin` from the wafer's
 * centre. Below 0: inside. */
static wh_real_t gap_of(const path_t *path, wh_real_t radius, spot_t pin) {
    const dip_t *o = &path->outline;
    const spot_t p = from_notch(path->wafer, pin);
    if (!is_over_notch(o, p)) {
        return length(pin.x, pin.y) - path->wafer->radius - radius;
    }
    const wh_real_t along = (p.x - o->apex) * o->cosine + p.y * o->sine;
    if (along <= o->flank) {
        return (p.x - o->apex) * o->sine - p.y * o->cosine - radius;
    }
    return length(p.x - o->corner.x, p.y - o->corner.y) - radius;
}

static spot_t plunger_at(const grip_t *edge, wh_real_t s) {
    return point(s - edge->radius - edge->plunger, 0);
}

/* s at which the plunger touches a round wafer at `centre`. */
static wh_real_t meets(const path_t *path, spot_t centre) {
    const wh_real_t reach = path->plunger_reach;
    return centre.x - wh_real_sqrt(reach * reach - centre.y * centre.y) + path->edge->radius +
           path->edge->plunger;
}

/* The delay with which it touches this wafer, if the notch is there. */
static wh_real_t lag_at(const path_t *path, spot_t centre) {
    const wh_real_t least = meets(path, centre);
    wh_real_t from = least;
    wh_real_t to = least + 4 * path->wafer->depth;
    if (!is_over_notch(&path->outline,
                       from_notch(path->wafer, minus(plunger_at(path->edge, least), centre)))) {
        return 0;
    }
    for (int i = 0; i < HALVINGS; ++i) {
        const wh_real_t middle = from + (to - from) / 2;
        const spot_t pin = minus(plunger_at(path->edge, middle), centre);
        *(gap_of(path, path->edge->plunger, pin) > 0 ? &from : &to) = middle;
    }
    return from - least;
}

/* The centre at the distance `reach` from `about`, `way` mm farther from `from` towards `to`. */
static spot_t roll(spot_t about, wh_real_t reach, spot_t from, spot_t to, wh_real_t way) {
    const spot_t towards = minus(to, from);
    const wh_real_t part = way / length(towards.x, towards.y);
    const spot_t moved = minus(point(from.x + part * towards.x, from.y + part * towards.y), about);
    const wh_real_t share = reach / length(moved.x, moved.y);
    return point(about.x + share * moved.x, about.y + share * moved.y);
}

/* From the round wafer's place the centre rolls on the other rest, until the sunk rest touches the outline.
 * With alpha and the notch's opening in their ranges the gap only decreases on this way. */
static spot_t sink(const path_t *path) {
    const spot_t other = path->rests[path->sunk == 0 ? 1 : 0];
    const spot_t rest = path->rests[path->sunk];
    wh_real_t from = 0;
    wh_real_t to = 8 * path->wafer->depth;
    for (int i = 0; i < HALVINGS; ++i) {
        const wh_real_t way = from + (to - from) / 2;
        const spot_t centre = roll(other, path->rest_reach, path->plain, rest, way);
        *(gap_of(path, path->edge->rest, minus(rest, centre)) > 0 ? &from : &to) = way;
    }
    return roll(other, path->rest_reach, path->plain, rest, from);
}

/* The rest that is over the notch of a wafer at `centre`; -1: none. */
static int find_sunk(const path_t *path, spot_t centre) {
    for (int rest = 0; rest < 2; ++rest) {
        if (is_over_notch(&path->outline, from_notch(path->wafer, minus(path->rests[rest], centre)))) {
            return rest;
        }
    }
    return -1;
}

/* The begin of the path: the wafer's place, or moved back along the blade if it lies on a rest. */
static void find_begin(path_t *path) {
    const spot_t start = {path->wafer->x, path->wafer->y};
    path->first = 1;
    if (start.y > 0) {
        path->first = 0;
    }
    const spot_t rest = path->rests[path->first];
    const wh_real_t aside = rest.y - start.y;
    path->off = length(start.x, start.y);
    path->rolls = point(rest.x - wh_real_sqrt(path->rest_reach * path->rest_reach - aside * aside), start.y);
    path->begin = point(start.x < path->rolls.x ? start.x : path->rolls.x, start.y);
}

static path_t path_of(const grip_t *edge, const disk_t *wafer) {
    const spot_t alpha = direction(edge->alpha);
    const wh_real_t reach = edge->radius + edge->rest;
    path_t path = {.edge = edge, .wafer = wafer, .outline = outline_of(wafer)};
    path.rests[0] = point(reach * alpha.x, reach * alpha.y);
    path.rests[1] = point(reach * alpha.x, -reach * alpha.y);
    path.rest_reach = wafer->radius + edge->rest;
    path.plunger_reach = wafer->radius + edge->plunger;
    find_begin(&path);
    const wh_real_t aside = path.rests[0].y;
    path.plain = point(path.rests[0].x - wh_real_sqrt(path.rest_reach * path.rest_reach - aside * aside), 0);
    path.sunk = find_sunk(&path, path.plain);
    path.seated = path.sunk < 0 ? path.plain : sink(&path);
    path.ahead = lag_at(&path, path.seated);
    path.s_begin = meets(&path, path.begin) + path.ahead;
    path.s_plain = meets(&path, path.plain) + path.ahead;
    path.s_seated = meets(&path, path.seated) + path.ahead;
    return path;
}

/* The point where the circles about a rest and the plunger meet, on the side of the other rest. */
static spot_t between(const path_t *path, int rest, wh_real_t s) {
    const spot_t plunger = plunger_at(path->edge, s - path->ahead);
    const spot_t way = minus(path->rests[rest], plunger);
    const wh_real_t d = length(way.x, way.y);
    const wh_real_t r = path->plunger_reach;
    const wh_real_t along = (d * d + r * r - path->rest_reach * path->rest_reach) / (2 * d);
    const wh_real_t square = r * r - along * along;
    const wh_real_t aside = (rest == 0 ? -1 : 1) * wh_real_sqrt(square > 0 ? square : 0);
    return point(plunger.x + (along * way.x - aside * way.y) / d,
                 plunger.y + (along * way.y + aside * way.x) / d);
}

static void put(wh_edge_place_t *place, wh_edge_phase_t phase, wh_real_t s, spot_t centre) {
    place->phase = phase;
    place->s = (double)s;
    place->x = (double)centre.x;
    place->y = (double)centre.y;
}

/* Stops at a wafer that is farther off centre than the pocket allows. */
static void stop(const path_t *path, wh_real_t s, wh_edge_place_t *place) {
    const spot_t start = {path->wafer->x, path->wafer->y};
    const wh_real_t rim = meets(path, start) + lag_at(path, start);
    const wh_real_t met = rim > path->edge->retracted ? rim : path->edge->retracted;
    if (met > path->edge->gripped_to) {
        put(place, s < path->edge->end ? WH_EDGE_FREE : WH_EDGE_MISSED, s, start);
    } else if (s < met) {
        put(place, WH_EDGE_FREE, s, start);
    } else {
        put(place, WH_EDGE_JAMMED, met, start);
        place->excess = (double)(path->off - path->edge->clearance);
    }
}

/* The path before the plunger meets the rim. A wafer that lies on a rest slides off it evenly during this
 * time. */
static void wait(const path_t *path, wh_real_t s, wh_edge_place_t *place) {
    const wh_real_t retracted = path->edge->retracted;
    const wh_real_t part = s > retracted ? (s - retracted) / (path->s_begin - retracted) : 0;
    const wh_real_t x = path->wafer->x;
    put(place, WH_EDGE_FREE, s, point(x + part * (path->begin.x - x), path->begin.y));
}

static void follow(const path_t *path, wh_real_t s, wh_edge_place_t *place) {
    const wh_real_t pushed = path->begin.x + (s - path->s_begin);
    if (s >= path->s_seated) {
        put(place, WH_EDGE_SEATED, path->s_seated, path->seated);
    } else if (s >= path->s_plain) {
        put(place, WH_EDGE_SINKING, s, between(path, path->sunk == 0 ? 1 : 0, s));
    } else if (s < path->s_begin) {
        wait(path, s, place);
    } else if (pushed < path->rolls.x) {
        put(place, WH_EDGE_PUSHED, s, point(pushed, path->begin.y));
    } else {
        put(place, WH_EDGE_ROLLING, s, between(path, path->first, s));
    }
}

static wh_edge_window_t window_of(const grip_t *edge, wh_real_t s) {
    if (s <= edge->retracted) {
        return WH_EDGE_RETRACTED;
    }
    if (s > edge->gripped_to) {
        return WH_EDGE_OVERTRAVEL;
    }
    return s >= edge->gripped_from ? WH_EDGE_GRIPPED : WH_EDGE_SHORT;
}

static void find(const grip_t *edge, const disk_t *wafer, wh_real_t s, wh_edge_place_t *place) {
    place->excess = 0;
    if (!wafer) {
        put(place, s < edge->end ? WH_EDGE_FREE : WH_EDGE_MISSED, s, point(0, 0));
    } else {
        const path_t path = path_of(edge, wafer);
        if (path.off <= edge->clearance) {
            follow(&path, s, place);
        } else {
            stop(&path, s, place);
        }
    }
    place->window = window_of(edge, (wh_real_t)place->s);
    place->held = place->phase == WH_EDGE_SEATED && place->window == WH_EDGE_GRIPPED;
}

/* The ends of the stroke are the caller's doubles, which a float may not have. */
static double exact(const wh_edge_t *edge, const grip_t *grip, double s) {
    const wh_real_t real = (wh_real_t)s;
    if (real == grip->end) {
        return edge->end;
    }
    return real == grip->retracted ? edge->retracted : s;
}

/* Also of a double that no float has. */
static bool is_finite(double s) {
    return (wh_double_bits(s) >> 52 & 0x7ff) != 0x7ff;
}

wh_status_t wh_edge_at(const wh_edge_t *edge, const wh_edge_wafer_t *wafer, double s,
                       wh_edge_place_t *place) {
    if (!place || !edge) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const grip_t grip = grip_of(edge);
    const wh_real_t at = (wh_real_t)s < grip.end ? (wh_real_t)s : grip.end;
    disk_t disk;
    wh_status_t status = judge_grip(&grip);
    if (status == WH_OK && wafer) {
        disk = disk_of(wafer);
        status = judge_disk(&grip, &disk);
    }
    if (status == WH_OK && !is_finite(s)) {
        status = WH_STATUS_NOT_FINITE;
    }
    if (status == WH_OK) {
        find(&grip, wafer ? &disk : NULL, at, place);
        place->s = exact(edge, &grip, place->s);
    }
    return status;
}
