/* The parts that may be set on a simulator before its first slice; internal to the room. */
#ifndef WH_SIM_SETTING_INTERNAL_H
#define WH_SIM_SETTING_INTERNAL_H

#include "simulator.h"

static inline wh_status_t wh_simulator_check_setting(const wh_simulator_t *simulator, const void *setting) {
    if (!simulator || !setting) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (simulator->mark != WH_SIMULATOR_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    return simulator->table.slice > 0 ? WH_STATUS_OUT_OF_RANGE : WH_OK;
}

/* True if grips of this dt are of slices of this length. */
static inline bool wh_is_slice(wh_real_t slice_s, double dt) {
    const wh_real_t apart = slice_s - (wh_real_t)dt;
    return !(apart > 0 || apart < 0);
}

#endif
