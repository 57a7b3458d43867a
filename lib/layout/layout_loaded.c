/* `loaded` of robots and grippers: limits for the way of a wafer that is carried. */
#include "../math/hash.h"
#include "layout_internal.h"

void wh_layout_read_loaded(wh_reader_t *reader, wh_limits_t *loaded) {
    if (wh_reader_open(reader, "loaded", wh_layout_loaded_fields)) {
        static const struct {
            const char *name;
            wh_real_t most;
        } fields[] = {{"speed", 1e6}, {"acceleration", 1e8}, {"jerk", 1e10}};
        wh_real_t *const values[] = {&loaded->speed, &loaded->acceleration, &loaded->jerk};
        for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
            const bool is_given = wh_reader_has(reader, fields[i].name);
            *values[i] = is_given ? wh_reader_number(reader, fields[i].name, 0, 1, fields[i].most) : 0;
        }
        wh_reader_leave(reader);
    }
}

/* The smaller of two limits; 0 means no limit. */
static wh_real_t stricter(wh_real_t a, wh_real_t b) {
    return !(b > 0) || (a > 0 && a < b) ? a : b;
}

wh_limits_t wh_layout_loaded(const wh_layout_t *layout, size_t gripper) {
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    const wh_limits_t *own = &layout->grippers[gripper].loaded;
    wh_limits_t limits = *own;
    if (mount->axis == WH_NONE) {
        const wh_limits_t *robot = &layout->robots[mount->robot].loaded;
        limits.speed = stricter(own->speed, robot->speed);
        limits.acceleration = stricter(own->acceleration, robot->acceleration);
        limits.jerk = stricter(own->jerk, robot->jerk);
    }
    return limits;
}

static bool is_limited(const wh_limits_t *limits) {
    return limits->speed > 0 || limits->acceleration > 0 || limits->jerk > 0;
}

bool wh_layout_has_loaded(const wh_layout_t *layout) {
    bool any = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_limits_t limits = wh_layout_loaded(layout, g);
        any = any || is_limited(&limits);
    }
    return any;
}

uint64_t wh_layout_hash_loaded(uint64_t hash, const wh_layout_t *layout) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_limits_t limits = wh_layout_loaded(layout, g);
        if (is_limited(&limits)) {
            hash = wh_hash_int(wh_hash_word(hash, 'l'), (int32_t)g);
            hash = wh_hash_real(hash, limits.speed);
            hash = wh_hash_real(hash, limits.acceleration);
            hash = wh_hash_real(hash, limits.jerk);
        }
    }
    return hash;
}
