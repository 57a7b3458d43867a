#include "errors.h"

#include <string.h>

/* In the order of WH_SPREADS. */
const char *const wh_errors_teaching_names[] = {"x", "y", "z", "roll", "pitch", "yaw", NULL};

double wh_spread_reach(const wh_spread_t *spread) {
    return (spread->shape == WH_SHAPE_NORMAL ? WH_SPREAD_DEVIATIONS : 1) * (double)spread->width;
}

wh_real_t wh_spread_draw(const wh_spread_t *spread, const wh_trial_t *trial, uint32_t field, size_t index) {
    if (!(spread->width > 0)) {
        return 0;
    }
    if (spread->shape == WH_SHAPE_UNIFORM) {
        return spread->width * (wh_real_t)(2 * wh_deviate_uniform(trial, field, (uint32_t)index) - 1);
    }
    return spread->width * (wh_real_t)wh_deviate_normal(trial, field, (uint32_t)index);
}

/* The draw for one part of a displacement: which spread it has, and for which field. */
typedef struct {
    size_t spread;
    uint32_t field;
} component_t;

static wh_displacement_t draw_components(const wh_spreads_t *spreads, const component_t components[6],
                                         const wh_trial_t *trial, size_t index) {
    wh_real_t drawn[6];
    for (size_t i = 0; i < 6; ++i) {
        drawn[i] = wh_spread_draw(&spreads->of[components[i].spread], trial, components[i].field, index);
    }
    return (wh_displacement_t){{drawn[0], drawn[1], drawn[2]}, {drawn[3], drawn[4], drawn[5]}};
}

wh_displacement_t wh_errors_draw_wafer(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer) {
    static const component_t components[] = {{0, 0x100}, {1, 0x101}, {2, 0x102},
                                             {3, 0x103}, {3, 0x1FF}, {4, 0x104}};
    if (errors->given) {
        return errors->given->wafers[wafer];
    }
    return draw_components(&errors->wafers[wafer], components, trial, wafer);
}

wh_displacement_t wh_errors_draw_station(const wh_errors_t *errors, const wh_trial_t *trial, size_t station) {
    static const component_t components[] = {{0, 0x200}, {1, 0x201}, {2, 0x202},
                                             {3, 0x203}, {4, 0x204}, {5, 0x205}};
    if (errors->given) {
        return errors->given->stations[station];
    }
    wh_displacement_t drawn = draw_components(&errors->stations[station], components, trial, station);
    if (errors->robot_count > 1) {
        drawn.moved = wh_vec3(0, 0, 0);
    }
    return drawn;
}

wh_vec3_t wh_errors_draw_taught(const wh_errors_t *errors, const wh_trial_t *trial, size_t station,
                                size_t robot) {
    const bool is_any = errors->robot_count > 1 && (!errors->given || errors->given->taught);
    wh_real_t drawn[3] = {0, 0, 0};
    if (is_any && errors->given) {
        return errors->given->taught[station * errors->robot_count + robot];
    }
    for (uint32_t i = 0; is_any && i < 3; ++i) {
        const uint32_t field = 0x210 + 0x10 * (uint32_t)robot + i;
        drawn[i] = wh_spread_draw(&errors->stations[station].of[i], trial, field, station);
    }
    return wh_vec3(drawn[0], drawn[1], drawn[2]);
}

wh_real_t wh_errors_draw_valve(const wh_errors_t *errors, const wh_trial_t *trial, size_t gripper) {
    return errors->given ? errors->given->valves[gripper]
                         : wh_real_abs(wh_spread_draw(&errors->valves[gripper], trial, 0x300, gripper));
}

wh_real_t wh_errors_draw_process(const wh_errors_t *errors, const wh_trial_t *trial, size_t station) {
    return errors->given ? 0 : wh_spread_draw(&errors->process, trial, 0x410, station);
}

wh_real_t wh_errors_draw_port(const wh_errors_t *errors, const wh_trial_t *trial, size_t station,
                              size_t step) {
    return errors->given ? 0 : wh_spread_draw(&errors->port, trial, 0x411, station * 32 + step);
}

wh_real_t wh_errors_draw_vacuum(const wh_errors_t *errors, const wh_trial_t *trial) {
    return errors->given ? errors->given->vacuum
                         : wh_real_abs(wh_spread_draw(&errors->vacuum, trial, 0x400, 0));
}

wh_real_t wh_errors_draw_debounce(const wh_errors_t *errors, const wh_trial_t *trial) {
    return errors->given ? errors->given->debounce
                         : wh_real_abs(wh_spread_draw(&errors->debounce, trial, 0x401, 0));
}

void wh_errors_draw_rim(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer, const wh_rim_t *rim,
                        double drawn[WH_RIM_DRAWS]) {
    if (errors->given) {
        memcpy(drawn, errors->given->rims[wafer], WH_RIM_DRAWS * sizeof *drawn);
    } else if (errors->rims) {
        wh_rim_draw_all(&errors->rims[wafer], trial, wafer, rim, drawn);
    } else {
        memset(drawn, 0, WH_RIM_DRAWS * sizeof *drawn);
    }
}

bool wh_displacement_is_any(const wh_displacement_t *displacement) {
    const wh_vec3_t *moved = &displacement->moved;
    const wh_real_t *turn = displacement->turn;
    return wh_real_abs(moved->x) + wh_real_abs(moved->y) + wh_real_abs(moved->z) + wh_real_abs(turn[0]) +
               wh_real_abs(turn[1]) + wh_real_abs(turn[2]) >
           0;
}

const char *wh_errors_teaching_name(size_t axis) {
    return wh_errors_teaching_names[axis];
}

wh_real_t *wh_displacement_part(wh_displacement_t *displacement, size_t axis) {
    wh_real_t *const parts[WH_SPREADS] = {&displacement->moved.x, &displacement->moved.y,
                                          &displacement->moved.z, &displacement->turn[0],
                                          &displacement->turn[1], &displacement->turn[2]};
    return parts[axis];
}
