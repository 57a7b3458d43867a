/* How a node of the scene moves: the poses of a trace as keyframes. */
#ifndef WH_REPORT_KEYFRAMES_H
#define WH_REPORT_KEYFRAMES_H

#include "report/gltf.h"
#include "report/quaternion.h"
#include "report/trace.h"

/* Keyframes being gathered. Host code: aborts when memory is out. */
typedef struct {
    float *times;
    float (*places)[3]; /* m */
    float (*turns)[4];
    size_t count, time_capacity, place_capacity, turn_capacity;
    double last[4]; /* the last quaternion */
} wh_keyframes_t;

/* A gripper's or a link's own. */
wh_keyframes_t wh_keyframes_of_track(const wh_trace_t *trace, const wh_thin_t *thin);

/* A wafer's: with its gripper while it is held, with as many keyframes as its way round needs. */
wh_keyframes_t wh_keyframes_of_wafer(const wh_trace_t *trace, int32_t wafer);

/* Moves the node by them, unless it rests, and frees them. */
void wh_keyframes_add(wh_keyframes_t *motion, wh_gltf_t *gltf, size_t node);

#endif
