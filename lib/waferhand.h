/* Waferhand: pick-and-place of wafers, step by step. The one header to include; it gathers the library's parts in
 * the direction in which data flows.
 *
 *     axes --motion--> gripper poses --core--> who holds which wafer --cell--> where it lies
 *
 * C99, no heap, no static state, the same bits on every machine. Link with -lwaferhand -lm.
 */
#ifndef WAFERHAND_H
#define WAFERHAND_H

/* In the order of the data flow. */
/* clang-format off */
#include "core/config.h"
#include "core/status.h"

#include "core/vector.h"
#include "core/pose.h"

#include "motion/trig.h"
#include "motion/profile.h"
#include "motion/move.h"
#include "motion/robot.h"
#include "motion/line.h"
#include "motion/machine.h"
#include "motion/track.h"

#include "core/proximity.h"
#include "core/event.h"
#include "core/grasp.h"
#include "core/restore.h"
#include "core/vacuum.h"
#include "core/hold.h"
#include "core/hash.h"

#include "cell/station.h"

#include "batch/batch.h"

#include "sim/faults.h"
#include "sim/condition.h"
#include "sim/slice.h"
#include "sim/simulator.h"
/* clang-format on */

#endif
