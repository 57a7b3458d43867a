/* Within a budget: its threads, and the search of its box. */
#ifndef WH_STUDY_BUDGET_INTERNAL_H
#define WH_STUDY_BUDGET_INTERNAL_H

#include "budget_player.h"

/* One player for each thread. */
typedef struct {
    wh_budget_t *budget;
    wh_budget_player_t *players; /* options.threads of them */
} wh_budget_crew_t;

/* Does a piece of work, number `index`. */
typedef void wh_budget_work_t(wh_budget_player_t *player, void *user, size_t index);

/* Does pieces 0 to count - 1, each once, on all threads, in any order. False if there are none, or if some
 * pieces were left out because the search was ended. `what` is told; null: nothing is. */
bool wh_budget_share_out(wh_budget_crew_t *crew, size_t count, wh_budget_work_t *work, void *user,
                         const char *what);

/* Finds the box, once each error's width is known. False in the cases of wh_budget_find. */
bool wh_budget_find_box(wh_budget_crew_t *crew);

#endif
