/* The limits of a URDF's joints: the extremes of the joints' values, and which is beyond. */
#include <string.h>

#include "../layout/arms.h"
#include "../math/trig.h"
#include "urdf_internal.h"

void wh_urdf_note_extremes(const wh_urdf_map_t *map, const wh_real_t axes[], const wh_real_t sources[],
                           wh_urdf_extremes_t *extremes) {
    for (int32_t i = 1; i < (int32_t)map->file->link_count; ++i) {
        const wh_real_t value = map->file->links[i].is_limited ? wh_urdf_joint(map, i, sources) : 0;
        for (size_t k = 0; map->file->links[i].is_limited && k < 2; ++k) {
            wh_urdf_extreme_t *extreme = &extremes->of[i][k];
            if (!extremes->is_known || (k == 0 ? value < extreme->value : value > extreme->value)) {
                extreme->value = value;
                memcpy(extreme->axes, axes, sizeof extreme->axes);
            }
        }
    }
    extremes->is_known = true;
}

/* The axes along which a search goes at most. */
#define WAY_AXES 3

/* A search for the extreme of one joint. */
typedef struct {
    const wh_urdf_map_t *map;
    const wh_layout_t *layout;
    wh_urdf_robot_t robot;
    int32_t link;
    wh_real_t sign; /* -1: for its least value */
} search_t;

/* Takes an arm that is too far out for its links back to where they reach. */
static void take_back(const search_t *search, wh_real_t axes[]) {
    const wh_arm_t *arm = wh_layout_arm_lengths(search->layout, search->map->robot);
    const wh_real_t yaw = wh_urdf_axis(&search->robot, search->layout, axes, WH_AXIS_YAW);
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(yaw, &s, &c);
    const wh_real_t aside = arm->reach * s;
    const wh_real_t ahead = 4 * arm->link * arm->link - aside * aside;
    for (size_t i = 0; ahead > 0 && i < search->map->arm_count; ++i) {
        const size_t axis = wh_urdf_radial_axis(&search->robot, i);
        const wh_travel_t *travel = wh_machine_travel(&search->layout->machine, axis);
        if (search->map->folds[i]) {
            const wh_real_t most = wh_real_max(arm->reach * c + wh_real_sqrt(ahead), travel->min);
            axes[axis] = axes[axis] > most ? most : axes[axis];
        }
    }
}

/* Sets one of the robot's axes, or the end of its travel. */
static void set_axis(const search_t *search, size_t axis, wh_real_t to, wh_real_t axes[]) {
    const size_t at = search->robot.first + axis;
    const wh_travel_t *travel = wh_machine_travel(&search->layout->machine, at);
    axes[at] = to > travel->max ? travel->max : wh_real_max(to, travel->min);
}

static wh_real_t length_of(const search_t *search, size_t axis) {
    const wh_travel_t *travel = wh_machine_travel(&search->layout->machine, search->robot.first + axis);
    return travel->max - travel->min;
}

/* True, and *best is there, if the joint's value at these axes is more extreme. */
static bool take_better(const search_t *search, wh_urdf_extreme_t *at, wh_urdf_extreme_t *best) {
    wh_real_t sources[WH_URDF_SOURCES];
    wh_real_t stretched[WH_URDF_ARMS];
    take_back(search, at->axes);
    wh_urdf_sources(search->map, search->layout, at->axes, sources, stretched);
    at->value = wh_urdf_joint(search->map, search->link, sources);
    if (!wh_urdf_is_reached(search->map, stretched) ||
        !(search->sign * at->value > search->sign * best->value)) {
        return false;
    }
    *best = *at;
    return true;
}

/* Moves in steps that are parts of the axes' travels. */
static bool try_step(const search_t *search, const size_t axes[], size_t count, const wh_real_t way[],
                     wh_real_t part, wh_urdf_extreme_t *best) {
    wh_urdf_extreme_t at = *best;
    for (size_t i = 0; i < count && i < WAY_AXES; ++i) {
        const wh_real_t from = at.axes[search->robot.first + axes[i]];
        set_axis(search, axes[i], from + part * way[i] * length_of(search, axes[i]), at.axes);
    }
    return take_better(search, &at, best);
}

static bool is_radial(const search_t *search, int32_t source) {
    bool radial = false;
    for (size_t i = 0; i < search->map->arm_count; ++i) {
        radial = radial || wh_urdf_radial_axis(&search->robot, i) - search->robot.first == (size_t)source;
    }
    return radial;
}

/* The robot's axes that bring a joint to its extreme: usually the axis that it follows. For an angle of the
 * links, or for an arm's R, where the links may not reach, they are the arm's R and yaw, and theta. Returns
 * how many there are. */
static size_t list_axes(const search_t *search, size_t axes[WAY_AXES]) {
    int32_t link = search->link;
    while (search->map->file->links[link].mimics >= 0) {
        link = search->map->file->links[link].mimics;
    }
    const int32_t source = search->map->drives[link].source;
    const size_t arm = source >= WH_URDF_FOLD_2 ? 1 : 0;
    axes[0] = source < WH_URDF_FOLD ? (size_t)source
                                    : wh_urdf_radial_axis(&search->robot, arm) - search->robot.first;
    axes[1] = WH_AXIS_YAW;
    axes[2] = WH_AXIS_THETA;
    const bool folds = search->map->folds[0] || search->map->folds[1];
    if (source < 0) {
        return 0;
    }
    return source >= WH_URDF_FOLD || (folds && is_radial(search, source)) ? WAY_AXES : 1;
}

/* Ways to go, in steps of each axis: along each axis, along R and yaw at once, and along yaw at the largest
 * R, so that R follows where the links just reach: an angle changes steeply there. */
#define FAR 1e12

static const wh_real_t ways[][WAY_AXES] = {{1, 0, 0},  {-1, 0, 0},  {0, 1, 0},   {0, -1, 0},
                                           {0, 0, 1},  {0, 0, -1},  {1, 1, 0},   {1, -1, 0},
                                           {-1, 1, 0}, {-1, -1, 0}, {FAR, 1, 0}, {FAR, -1, 0}};

/* True if one of the ways led on. */
static bool look_around(const search_t *search, const size_t axes[], size_t count, wh_real_t part,
                        wh_urdf_extreme_t *best) {
    const size_t way_count = count > 1 ? sizeof ways / sizeof ways[0] : 2;
    bool moved = false;
    for (size_t i = 0; i < way_count; ++i) {
        moved = try_step(search, axes, count, ways[i], part, best) || moved;
    }
    return moved;
}

/* An angle of the links may be largest at several places: looks at R and yaw evenly, where the other axes are
 * at their best. */
static void look_over(const search_t *search, const size_t axes[], wh_urdf_extreme_t *best) {
    enum { PLACES = 32 };
    for (int i = 0; i <= PLACES * (PLACES + 2); ++i) {
        const int column = i % (PLACES + 1);
        const int row = i / (PLACES + 1);
        const wh_real_t parts[2] = {(wh_real_t)column / PLACES, (wh_real_t)row / PLACES};
        wh_urdf_extreme_t at = *best;
        for (size_t k = 0; k < 2; ++k) {
            const size_t axis = search->robot.first + axes[k];
            const wh_real_t least = wh_machine_travel(&search->layout->machine, axis)->min;
            set_axis(search, axes[k], least + parts[k] * length_of(search, axes[k]), at.axes);
        }
        (void)take_better(search, &at, best);
    }
}

/* A compass search: from a quarter of the travels, by halves. */
static void go_on(const search_t *search, wh_urdf_extreme_t *best) {
    size_t axes[WAY_AXES];
    const size_t count = list_axes(search, axes);
    wh_real_t part = WH_REAL(0.25);
    if (count > 1) {
        look_over(search, axes, best);
    }
    for (int halves = 0; count > 0 && halves < 28; ++halves) {
        bool moved = true;
        for (int sweeps = 0; moved && sweeps < 6; ++sweeps) {
            moved = look_around(search, axes, count, part, best);
        }
        part /= 2;
    }
}

void wh_urdf_check_limits(const wh_urdf_map_t *map, const wh_layout_t *layout, wh_urdf_extremes_t *extremes,
                          wh_urdf_findings_t *findings) {
    const wh_real_t slack = WH_REAL(1e-6);
    search_t search = {map, layout, wh_urdf_robot(map, layout), 0, 1};
    for (int32_t i = 1; findings->beyond < 0 && i < (int32_t)map->file->link_count; ++i) {
        const wh_urdf_link_t *joint = &map->file->links[i];
        for (size_t k = 0; joint->is_limited && findings->beyond < 0 && k < 2; ++k) {
            wh_urdf_extreme_t *extreme = &extremes->of[i][k];
            search.link = i;
            search.sign = k == 0 ? -1 : 1;
            go_on(&search, extreme);
            if (!(extreme->value >= joint->least - slack && extreme->value <= joint->most + slack)) {
                findings->beyond = i;
                findings->beyond_value = extreme->value;
                memcpy(findings->beyond_axes, extreme->axes, sizeof findings->beyond_axes);
            }
        }
    }
}
