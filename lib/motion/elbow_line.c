#include "elbow_line_internal.h"

#include <string.h>

#include "jet_internal.h"
#include "line_internal.h"
#include "plane_internal.h"
#include "turns_internal.h"

#define LEAST_SINE WH_CHAIN_LEAST_SINE

/* A line whose level share is less goes straight up or down. */
#define LEAST_SHARE (WH_SLACK_RAD / 1000)

#define STRETCHES 64 /* parts of the line, for the joints' first derivatives and travel */
#define INSTANTS 16  /* instants of a phase of the profile, at first */
#define MOST_INSTANTS 1024
#define HALVINGS 40

/* The limit of second differences, as a share of the largest value: below it, values between instants are
 * bounded well. */
#define SMOOTH WH_REAL(0.02)

/* The indices of the joints in the arrays here. */
enum { SHOULDER, ELBOW, WRIST, JOINTS };

static const size_t joint_axes[JOINTS] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_YAW};

/* ---------------------------------------------------------------------------------------- where it leads */

static wh_real_t x_at(const wh_chain_line_t *line, wh_real_t along) {
    return line->start_x + along * line->path.direction.x;
}

static wh_real_t y_at(const wh_chain_line_t *line, wh_real_t along) {
    return line->start_y + along * line->path.direction.y;
}

static wh_real_t side_of(const wh_chain_line_t *line) {
    return line->from[WH_CHAIN_REACH] < 0 ? -WH_REAL(1.0) : WH_REAL(1.0);
}

/* Straight up or down with the arm nearly stretched or folded: the joints stand, and no root is taken of what
 * rounding may have made negative. */
static bool stands(const wh_chain_line_t *line) {
    const wh_vec3_t *d = &line->path.direction;
    return wh_real_abs(d->x) <= LEAST_SHARE && wh_real_abs(d->y) <= LEAST_SHARE &&
           wh_real_abs(line->start_y) < LEAST_SINE * line->links[1];
}

void wh_elbow_line_axes(const wh_chain_line_t *line, wh_real_t along, wh_real_t q[WH_CHAIN_AXES]) {
    q[WH_CHAIN_Z] = line->from[WH_CHAIN_Z] + along * line->path.direction.z;
    if (stands(line)) {
        for (size_t joint = 0; joint < JOINTS; ++joint) {
            q[joint_axes[joint]] = line->from[joint_axes[joint]];
        }
        return;
    }
    const wh_real_t x = x_at(line, along);
    const wh_real_t y = y_at(line, along);
    const wh_bend_t bend = wh_bend_for(line->links, x, y);
    const wh_real_t elbow = side_of(line) * wh_bend_angle(&bend);
    const wh_real_t turned =
        wh_atan2(line->start_x * y - line->start_y * x, line->start_x * x + line->start_y * y);
    const wh_real_t lead =
        wh_bend_lead(line->links, elbow) - wh_bend_lead(line->links, line->from[WH_CHAIN_REACH]);
    const wh_real_t shoulder = turned - lead;
    q[WH_CHAIN_THETA] = line->from[WH_CHAIN_THETA] + shoulder;
    q[WH_CHAIN_REACH] = elbow;
    q[WH_CHAIN_YAW] = line->from[WH_CHAIN_YAW] - (shoulder + (elbow - line->from[WH_CHAIN_REACH]));
}

/* The joints with their derivatives by the distance along the line. With C = 2 L1 L2 cos elbow and S = 2 L1
 * L2 sin elbow, the lead is the angle of (2 L1^2 + C, S). */
static void joints_at(const wh_chain_line_t *line, wh_real_t along, wh_jet_t joints[JOINTS]) {
    const wh_real_t *L = line->links;
    wh_real_t q[WH_CHAIN_AXES];
    wh_elbow_line_axes(line, along, q);
    if (stands(line)) {
        for (size_t joint = 0; joint < JOINTS; ++joint) {
            const wh_jet_t at_rest = {q[joint_axes[joint]], 0, 0, 0};
            joints[joint] = at_rest;
        }
        return;
    }
    const wh_jet_t x = {x_at(line, along), line->path.direction.x, 0, 0};
    const wh_jet_t y = {y_at(line, along), line->path.direction.y, 0, 0};
    const wh_bend_t bend = wh_bend_for(L, x.value, y.value);
    wh_jet_t above = wh_jet_scaled(-1, wh_jet_sum(wh_jet_product(x, x), wh_jet_product(y, y)));
    wh_jet_t below = wh_jet_scaled(-1, above);
    wh_jet_t C = below;
    above.value = bend.above;
    below.value = bend.below;
    C.value -= L[0] * L[0] + L[1] * L[1];
    const wh_jet_t S = wh_jet_scaled(side_of(line), wh_jet_root(wh_jet_product(above, below)));
    wh_jet_t beside = C;
    beside.value += 2 * L[0] * L[0];
    const wh_jet_t lead = wh_jet_angle(0, beside, S);
    joints[ELBOW] = wh_jet_angle(q[WH_CHAIN_REACH], C, S);
    joints[SHOULDER] = wh_jet_sum(wh_jet_angle(q[WH_CHAIN_THETA], x, y), wh_jet_scaled(-1, lead));
    joints[WRIST] = wh_jet_scaled(-1, wh_jet_sum(joints[SHOULDER], joints[ELBOW]));
    joints[WRIST].value = q[WH_CHAIN_YAW];
}

/* ------------------------------------------------------------------------------------------------ travel */

/* The elbow's angle without its sign at a place of the line; negative if the links do not reach it. The start
 * is where the axes are, whatever rounding says. */
static wh_real_t elbow_at(const wh_chain_line_t *line, wh_real_t along) {
    if (!(along > 0)) {
        return wh_real_abs(line->from[WH_CHAIN_REACH]);
    }
    const wh_bend_t bend = wh_bend_for(line->links, x_at(line, along), y_at(line, along));
    return bend.above >= 0 && bend.below >= 0 ? wh_bend_angle(&bend) : -1;
}

/* The elbow bends most at an end or where the line is closest to the shoulder. */
static wh_status_t check_elbow(const wh_chain_line_t *line, const wh_chain_t *chain, wh_real_t length) {
    const wh_vec3_t *d = &line->path.direction;
    const wh_real_t share = d->x * d->x + d->y * d->y;
    wh_real_t closest = share > 0 ? -(line->start_x * d->x + line->start_y * d->y) / share : 0;
    closest = closest < 0 ? 0 : (closest > length ? length : closest);
    const wh_real_t places[] = {0, closest, length};
    wh_status_t status = WH_OK;
    for (size_t i = 0; i < 3 && !stands(line); ++i) {
        const wh_real_t angle = elbow_at(line, places[i]);
        if (angle < 0 ||
            !wh_travel_has(&chain->travel[WH_CHAIN_REACH], WH_SLACK_RAD, side_of(line) * angle)) {
            return WH_STATUS_OUT_OF_REACH;
        }
        if (wh_sin(angle) < LEAST_SINE) {
            status = WH_STATUS_LIMIT_EXCEEDED;
        }
    }
    return status;
}

/* A joint's value at its turning point between two places. */
static wh_real_t turning_value(const wh_chain_line_t *line, size_t joint, wh_real_t from, wh_real_t to) {
    wh_jet_t joints[JOINTS];
    joints_at(line, from, joints);
    const bool rises = joints[joint].first > 0;
    wh_real_t before = from;
    wh_real_t behind = to;
    for (int i = 0; i < HALVINGS; ++i) {
        const wh_real_t middle = before + (behind - before) / 2;
        joints_at(line, middle, joints);
        if ((joints[joint].first > 0) == rises) {
            before = middle;
        } else {
            behind = middle;
        }
    }
    return joints[joint].value;
}

/* Finds the largest first derivatives, and whether all joints stay within travel. */
static bool look_along(const wh_chain_line_t *line, const wh_chain_t *chain, wh_real_t length,
                       wh_real_t slopes[JOINTS]) {
    wh_jet_t before[JOINTS];
    wh_jet_t now[JOINTS];
    joints_at(line, 0, before);
    for (size_t joint = 0; joint < JOINTS; ++joint) {
        slopes[joint] = wh_real_abs(before[joint].first);
    }
    for (int i = 1; i <= STRETCHES; ++i) {
        const wh_real_t at = length * (wh_real_t)i / STRETCHES;
        joints_at(line, at, now);
        for (size_t joint = 0; joint < JOINTS; ++joint) {
            const wh_travel_t *travel = &chain->travel[joint_axes[joint]];
            const bool turns = (before[joint].first > 0) != (now[joint].first > 0);
            if (!wh_travel_has(travel, WH_SLACK_RAD, now[joint].value) ||
                (turns &&
                 !wh_travel_has(travel, WH_SLACK_RAD,
                                turning_value(line, joint, length * (wh_real_t)(i - 1) / STRETCHES, at)))) {
                return false;
            }
            slopes[joint] = wh_real_max(slopes[joint], wh_real_abs(now[joint].first));
            before[joint] = now[joint];
        }
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------- the pace */

static void lower(wh_real_t *limit, wh_real_t other) {
    if (other < *limit) {
        *limit = other;
    }
}

static void obey(wh_limits_t *path, const wh_limits_t *axis, wh_real_t slope) {
    if (slope > 0) {
        lower(&path->speed, axis->speed / slope);
        lower(&path->acceleration, axis->acceleration / slope);
        lower(&path->jerk, axis->jerk / slope);
    }
}

static wh_limits_t path_limits(const wh_chain_line_t *line, const wh_chain_t *chain,
                               const wh_real_t slopes[JOINTS], const wh_line_caps_t *caps) {
    wh_limits_t limits = {(wh_real_t)FLT_MAX, (wh_real_t)FLT_MAX, (wh_real_t)FLT_MAX};
    for (size_t joint = 0; joint < JOINTS; ++joint) {
        obey(&limits, &chain->limits[joint_axes[joint]], slopes[joint]);
    }
    obey(&limits, &chain->limits[WH_CHAIN_Z], wh_real_abs(line->path.direction.z));
    if (caps->speed > 0) {
        lower(&limits.speed, caps->speed);
    }
    if (caps->acceleration > 0) {
        lower(&limits.acceleration, caps->acceleration);
    }
    return limits;
}

/* The largest magnitude of a quantity at successive instants, and the bound for values between them. */
typedef struct {
    wh_real_t most, bend, last, before;
} peak_t;

static void keep(peak_t *peak, int instant, wh_real_t value) {
    peak->most = wh_real_max(peak->most, wh_real_abs(value));
    if (instant >= 2) {
        peak->bend = wh_real_max(peak->bend, wh_real_abs(value - 2 * peak->last + peak->before));
    }
    peak->before = peak->last;
    peak->last = value;
}

static wh_real_t bound(const peak_t *peak) {
    return peak->most + peak->bend / 4;
}

/* The factor in time by which a joint must be slowed in a phase. */
static wh_real_t slowing(const peak_t peaks[3], const wh_limits_t *limits) {
    return wh_real_max(bound(&peaks[0]) / limits->speed,
                       wh_real_max(wh_real_sqrt(bound(&peaks[1]) / limits->acceleration),
                                   wh_cbrt(bound(&peaks[2]) / limits->jerk)));
}

/* A part of the profile of constant jerk. */
typedef struct {
    wh_real_t begin, end, jerk;
} phase_t;

static void look_at_phase(const wh_chain_line_t *line, const phase_t *phase, int instants,
                          peak_t peaks[JOINTS][3]) {
    memset(peaks, 0, JOINTS * sizeof peaks[0]);
    for (int i = 0; i <= instants; ++i) {
        const wh_real_t share = (wh_real_t)i / (wh_real_t)instants;
        wh_motion_t along;
        wh_jet_t joints[JOINTS];
        wh_profile_at(&line->path.path, phase->begin + (phase->end - phase->begin) * share, &along);
        along.jerk = phase->jerk;
        joints_at(line, along.position, joints);
        for (size_t joint = 0; joint < JOINTS; ++joint) {
            const wh_motion_t motion = wh_jet_in_time(joints[joint], &along);
            keep(&peaks[joint][0], i, motion.speed);
            keep(&peaks[joint][1], i, motion.acceleration);
            keep(&peaks[joint][2], i, motion.jerk);
        }
    }
}

static bool is_smooth(const peak_t peaks[JOINTS][3]) {
    bool smooth = true;
    for (size_t i = 0; i < JOINTS * (size_t)3; ++i) {
        const peak_t *peak = &peaks[i / 3][i % 3];
        smooth = smooth && peak->bend <= SMOOTH * peak->most;
    }
    return smooth;
}

static wh_real_t slowing_of_phase(const wh_chain_line_t *line, const wh_chain_t *chain,
                                  const phase_t *phase) {
    peak_t peaks[JOINTS][3];
    int instants = INSTANTS;
    look_at_phase(line, phase, instants, peaks);
    while (instants < MOST_INSTANTS && !is_smooth((const peak_t(*)[3])peaks)) {
        instants *= 4;
        look_at_phase(line, phase, instants, peaks);
    }
    wh_real_t factor = 0;
    for (size_t joint = 0; joint < JOINTS; ++joint) {
        factor = wh_real_max(factor, slowing(peaks[joint], &chain->limits[joint_axes[joint]]));
    }
    return factor;
}

static wh_real_t slowing_of_line(const wh_chain_line_t *line, const wh_chain_t *chain) {
    const wh_profile_t *p = &line->path.path;
    const wh_real_t end = p->duration;
    const phase_t phases[] = {
        {0, p->jerk_end, p->jerk},
        {p->jerk_end, p->hold_end, 0},
        {p->hold_end, p->rise_end, -p->jerk},
        {p->rise_end, end - p->rise_end, 0},
        {end - p->rise_end, end - p->hold_end, -p->jerk},
        {end - p->hold_end, end - p->jerk_end, 0},
        {end - p->jerk_end, end, p->jerk},
    };
    wh_real_t factor = 1;
    for (size_t i = 0; i < sizeof phases / sizeof phases[0]; ++i) {
        if (phases[i].end > phases[i].begin) {
            factor = wh_real_max(factor, slowing_of_phase(line, chain, &phases[i]));
        }
    }
    return factor;
}

static wh_status_t pace(wh_chain_line_t *line, const wh_chain_t *chain, wh_real_t length,
                        const wh_limits_t *limits) {
    wh_line_t *path = &line->path;
    path->slowed = 1;
    const wh_status_t status = wh_profile_plan(&path->path, length, limits);
    if (status != WH_OK || !(length > 0)) {
        return status;
    }
    return wh_line_slow_down(path, slowing_of_line(line, chain));
}

wh_status_t wh_elbow_line_plan(wh_chain_line_t *line, const wh_chain_t *chain, const wh_vec3_t *step,
                               const wh_line_caps_t *caps) {
    const wh_real_t length = wh_vec3_norm(step);
    const wh_real_t per_mm = length > 0 ? 1 / length : 0;
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(line->from[WH_CHAIN_THETA], &s, &c);
    line->path.direction =
        wh_vec3((step->x * c + step->y * s) * per_mm, (step->y * c - step->x * s) * per_mm, step->z * per_mm);
    line->links[0] = chain->links[0];
    line->links[1] = chain->links[1];
    wh_sin_cos(line->from[WH_CHAIN_REACH], &s, &c);
    line->start_x = line->links[0] + line->links[1] * c;
    line->start_y = line->links[1] * s;
    const wh_status_t bent = check_elbow(line, chain, length);
    if (bent != WH_OK) {
        return bent;
    }
    wh_real_t slopes[JOINTS];
    if (!look_along(line, chain, length, slopes)) {
        return WH_STATUS_LIMIT_EXCEEDED;
    }
    if (length > 0) {
        wh_elbow_line_axes(line, length, line->to);
    }
    const wh_status_t status = wh_chain_check_travel(chain, line->to);
    const wh_limits_t limits = path_limits(line, chain, slopes, caps);
    return status == WH_OK ? pace(line, chain, length, &limits) : status;
}
