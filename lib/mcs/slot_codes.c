#include "slot_codes.h"

#include <math.h>

#define BEAMS 2
/* Below this cosine a wafer stands on edge: no upright beam passes through its face. */
#define ON_EDGE 1e-3
/* Below this one it cannot lie in a slot, and beams near its rim may miss it. */
#define STEEP 0.98

/* The beams' view of one wafer. */
typedef struct {
    double low[BEAMS], high[BEAMS]; /* above slot 1, mm */
    double face[BEAMS];             /* of these, the height on the face that looks at the slots */
    bool seen[BEAMS];
    double thickness; /* along a beam, mm */
    double out;       /* how far it lies towards the arm, mm */
    bool steep;       /* so steep that both beams may miss it, and over the slots */
    double middle;    /* of a steep one: the height of its centre, mm */
} sight_t;

/* Where a beam passes through the wafer's face, in the station's frame. */
static bool pass_beam(const wh_pose_t *station_from_face, double radius, double x, double y, double *height) {
    const wh_vec3_t n = wh_mat3_column(&station_from_face->R, 2);
    const wh_vec3_t *r = &station_from_face->r;
    const double dx = x - r->x;
    const double dy = y - r->y;
    const double dz = -(n.x * dx + n.y * dy) / n.z;
    *height = r->z + dz;
    return dx * dx + dy * dy + dz * dz <= radius * radius;
}

static sight_t look_at(const wh_slot_beams_t *beams, const wh_pose_t *station_from_face, double thickness) {
    const wh_real_t cosine = station_from_face->R.m[2][2];
    const wh_vec3_t *r = &station_from_face->r;
    sight_t sight = {.out = -r->x, .middle = r->z};
    sight.steep = fabs(cosine) < STEEP && r->x * r->x + r->y * r->y <= beams->radius * beams->radius;
    if (!(fabs(cosine) > ON_EDGE)) {
        return sight;
    }
    const double through = thickness / cosine;
    for (int beam = 0; beam < BEAMS; ++beam) {
        const double y = (beam == 0 ? -beams->mapping->y : beams->mapping->y) * beams->radius;
        double *face = &sight.face[beam];
        sight.seen[beam] =
            pass_beam(station_from_face, beams->radius, -beams->mapping->x * beams->radius, y, face);
        sight.low[beam] = through > 0 ? *face : *face + through;
        sight.high[beam] = through > 0 ? *face + through : *face;
    }
    sight.thickness = fabs(through);
    return sight;
}

/* The slot (from 0) nearest to a height that is within the sweep, else -1. */
static int nearest_slot(const wh_slot_beams_t *beams, double height) {
    const double at = height / beams->pitch + 0.5;
    return at >= 0 && at < beams->slots ? (int)at : -1;
}

static bool is_off_plane(const wh_slot_beams_t *beams, double height) {
    const int slot = nearest_slot(beams, height);
    return slot < 0 || fabs(height - slot * beams->pitch) > beams->mapping->crossed * beams->pitch;
}

/* True if a wafer that both beams see is crossed. */
static bool is_crossed(const wh_slot_beams_t *beams, const sight_t *sight) {
    const wh_mapping_t *mapping = beams->mapping;
    const double level = mapping->level > 0 ? mapping->level : beams->pitch / 2;
    return fabs(sight->face[1] - sight->face[0]) >= level || is_off_plane(beams, sight->face[0]) ||
           is_off_plane(beams, sight->face[1]);
}

static wh_slot_code_t judge_slot(const wh_slot_beams_t *beams, const sight_t *sight) {
    const wh_mapping_t *mapping = beams->mapping;
    if (sight->steep || !sight->seen[0] || !sight->seen[1] || is_crossed(beams, sight)) {
        return WH_SLOT_CROSSED;
    }
    if (sight->out > mapping->protruded) {
        return WH_SLOT_PROTRUDED;
    }
    return sight->thickness > mapping->thickest   ? WH_SLOT_THICK
           : sight->thickness < mapping->thinnest ? WH_SLOT_THIN
                                                  : WH_SLOT_SINGLE;
}

static wh_slot_code_t worse_code(int before, wh_slot_code_t code) {
    if (code == WH_SLOT_CROSSED || before == WH_SLOT_CROSSED) {
        return WH_SLOT_CROSSED;
    }
    return before == WH_SLOT_EMPTY ? code : WH_SLOT_DOUBLE;
}

/* The slots that a wafer belongs to: none if last is before first. */
typedef struct {
    int first, last;
} span_t;

static void widen_span(span_t *span, int slot) {
    if (slot >= 0) {
        span->first = slot < span->first ? slot : span->first;
        span->last = slot > span->last ? slot : span->last;
    }
}

static span_t find_span(const wh_slot_beams_t *beams, const sight_t *sight) {
    span_t span = {beams->slots, -1};
    for (int beam = 0; beam < BEAMS; ++beam) {
        if (sight->seen[beam]) {
            widen_span(&span, nearest_slot(beams, sight->low[beam]));
            widen_span(&span, nearest_slot(beams, sight->high[beam]));
        }
    }
    if (sight->steep) {
        widen_span(&span, nearest_slot(beams, sight->middle));
    }
    return span;
}

void wh_slot_codes_add(const wh_slot_beams_t *beams, const wh_pose_t *station_from_face, double thickness,
                       int codes[]) {
    const sight_t sight = look_at(beams, station_from_face, thickness);
    const span_t span = find_span(beams, &sight);
    const wh_slot_code_t code = span.first < span.last ? WH_SLOT_CROSSED : judge_slot(beams, &sight);
    for (int slot = span.first; slot <= span.last; ++slot) {
        codes[slot] = (int)worse_code(codes[slot], code);
    }
}
