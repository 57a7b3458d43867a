#include "size.h"

#include "../align/align.h"
#include "../align/beam.h"
#include "../align/calibration.h"
#include "../align/centring.h"
#include "../align/circle.h"
#include "../align/marks.h"
#include "../align/merge.h"
#include "../align/rim.h"
#include "../align/sensing.h"
#include "../align/teaching.h"
#include "../align/touch.h"
#include "../batch/batch.h"
#include "../cell/station.h"
#include "../grasp/edge.h"
#include "../grasp/event.h"
#include "../grasp/face.h"
#include "../grasp/grasp.h"
#include "../grasp/grips.h"
#include "../grasp/hold.h"
#include "../grasp/passive.h"
#include "../grasp/proximity.h"
#include "../grasp/restore.h"
#include "../grasp/vacuum.h"
#include "../math/config.h"
#include "../math/deviate.h"
#include "../math/hash.h"
#include "../math/philox.h"
#include "../math/pose.h"
#include "../math/relation.h"
#include "../math/rotation.h"
#include "../math/status.h"
#include "../math/trig.h"
#include "../math/vector.h"
#include "../motion/chain.h"
#include "../motion/chain_line.h"
#include "../motion/door.h"
#include "../motion/line.h"
#include "../motion/machine.h"
#include "../motion/move.h"
#include "../motion/profile.h"
#include "../motion/robot.h"
#include "../motion/slow.h"
#include "../motion/track.h"
#include "doors.h"
#include "event_text.h"
#include "faults.h"
#include "grasp_text.h"
#include "latching.h"
#include "physics.h"
#include "played.h"
#include "scanning.h"
#include "simulator.h"
#include "slice.h"
#include "snapshot.h"

typedef struct {
    const char *name;
    size_t size;
} size_row_t;

#define ROW(name)                                                                                            \
    { "wh_" #name "_t", sizeof(wh_##name##_t) }

/* Each struct of the public headers. */
static const size_row_t rows[] = {ROW(extent),
                                  ROW(vec3),
                                  ROW(mat3),
                                  ROW(pose),
                                  ROW(relation),
                                  ROW(philox),
                                  ROW(trial),
                                  ROW(tolerance),
                                  ROW(proximity),
                                  ROW(event),
                                  ROW(event_list),
                                  ROW(grasp_config),
                                  ROW(wafer),
                                  ROW(encounter),
                                  ROW(gripper),
                                  ROW(gripper_input),
                                  ROW(grasp_storage),
                                  ROW(grasp_counters),
                                  ROW(grasp),
                                  ROW(vacuum_config),
                                  ROW(vacuum_fault),
                                  ROW(vacuum),
                                  ROW(pads),
                                  ROW(hold),
                                  ROW(carry),
                                  ROW(edge),
                                  ROW(edge_wafer),
                                  ROW(edge_place),
                                  ROW(passive),
                                  ROW(passive_wafer),
                                  ROW(grip),
                                  ROW(grip_state),
                                  ROW(grips_parts),
                                  ROW(grips),
                                  ROW(batch),
                                  ROW(limits),
                                  ROW(motion),
                                  ROW(profile),
                                  ROW(move),
                                  ROW(travel),
                                  ROW(robot),
                                  ROW(line),
                                  ROW(line_caps),
                                  ROW(chain),
                                  ROW(chain_choice),
                                  ROW(chain_line),
                                  ROW(door),
                                  ROW(carrier),
                                  ROW(mount),
                                  ROW(machine),
                                  ROW(machine_cache),
                                  ROW(polar),
                                  ROW(via_point),
                                  ROW(via),
                                  ROW(way_out),
                                  ROW(way),
                                  ROW(segment),
                                  ROW(ways),
                                  ROW(vias),
                                  ROW(track),
                                  ROW(motion_share),
                                  ROW(slowness),
                                  ROW(slow),
                                  ROW(station),
                                  ROW(cell),
                                  ROW(place),
                                  ROW(passing),
                                  ROW(notch_shape),
                                  ROW(flat_shape),
                                  ROW(chip),
                                  ROW(rim),
                                  ROW(bad_field),
                                  ROW(placement),
                                  ROW(sensor_error),
                                  ROW(arc),
                                  ROW(sensor),
                                  ROW(glance),
                                  ROW(rim_point),
                                  ROW(rim_scan),
                                  ROW(rim_ray),
                                  ROW(circle),
                                  ROW(notch),
                                  ROW(notch_seen),
                                  ROW(flat),
                                  ROW(align_limits),
                                  ROW(align_result),
                                  ROW(calibration_scan),
                                  ROW(calibration),
                                  ROW(crossing),
                                  ROW(centring),
                                  ROW(centre),
                                  ROW(centres),
                                  ROW(beam),
                                  ROW(blade_outline),
                                  ROW(slice_motion),
                                  ROW(shade),
                                  ROW(touch_face),
                                  ROW(teach_measurement),
                                  ROW(teach_guess),
                                  ROW(taught),
                                  ROW(fault),
                                  ROW(fault_slot),
                                  ROW(faults),
                                  ROW(fault_request),
                                  ROW(fault_changes),
                                  ROW(door_beam),
                                  ROW(latching),
                                  ROW(latch_order),
                                  ROW(latch),
                                  ROW(latches),
                                  ROW(latching_calls),
                                  ROW(event_names),
                                  ROW(scan_order),
                                  ROW(scanner),
                                  ROW(scanning),
                                  ROW(scan),
                                  ROW(scanning_calls),
                                  ROW(door_set),
                                  ROW(doors),
                                  ROW(doors_calls),
                                  ROW(physics),
                                  ROW(physics_state),
                                  ROW(command),
                                  ROW(state),
                                  ROW(link),
                                  ROW(gripping_calls),
                                  ROW(observer),
                                  ROW(simulator_given),
                                  ROW(simulator),
                                  ROW(played_row),
                                  ROW(played_fault),
                                  ROW(played_order),
                                  ROW(played_parts),
                                  ROW(played),
                                  ROW(played_motion),
                                  ROW(played_room),
                                  ROW(player),
                                  ROW(snapshot_room)};

static bool is_same(const char *a, const char *b) {
    while (*a != '\0' && *a == *b) {
        ++a;
        ++b;
    }
    return *a == *b;
}

size_t wh_size(const char *name) {
    size_t size = 0;
    for (size_t i = 0; name && size == 0 && i < sizeof rows / sizeof rows[0]; ++i) {
        size = is_same(rows[i].name, name) ? rows[i].size : 0;
    }
    return size;
}
