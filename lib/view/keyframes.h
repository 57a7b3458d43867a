/* How a node of the scene moves: the poses of a trace as keyframes. */
#ifndef WH_VIEW_KEYFRAMES_H
#define WH_VIEW_KEYFRAMES_H

#include "../record/quaternion.h"
#include "../record/signals.h"
#include "gltf.h"

/* Keyframes being gathered. Host code: aborts when memory is out. */
typedef struct {
    float *times;
    float (*places)[3]; /* m */
    float (*turns)[4];
    size_t count, time_capacity, place_capacity, turn_capacity;
    double last[4]; /* the last quaternion */
} wh_keyframes_t;

/* Poses of grippers and links, on straight lines from one to the next. */
typedef struct {
    wh_thin_t grippers[WH_GRIPPERS], links[WH_TRACE_LINKS];
} wh_paths_t;

/* How far they may be off, to begin with, and how many points a gripper may have, and a link: then it
 * grows. */
#define WH_PATHS_MM 0.05
#define WH_PATHS_RAD 5e-4
#define WH_PATHS_LINK_MM 0.5
#define WH_PATHS_LINK_RAD 2e-3
#define WH_PATHS_POINTS 60000
#define WH_PATHS_LINK_POINTS 30000

/* Those of a finished trace. To be freed. Cost: about 1 us for each place of wh_signals_walk. */
wh_paths_t wh_paths_of_signals(const wh_signals_t *signals);
void wh_paths_free(wh_paths_t *paths);

/* A gripper's or a link's own. */
wh_keyframes_t wh_keyframes_of_track(const wh_signals_t *signals, const wh_thin_t *thin);

/* A wafer's: with its gripper while it is held, with as many keyframes as its way round needs. */
wh_keyframes_t wh_keyframes_of_wafer(const wh_signals_t *signals, const wh_paths_t *paths, int32_t wafer);

/* Moves the node by them, unless it rests, and frees them. */
void wh_keyframes_add(wh_keyframes_t *motion, wh_gltf_t *gltf, size_t node);

#endif
