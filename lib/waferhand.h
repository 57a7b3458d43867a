/* Waferhand: pick-and-place of wafers, step by step. The one header to include; it gathers the library's
 * parts in the direction in which data flows.
 *
 *     axes --motion--> gripper poses --grasp--> who holds which wafer --cell--> where it lies
 *
 * C99, no heap, no static state, the same bits on every machine. Link with -lwaferhand -lm.
 */
#ifndef WAFERHAND_H
#define WAFERHAND_H

/* In the order of the data flow. */
/* clang-format off */
#include "math/config.h"
#include "math/status.h"
#include "math/vector.h"
#include "math/pose.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "math/relation.h"
#include "math/hash.h"
#include "math/philox.h"
#include "math/deviate.h"

#include "grasp/proximity.h"
#include "grasp/face.h"
#include "grasp/event.h"
#include "grasp/grasp.h"
#include "grasp/restore.h"
#include "grasp/vacuum.h"
#include "grasp/hold.h"
#include "grasp/edge.h"
#include "grasp/passive.h"
#include "grasp/grips.h"

#include "batch/batch.h"

#include "motion/profile.h"
#include "motion/move.h"
#include "motion/robot.h"
#include "motion/line.h"
#include "motion/chain.h"
#include "motion/chain_line.h"
#include "motion/door.h"
#include "motion/machine.h"
#include "motion/track.h"
#include "motion/slow.h"

#include "cell/station.h"

#include "align/rim.h"
#include "align/sensing.h"
#include "align/merge.h"
#include "align/circle.h"
#include "align/marks.h"
#include "align/align.h"
#include "align/calibration.h"
#include "align/centring.h"
#include "align/beam.h"
#include "align/touch.h"
#include "align/teaching.h"

#include "sim/latching.h"
#include "sim/event_text.h"
#include "sim/grasp_text.h"
#include "sim/faults.h"
#include "sim/scanning.h"
#include "sim/doors.h"
#include "sim/physics.h"
#include "sim/slice.h"
#include "sim/simulator.h"
#include "sim/played.h"
#include "sim/size.h"
#include "sim/snapshot.h"
/* clang-format on */

#endif
