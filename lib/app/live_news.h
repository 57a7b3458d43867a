/* The news that motion control has for a live page. */
#ifndef WH_APP_LIVE_NEWS_H
#define WH_APP_LIVE_NEWS_H

#include "../mcs/partners.h"
#include "../view/showing.h"

/* Null for what the page does not show. */
wh_news_t *wh_live_news_of(const wh_mcs_t *mcs, wh_mcs_news_t what, const wh_command_record_t *command);

/* The present task waits for `what`; null: it waits no longer. */
wh_news_t *wh_live_news_of_turn(const wh_mcs_t *mcs, const char *what);

#endif
