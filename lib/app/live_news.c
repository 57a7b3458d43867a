#include "live_news.h"

#include "../mcs/flow_held.h"
#include "../mcs/mcs.h"

static wh_news_t *news_of_command(const wh_mcs_t *mcs, wh_mcs_news_t what,
                                  const wh_command_record_t *command) {
    wh_news_t *news =
        wh_news_make(what == WH_MCS_COMMAND_BEGINS ? WH_NEWS_COMMAND_BEGINS : WH_NEWS_COMMAND_ENDED,
                     wh_mcs_utime(mcs), command->text, command->message);
    news->task = command->task;
    news->line = command->line;
    news->begin_s = command->begin_s;
    news->end_s = command->end_s;
    news->error = command->error;
    return news;
}

static wh_news_t *news_of_expectation(const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    const wh_expectation_record_t *last = &record->expectations[record->expectation_count - 1];
    wh_news_t *news = wh_news_make(WH_NEWS_EXPECTED, wh_mcs_utime(mcs), last->text, NULL);
    news->line = last->line;
    news->good = last->ok;
    return news;
}

static wh_news_t *news_of_station(const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    wh_news_t *news = wh_news_make(WH_NEWS_STATION, wh_mcs_utime(mcs), NULL, NULL);
    news->station = record->station_events[record->station_event_count - 1];
    return news;
}

static wh_news_t *news_of_end(const wh_mcs_t *mcs) {
    const wh_record_t *record = wh_mcs_record(mcs);
    char reason[1000] = "";
    if (!record->ok) {
        wh_record_reason(record, reason, sizeof reason);
    }
    wh_news_t *news = wh_news_make(WH_NEWS_ENDED, wh_mcs_utime(mcs), record->ok ? NULL : reason, NULL);
    news->good = record->ok;
    return news;
}

static wh_news_t *news_of_hold(const wh_mcs_t *mcs, bool is_held) {
    char robots[WH_MCS_HOLD_BYTES];
    wh_mcs_name_held(mcs, robots);
    wh_news_t *news = wh_news_make(WH_NEWS_HELD, wh_mcs_utime(mcs), robots, NULL);
    news->good = is_held;
    return news;
}

wh_news_t *wh_live_news_of(const wh_mcs_t *mcs, wh_mcs_news_t what, const wh_command_record_t *command) {
    switch ((int)what) {
    case WH_MCS_COMMAND_BEGINS:
    case WH_MCS_COMMAND_ENDED:
        return news_of_command(mcs, what, command);
    case WH_MCS_EXPECTED:
        return news_of_expectation(mcs);
    case WH_MCS_STATION_TOLD:
        return news_of_station(mcs);
    case WH_MCS_HELD:
    case WH_MCS_NOT_HELD:
        return news_of_hold(mcs, what == WH_MCS_HELD);
    case WH_MCS_FINISHED:
        return news_of_end(mcs);
    default:
        return NULL;
    }
}

wh_news_t *wh_live_news_of_turn(const wh_mcs_t *mcs, const char *what) {
    wh_news_t *news = wh_news_make(what ? WH_NEWS_WAITS : WH_NEWS_GOES_ON, wh_mcs_utime(mcs), what, NULL);
    news->task = wh_mcs_task(mcs);
    return news;
}
