/* A survey finds what a run would refuse in a layout, or fail at. It plans and plays the commands; it has no
 * separate rule.
 *
 * GET and PUT at every taught slot are rehearsed like in a run before its first slice: with its patterns and
 * its tracks. So a run refuses a layout if and only if its survey finds a slot that is refused from home.
 *
 * If nothing was found yet, they are also played, in a cell full of wafers: see tryout.h. They are
 * played at the first two slots and the last one; the PUTs also with a wafer as each other station's GET
 * leaves it on the blade. Then they are played with each other blade on the robot, if it reaches all slots.
 * FLIP is played at home, in front of stations and in clamps: see lua/mcs/flip_room.lua.
 */
#ifndef WH_SURVEY_SURVEY_H
#define WH_SURVEY_SURVEY_H

#include "../mcs/mcs.h"
#include "feasibility.h"
#include "tryout.h"

/* Called before each long piece of work: `done` of `total`; `what` names the work, a constant
 * text. */
typedef void wh_survey_tell_t(void *user, const char *what, size_t done, size_t total);

/* The motion control that plans; it must outlive the sandbox. */
typedef struct {
    wh_survey_tell_t *tell; /* null: no progress is told */
    void *user;
    wh_mcs_t mcs;
    wh_record_t record;
    wh_tryout_t tryout;
} wh_survey_t;

/* `survey` is blank except for `tell` and `user`. Adds findings to `check`. Findings of kind
 * WH_FINDING_REACH: one for every run of neighbouring slots at which GET or PUT is refused, from home, and
 * from thetas a turn or more away if theta can be there; and one for each station with `check_map` at which
 * MAP is refused. Warnings of that kind: one for each blade that is not the station's effector, with the
 * first slot at which it is refused; and one for a prealigner whose GET has no room to go aside by all that
 * ALIGN may find. Findings of kind WH_FINDING_PLAY: the first command of a station that fails or causes a
 * complaint of the cell. Warnings of that kind: for a command of such a blade that fails when played, for
 * each FLIP that has no room, and for what it did not play: commands of too many slices, and all after
 * WH_TRYOUT_ALL_SLICES. `layout` was read in this sandbox, in which nothing may run afterwards. False, and
 * the reason in `result`, if the cell cannot be set up: a run would refuse it for this reason, too. Cost:
 * about 50 us for a slot and blade; in an upright stack only the ends are planned. Playing takes about 50 ms
 * for a station and blade. */
bool wh_survey_open(wh_survey_t *survey, wh_sandbox_t *sandbox, const wh_layout_t *layout,
                    wh_feasibility_t *check, wh_sandbox_result_t *result);

/* Frees the memory of the planning; `survey` may then be used again. */
void wh_survey_close(wh_survey_t *survey);

#endif
