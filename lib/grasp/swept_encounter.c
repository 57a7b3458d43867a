#include "encounter_internal.h"
#include "proximity_internal.h"

void wh_encounter_track_swept(wh_watch_t *watch) {
    wh_sweep_t sweep;
    wh_sweep_between(&watch->gripper->base_from_gripper, watch->base_from_gripper, &sweep);
    watch->sweep = &sweep;
    wh_encounter_track(watch);
    watch->sweep = NULL;
}

static bool is_near_at(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *reach) {
    wh_pose_t then;
    wh_sweep_pose_at(watch->sweep, reach->t, &then);
    return wh_closeness_measure(&watch->table->config, base_from_wafer, &then, reach);
}

bool wh_closeness_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *closest) {
    const wh_grasp_config_t *config = &watch->table->config;
    wh_span_t part;
    if (!wh_sweep_within(watch->sweep, base_from_wafer, config->near_projz, config->near_projxy, &part)) {
        return false;
    }
    closest->t = wh_sweep_closest(watch->sweep, base_from_wafer, &part, config->tolerance.projz,
                                  config->tolerance.projxy);
    if (is_near_at(watch, base_from_wafer, closest)) {
        return true;
    }
    /* The closest instant may be the one on the neighbourhood's edge; then the middle tells. */
    wh_closeness_t middle = {.t = (part.first + part.last) / 2};
    return is_near_at(watch, base_from_wafer, &middle);
}

void wh_measure_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_real_t t,
                      wh_proximity_t *measured) {
    wh_tolerance_t tolerance = watch->table->config.tolerance;
    tolerance.projz *= WH_SWEEP_INSIDE;
    wh_pose_t then;
    wh_sweep_pose_at(watch->sweep, t, &then);
    wh_proximity_values(base_from_wafer, &then, &tolerance, measured);
}
