/* A survey: what a run would refuse of a layout, or fail at, found by planning and playing it and not by a
 * rule beside it.
 *
 * GET and PUT at every taught slot are rehearsed as a run rehearses them before its first slice: the same
 * patterns, planned by the same tracks. So a run refuses a layout if and only if its survey finds a slot that
 * is refused from home.
 *
 * Where nothing was found yet they are also played, in a cell full of wafers: see mcs/tryout.h. At the first
 * two slots and the last one; the PUTs also with a wafer as each other station's GET leaves it on the blade.
 * Then with each other blade on the robot, where that reaches all slots. FLIP is played at home, in front of
 * stations and in clamps: see lua/mcs/flip_room.lua.
 */
#ifndef WH_MCS_SURVEY_H
#define WH_MCS_SURVEY_H

#include "../layout/feasibility.h"
#include "mcs.h"
#include "tryout.h"

/* The motion control that plans; it must outlive the sandbox. */
typedef struct {
    wh_mcs_t mcs;
    wh_record_t record;
    wh_tryout_t tryout;
} wh_survey_t;

/* Adds to `check` a finding of kind WH_FINDING_REACH for every run of neighbouring slots at which GET or PUT
 * is refused: from home, and where theta can be a turn or more away from that; and one for each station with
 * `check_map` at which MAP is. For each blade that is not the station's effector it adds a warning of that
 * kind, with the first slot at which that blade is refused; and one for a prealigner whose GET has no room
 * to go aside by all that ALIGN may find. Where a command of such a blade fails as it is played, it adds a
 * warning of kind WH_FINDING_PLAY. Of that kind WH_FINDING_PLAY it adds the first
 * command of a station that fails or of which the cell complains, a warning for each FLIP that has no room,
 * and one for what it did not play: for commands of too many slices, and after WH_TRYOUT_ALL_SLICES. `layout`
 * was read in this sandbox, in which nothing may run afterwards. False, and the reason in `result`, if the
 * cell cannot be set up: a run would refuse it for the same reason. Cost: some 50 us a slot and blade; of an
 * upright stack only the ends are planned. Playing takes some 50 ms a station and blade. */
bool wh_survey_open(wh_survey_t *survey, wh_sandbox_t *sandbox, const wh_layout_t *layout,
                    wh_feasibility_t *check, wh_sandbox_result_t *result);

/* Frees what the planning took; `survey` may then be used again. */
void wh_survey_close(wh_survey_t *survey);

#endif
