#include "keyframes.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* glTF has metres. */
#define METRES 0.001

static void add_key(wh_keyframes_t *motion, double seconds, const wh_vec3_t *r, const double q[4]) {
    const size_t i = motion->count;
    motion->times = wh_array_grow(motion->times, i, &motion->time_capacity, sizeof *motion->times);
    motion->places = wh_array_grow(motion->places, i, &motion->place_capacity, sizeof *motion->places);
    motion->turns = wh_array_grow(motion->turns, i, &motion->turn_capacity, sizeof *motion->turns);
    /* Times must rise, and two slices may be the same time as a float. */
    if (i > 0 && !((float)seconds > motion->times[i - 1])) {
        return;
    }
    motion->times[i] = (float)seconds;
    motion->places[i][0] = (float)(METRES * r->x);
    motion->places[i][1] = (float)(METRES * r->y);
    motion->places[i][2] = (float)(METRES * r->z);
    for (size_t c = 0; c < 4; ++c) {
        motion->turns[i][c] = (float)q[c];
    }
    ++motion->count;
}

/* -------------------------------------------------------------------------------------------------- paths */

typedef struct {
    const wh_signals_t *signals;
    wh_paths_t *paths;
} tracing_t;

static void add_places(void *user, int64_t slice) {
    const tracing_t *tracing = user;
    const wh_signals_t *signals = tracing->signals;
    wh_pose_t links[WH_SIGNALS_LINKS];
    wh_pose_t gripper;
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        wh_signals_gripper(signals, g, slice, &gripper);
        wh_thin_add_pose(&tracing->paths->grippers[g], slice, &gripper);
    }
    if (wh_signals_links(signals, slice, links)) {
        for (size_t i = 0; i < WH_SIGNALS_LINKS; ++i) {
            wh_thin_add_pose(&tracing->paths->links[i], slice, &links[i]);
        }
    }
}

wh_paths_t wh_paths_of_signals(const wh_signals_t *signals) {
    wh_paths_t paths;
    tracing_t tracing = {signals, &paths};
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        wh_thin_open(&paths.grippers[g], 3, WH_PATHS_MM, WH_PATHS_RAD, WH_PATHS_POINTS);
    }
    for (size_t i = 0; i < WH_SIGNALS_LINKS; ++i) {
        wh_thin_open(&paths.links[i], 3, WH_PATHS_LINK_MM, WH_PATHS_LINK_RAD, WH_PATHS_LINK_POINTS);
    }
    wh_signals_walk(signals, add_places, &tracing);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        wh_thin_finish(&paths.grippers[g]);
    }
    for (size_t i = 0; i < WH_SIGNALS_LINKS; ++i) {
        wh_thin_finish(&paths.links[i]);
    }
    return paths;
}

void wh_paths_free(wh_paths_t *paths) {
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        wh_thin_close(&paths->grippers[g]);
    }
    for (size_t i = 0; i < WH_SIGNALS_LINKS; ++i) {
        wh_thin_close(&paths->links[i]);
    }
}

/* ---------------------------------------------------------------------------------------------- keyframes */

static double seconds_of(const wh_signals_t *signals, double slice) {
    return slice * (double)signals->layout->slice_us / 1e6;
}

wh_keyframes_t wh_keyframes_of_track(const wh_signals_t *signals, const wh_thin_t *thin) {
    wh_keyframes_t motion = {0};
    for (size_t i = 0; i < thin->list.count; ++i) {
        const double *values = wh_points_numbers(&thin->list, i);
        const wh_vec3_t r = {values[0], values[1], values[2]};
        add_key(&motion, seconds_of(signals, (double)thin->list.points[i].slice), &r, values + 3);
    }
    return motion;
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void add_pose(wh_keyframes_t *motion, const wh_signals_t *signals, double slice,
                     const wh_pose_t *pose) {
    double q[4];
    wh_quaternion_from_matrix(&pose->R, motion->count > 0 ? motion->last : NULL, q);
    memcpy(motion->last, q, sizeof q);
    add_key(motion, seconds_of(signals, slice), &pose->r, q);
}

/* Between point `i` of its gripper and the next, `share` of the way. */
static void add_held(wh_keyframes_t *motion, const wh_signals_t *signals, const wh_stay_t *stay,
                     const wh_thin_t *thin, size_t i, double share) {
    const double *a = wh_points_numbers(&thin->list, i);
    const double *b = wh_points_numbers(&thin->list, i + 1);
    const int64_t from = thin->list.points[i].slice;
    const int64_t to = thin->list.points[i + 1].slice;
    wh_pose_t gripper;
    double q[4];
    gripper.r =
        wh_vec3(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]));
    wh_quaternion_slerp(a + 3, b + 3, share, q);
    wh_quaternion_to_matrix(q, &gripper.R);
    const wh_pose_t pose = wh_pose_compose(&gripper, &stay->pose);
    add_pose(motion, signals, (double)from + share * (double)(to - from), &pose);
}

/* How many straight lines a wafer takes that goes round its gripper's origin: the chord of an angle a is off
 * by r a^2 / 8. */
static int parts_of(const wh_stay_t *stay, const wh_thin_t *thin, size_t i) {
    double turn[3];
    wh_quaternion_turn(wh_points_numbers(&thin->list, i) + 3, wh_points_numbers(&thin->list, i + 1) + 3,
                       turn);
    const double square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    const double off = wh_vec3_norm(&stay->pose.r) * square / 8;
    int parts = 1;
    while ((double)(parts * parts) * thin->list.tolerance < off && parts < 256) {
        ++parts;
    }
    return parts;
}

static void add_hold(wh_keyframes_t *motion, const wh_signals_t *signals, const wh_thin_t *thin,
                     const wh_stay_t *stay, int64_t end) {
    const wh_points_t *list = &thin->list;
    for (size_t i = 0; i + 1 < list->count && list->points[i].slice < end; ++i) {
        const int64_t next = list->points[i + 1].slice;
        if (next <= stay->slice) {
            continue;
        }
        const int parts = parts_of(stay, thin, i);
        for (int part = list->points[i].slice < stay->slice ? 1 : 0; part < parts; ++part) {
            add_held(motion, signals, stay, thin, i, (double)part / parts);
        }
        if (next >= end || i + 2 == list->count) {
            add_held(motion, signals, stay, thin, i, 1);
        }
    }
}

wh_keyframes_t wh_keyframes_of_wafer(const wh_signals_t *signals, const wh_paths_t *paths, int32_t wafer) {
    wh_keyframes_t motion = {0};
    const wh_stay_t *stay = NULL;
    for (size_t i = 0; i <= signals->stay_count; ++i) {
        const bool over = i == signals->stay_count;
        if (!over && signals->stays[i].wafer != wafer) {
            continue;
        }
        const int64_t end = over ? signals->last : signals->stays[i].slice;
        if (stay && stay->holder != WH_NONE) {
            add_hold(&motion, signals, &paths->grippers[stay->holder], stay, end);
        } else if (stay) {
            add_pose(&motion, signals, (double)stay->slice, &stay->pose);
            add_pose(&motion, signals, (double)end, &stay->pose);
        }
        stay = over ? stay : &signals->stays[i];
    }
    return motion;
}

/* -------------------------------------------------------------------------------------------------- nodes */

static bool differ(const float a[], const float b[], size_t count) {
    bool same = true;
    for (size_t i = 0; i < count; ++i) {
        same = same && !(a[i] < b[i]) && !(a[i] > b[i]);
    }
    return !same;
}

static bool rests(const wh_keyframes_t *motion) {
    for (size_t i = 1; i < motion->count; ++i) {
        if (differ(motion->places[i], motion->places[0], 3) ||
            differ(motion->turns[i], motion->turns[0], 4)) {
            return false;
        }
    }
    return true;
}

void wh_keyframes_add(wh_keyframes_t *motion, wh_gltf_t *gltf, size_t node) {
    if (!rests(motion)) {
        const float(*places)[3] = (const float(*)[3])motion->places;
        const float(*turns)[4] = (const float(*)[4])motion->turns;
        wh_gltf_add_motion(gltf, node, motion->times, places, turns, motion->count);
    }
    free(motion->times);
    free(motion->places);
    free(motion->turns);
    memset(motion, 0, sizeof *motion);
}
