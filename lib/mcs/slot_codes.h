/* The codes that MAP gives the slots of a station, from two beams in front of the stack.
 *
 *   The beams stand upright in the station's frame, near the edge where the arm comes in. In the sweep along
 *   z each beam notes the heights between which a wafer breaks it. The face that looks at the slots belongs
 *   to the slot nearest to it, and so does the other face.
 *   0 empty      no wafer belongs to the slot
 *   1 single     one does, and nothing is wrong with it
 *   2 double     more than one does
 *   3 protruded  one does, too far out towards the arm
 *   4 crossed    one belongs to several slots, is tilted more than `level`, or lies farther from the slot's
 *                plane than the share `crossed` of the pitch; or only one beam sees it
 *   5 thick      one does, thicker than `thickest`
 *   6 thin       one does, thinner than `thinnest`
 *   Crossed has priority over double, and double over the others. One wafer never counts as two: if it
 *   belongs to several slots, it is crossed in each of them. A steep wafer, which upright beams may miss, is
 *   crossed in the slot of its centre. A level wafer so deep in the slot that no beam meets it is not
 *   seen. */
#ifndef WH_MCS_SLOT_CODES_H
#define WH_MCS_SLOT_CODES_H

#include "../layout/layout.h"

typedef enum {
    WH_SLOT_EMPTY,
    WH_SLOT_SINGLE,
    WH_SLOT_DOUBLE,
    WH_SLOT_PROTRUDED,
    WH_SLOT_CROSSED,
    WH_SLOT_THICK,
    WH_SLOT_THIN
} wh_slot_code_t;

/* The beams over a station: all lengths in mm. */
typedef struct {
    const wh_mapping_t *mapping;
    int slots;
    double pitch, radius;
} wh_slot_beams_t;

/* Enters a wafer into the codes of a station's slots, which must all be WH_SLOT_EMPTY before the first wafer.
 * The frame is that of the face that looks at the slots, e3 through the wafer. Cost: constant, plus the slots
 * that the wafer spans. */
void wh_slot_codes_add(const wh_slot_beams_t *beams, const wh_pose_t *station_from_face, double thickness,
                       int codes[]);

#endif
