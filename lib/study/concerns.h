/* The drawn errors that a run has to do with.
 *
 * A trial draws every width of the layout. An error of a wafer that nothing moves, or of a station that
 * nothing goes to, decides nothing; told as a cause it would make all intervals wider, and look guilty by
 * chance.
 */
#ifndef WH_STUDY_CONCERNS_H
#define WH_STUDY_CONCERNS_H

#include "study.h"

/* Those of study->drawn that concern the run without errors, in their order; to be freed. A wafer concerns
 * it if it was moved, held or asked for, and, if the script reads what it measures, if it lies in a
 * station that was gone to. A station does if a robot went there or if a wafer that concerns it lies
 * there; a rim and a beam follow their wafer and their station. Where collisions are looked for all wafers
 * and stations do, for each may be hit. The place that a robot was taught concerns the run if that robot
 * went there. Valves and vacuum always do. */
wh_cause_t *wh_concerns_choose(const wh_study_t *study, size_t *count);

#endif
