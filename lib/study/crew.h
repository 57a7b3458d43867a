/* Many runs of scripts on several threads, each as the next thread is free for it. */
#ifndef WH_STUDY_CREW_H
#define WH_STUDY_CREW_H

#include "../mcs/script_run.h"

/* Plays run `i` with the thread's own memory for it, and closes it. */
typedef void wh_crew_play_t(void *user, size_t i, wh_script_run_t *run);

/* Plays runs 0 to count - 1 on this number of threads, until wh_interrupt_came: runs that are not begun then
 * are left. False, and the reason on stderr, if there is no thread. */
bool wh_crew_play(size_t count, size_t threads, wh_crew_play_t *play, void *user);

#endif
