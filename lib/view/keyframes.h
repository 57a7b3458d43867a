/* How a node of the scene moves: poses of a run's signals as keyframes. */
#ifndef WH_VIEW_KEYFRAMES_H
#define WH_VIEW_KEYFRAMES_H

#include "../record/quaternion.h"
#include "../record/signals.h"
#include "gltf.h"

/* Keyframes being gathered. Host code: aborts if out of memory. */
typedef struct {
    float *times;
    float (*places)[3]; /* m */
    float (*turns)[4];
    size_t count, time_capacity, place_capacity, turn_capacity;
    double last[4]; /* the last quaternion */
} wh_keyframes_t;

/* Poses of grippers and links, on straight lines from one to the next. */
typedef struct {
    wh_thin_t grippers[WH_GRIPPERS], links[WH_SIGNALS_LINKS];
} wh_paths_t;

/* Tolerances to begin with, and the number of points beyond which they grow, for grippers and for links. */
#define WH_PATHS_MM 0.05
#define WH_PATHS_RAD 5e-4
#define WH_PATHS_LINK_MM 0.5
#define WH_PATHS_LINK_RAD 2e-3
#define WH_PATHS_POINTS 60000
#define WH_PATHS_LINK_POINTS 30000

/* The paths of finished signals; wh_paths_free frees them. Cost: about 1 us for each place of
 * wh_signals_walk. */
wh_paths_t wh_paths_of_signals(const wh_signals_t *signals);
void wh_paths_free(wh_paths_t *paths);

/* A gripper's or a link's keyframes. */
wh_keyframes_t wh_keyframes_of_track(const wh_signals_t *signals, const wh_thin_t *thin);

/* A wafer's keyframes. While it is held it moves with its gripper, with more keyframes where that turns. */
wh_keyframes_t wh_keyframes_of_wafer(const wh_signals_t *signals, const wh_paths_t *paths, int32_t wafer);

/* Moves the node by the keyframes unless it rests, and frees them. */
void wh_keyframes_add(wh_keyframes_t *motion, wh_gltf_t *gltf, size_t node);

#endif
