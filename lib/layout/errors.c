#include "errors.h"

/* What a number is drawn for: the first word of its counter. Never to be renumbered, or seeds would mean other trials. */
enum {
    FIELD_PLACEMENT = 0x100,
    FIELD_TILT_Y = 0x1FF,
    FIELD_TEACHING = 0x200,
    FIELD_VALVE = 0x300,
    FIELD_VACUUM = 0x400
};

static wh_real_t draw(const wh_spread_t *spread, const wh_trial_t *trial, uint32_t field, size_t index) {
    if (!(spread->width > 0)) {
        return 0;
    }
    if (spread->shape == WH_SHAPE_UNIFORM) {
        return spread->width * (wh_real_t)(2 * wh_deviate_uniform(trial, field, (uint32_t)index) - 1);
    }
    return spread->width * (wh_real_t)wh_deviate_normal(trial, field, (uint32_t)index);
}

wh_displacement_t wh_errors_draw_wafer(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer) {
    const wh_spread_t *of = errors->wafers[wafer].of;
    wh_displacement_t drawn;
    drawn.moved.x = draw(&of[WH_PLACEMENT_DX], trial, FIELD_PLACEMENT + WH_PLACEMENT_DX, wafer);
    drawn.moved.y = draw(&of[WH_PLACEMENT_DY], trial, FIELD_PLACEMENT + WH_PLACEMENT_DY, wafer);
    drawn.moved.z = draw(&of[WH_PLACEMENT_DZ], trial, FIELD_PLACEMENT + WH_PLACEMENT_DZ, wafer);
    drawn.turn[0] = draw(&of[WH_PLACEMENT_TILT], trial, FIELD_PLACEMENT + WH_PLACEMENT_TILT, wafer);
    drawn.turn[1] = draw(&of[WH_PLACEMENT_TILT], trial, FIELD_TILT_Y, wafer);
    drawn.turn[2] = draw(&of[WH_PLACEMENT_TURN], trial, FIELD_PLACEMENT + WH_PLACEMENT_TURN, wafer);
    return drawn;
}

wh_displacement_t wh_errors_draw_station(const wh_errors_t *errors, const wh_trial_t *trial, size_t station) {
    const wh_spread_t *of = errors->stations[station].of;
    wh_displacement_t drawn;
    drawn.moved.x = draw(&of[WH_TEACHING_X], trial, FIELD_TEACHING + WH_TEACHING_X, station);
    drawn.moved.y = draw(&of[WH_TEACHING_Y], trial, FIELD_TEACHING + WH_TEACHING_Y, station);
    drawn.moved.z = draw(&of[WH_TEACHING_Z], trial, FIELD_TEACHING + WH_TEACHING_Z, station);
    for (uint32_t i = 0; i < 3; ++i) {
        drawn.turn[i] =
            draw(&of[WH_TEACHING_ROLL + i], trial, FIELD_TEACHING + WH_TEACHING_ROLL + i, station);
    }
    return drawn;
}

wh_real_t wh_errors_draw_valve(const wh_errors_t *errors, const wh_trial_t *trial, size_t gripper) {
    return wh_real_abs(draw(&errors->valves[gripper], trial, FIELD_VALVE, gripper));
}

wh_real_t wh_errors_draw_vacuum(const wh_errors_t *errors, const wh_trial_t *trial) {
    return wh_real_abs(draw(&errors->vacuum, trial, FIELD_VACUUM, 0));
}

bool wh_displacement_is_any(const wh_displacement_t *displacement) {
    const wh_vec3_t *moved = &displacement->moved;
    const wh_real_t *turn = displacement->turn;
    return wh_real_abs(moved->x) + wh_real_abs(moved->y) + wh_real_abs(moved->z) + wh_real_abs(turn[0]) +
               wh_real_abs(turn[1]) + wh_real_abs(turn[2]) >
           0;
}
