#include "along_arm.h"

#include <math.h>

#include "../math/trig.h"

/* The most that a heading may miss, degrees. */
#define MOST_OFF 0.01
/* A cosine as near to 1 as this is level. */
#define LEVEL 1e-12

double wh_along_arm(const wh_chain_t *chain, double rail, const wh_vec3_t *at) {
    const wh_pose_t base_from_robot = chain->is_placed ? chain->base_from_robot : wh_pose_identity();
    const wh_vec3_t apart = wh_vec3_subtract(at, &base_from_robot.r);
    const wh_vec3_t local = wh_mat3_transform_back(&base_from_robot.R, &apart);
    const wh_real_t own = wh_atan2(local.y, local.x - (wh_real_t)rail);
    return (double)(own + wh_atan2(base_from_robot.R.m[1][0], base_from_robot.R.m[0][0]));
}

/* The angle by which a level frame at a point must turn, rad; 0: it need not turn, or it misses by too
 * much. */
static double find_turn(const wh_chain_t *chain, double rail, const wh_vec3_t *at, const wh_mat3_t *R) {
    if (chain->kind != WH_CHAIN_TRZ || fabs(R->m[2][2]) < 1 - LEVEL) {
        return 0;
    }
    const double heading = (double)wh_atan2(R->m[1][0], R->m[0][0]);
    const double off = remainder(wh_along_arm(chain, rail, at) - heading, 2 * WH_PI);
    return fabs(off) > WH_SLACK_RAD && fabs(off) <= wh_rad_from_deg(MOST_OFF) ? off : 0;
}

static void turn(wh_mat3_t *R, double by) {
    const wh_mat3_t before = *R;
    const wh_mat3_t about_z = wh_mat3_from_rpy_deg(0, 0, wh_deg_from_rad(by));
    wh_mat3_multiply_to(&about_z, &before, R);
}

/* With several robots a robot's own way in turns, because the station may be right for the others. */
static void turn_approach(wh_layout_t *layout, size_t s, size_t r) {
    const wh_pose_t *place = &layout->places[s].base_from_station;
    wh_layout_approach_t *by = &layout->stations[s].by[r];
    wh_mat3_t R = by->is_turned ? by->R : place->R;
    const wh_vec3_t at = wh_vec3_add(&place->r, &by->aside);
    const double off = find_turn(&layout->robots[r].carrier.chain, by->rail, &at, &R);
    if (off != 0) {
        turn(&R, off);
        by->R = R;
        by->is_turned = true;
    }
}

void wh_layout_turn_along_arms(wh_layout_t *layout) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        for (size_t r = 0; layout->stations[s].by && r < layout->robot_count; ++r) {
            turn_approach(layout, s, r);
        }
        if (!layout->stations[s].by && layout->machine.carrier) {
            wh_pose_t *place = &layout->places[s].base_from_station;
            const double off =
                find_turn(&layout->carrier.chain, layout->stations[s].rail, &place->r, &place->R);
            if (off != 0) {
                turn(&place->R, off);
            }
        }
    }
}
