/* A grasp table in words, and where one is not as another: for a test that fails, and for a firmware's log.
 *
 *     slice 126
 *     wafer 0: at 700.000, 0.000, 903.480 mm, turned 0.000 deg, tilted 0.000 deg: held by gripper 0
 *     gripper 0: at 700.000, 0.000, 903.480 mm, turned 0.000 deg, tilted 0.000 deg: open, holds wafer 0
 *
 * A wafer or gripper is turned by the heading of its e1 in base, and tilted by the angle between its e3 and
 * that of base: 180 deg lies face down. It uses no stdio, no heap, and no static data.
 *
 * Bytes of stack on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12 (tests/verify/footprint;
 * a function of yours that gives names is added):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_grasp_text                   224    232     224    232
 *     stack of wh_grasp_difference             464    472     392    392
 */
#ifndef WH_SIM_GRASP_TEXT_H
#define WH_SIM_GRASP_TEXT_H

#include "../grasp/grasp.h"
#include "event_text.h"

WH_HEADER_BEGIN

/* Room for each text of wh_grasp_text if no name has more than 63 bytes; a constant, for an array's size. */
#define WH_GRASP_TEXT_SIZE(wafer_count, gripper_count)                                                       \
    (WH_CAST(size_t, 32) + 256 * WH_CAST(size_t, wafer_count) + 672 * WH_CAST(size_t, gripper_count))

/* Writes the table: its slice, each wafer, each gripper, a line each. A gripper also says which wafer it
 * follows for a near miss, and which it contests. `names` may be null: "wafer 0". A table that is null or not
 * initialised is one line that says so. Returns the length without the terminator; if that is not below
 * `size`, the text is cut off. `buffer` always ends with a terminator, unless `size` is 0, when it may be
 * null. Cost: some microseconds a line. */
size_t wh_grasp_text(const wh_grasp_t *table, const wh_event_names_t *names, char *buffer, size_t size)
    WH_SYMBOL(wh_grasp_text);

/* Writes what of `found` is not as in `expected`, a line each, with the expected value in brackets:
 *
 *     wafer 0: z 903.480 mm (expected 900.000 mm)
 *     wafer 0: held by gripper 0 (expected none)
 *
 * It compares what wh_grasp_hash goes by, bit for bit: the text is empty, and the result 0, exactly if all of
 * that is equal. A difference of less than 1e-15 mm is told to be in bits that are not shown. Configurations
 * and counters are not compared. If a count differs, or a table is null or not initialised, nothing else is
 * compared. `names`, the buffer and the result are those of wh_grasp_text. Cost: linear in
 * wafers and grippers, and some microseconds for each line. */
size_t wh_grasp_difference(const wh_grasp_t *expected, const wh_grasp_t *found, const wh_event_names_t *names,
                           char *buffer, size_t size) WH_SYMBOL(wh_grasp_difference);

WH_HEADER_END

#endif
