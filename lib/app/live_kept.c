#include "live_kept.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* ------------------------------------------------------------------------------------------------- begins */

static void free_frames(wh_live_kept_t *kept) {
    for (size_t i = 0; i < kept->frame_count; ++i) {
        free(kept->frames[i].port);
        free(kept->frames[i].text);
    }
    free(kept->frames);
}

void wh_live_kept_begin(wh_live_kept_t *kept, const wh_layout_t *layout) {
    wh_signals_close(&kept->signals);
    wh_record_free(&kept->record);
    free_frames(kept);
    free(kept->failure);
    free(kept->held);
    *kept = (wh_live_kept_t){.is_anew = true};
    if (layout) {
        kept->record.layout = layout;
        wh_signals_begin(&kept->signals, layout, true);
    }
}

/* -------------------------------------------------------------------------------------------------- lists */

/* A change of entry `i`. */
static void note(wh_live_kept_t *kept, wh_live_list_t list, size_t i) {
    kept->due[list] = i < kept->due[list] ? i : kept->due[list];
    kept->has_news = true;
}

/* A list: its entries' size, and where in an entry its texts are. */
typedef struct {
    size_t size, texts[2];
} entries_t;

#define NO_TEXT SIZE_MAX

static const entries_t command_entries = {
    sizeof(wh_command_record_t),
    {offsetof(wh_command_record_t, text), offsetof(wh_command_record_t, message)}};
static const entries_t event_entries = {sizeof(wh_event_record_t), {NO_TEXT, NO_TEXT}};
static const entries_t expectation_entries = {sizeof(wh_expectation_record_t),
                                              {offsetof(wh_expectation_record_t, text), NO_TEXT}};
static const entries_t station_entries = {sizeof(wh_station_event_record_t), {NO_TEXT, NO_TEXT}};
static const entries_t wait_entries = {sizeof(wh_wait_record_t), {offsetof(wh_wait_record_t, what), NO_TEXT}};
static const entries_t frame_entries = {sizeof(wh_live_frame_t),
                                        {offsetof(wh_live_frame_t, port), offsetof(wh_live_frame_t, text)}};

/* Frees the texts of some entries of a list. */
static void free_texts(const entries_t *entries, void *list, size_t begin, size_t end) {
    char *items = list;
    for (size_t i = 2 * begin; i < 2 * end; ++i) {
        if (entries->texts[i % 2] != NO_TEXT) {
            char *text;
            memcpy(&text, items + (i / 2) * entries->size + entries->texts[i % 2], sizeof text);
            free(text);
        }
    }
}

/* Drops the older half of a list that is full. */
static void make_room(wh_live_kept_t *kept, const entries_t *entries, void *list, size_t *count) {
    if (*count < WH_LIVE_KEPT) {
        return;
    }
    char *items = list;
    const size_t half = *count / 2;
    free_texts(entries, list, 0, half);
    memmove(items, items + half * entries->size, (*count - half) * entries->size);
    *count -= half;
    kept->is_anew = kept->has_dropped = true;
}

/* --------------------------------------------------------------------------------------------------- news */

static void add_look(wh_live_kept_t *kept, const wh_glimpse_t *look) {
    wh_signals_t *signals = &kept->signals;
    wh_physics_state_t physics = *look->state.physics;
    wh_state_t state = look->state;
    physics.scan.number = 0; /* of its samples a look has only those of its own slice */
    state.physics = &physics;
    wh_signals_slice(signals, look->axis_count > 0 ? look->axes : NULL, look->axis_count, &state);
}

/* A simulator that was handed a state does not know the axes: then they are unknown, and not at home. */
static bool begins_anew(const wh_live_kept_t *kept, const wh_glimpse_t *look) {
    return look->epoch > kept->epoch || (!kept->has_looks && look->axis_count == 0 && look->state.seq > 0);
}

void wh_live_kept_look(wh_live_kept_t *kept, const wh_glimpse_t *look) {
    const wh_layout_t *layout = kept->record.layout;
    const bool is_start = look->state.seq == 0;
    if (look->epoch < kept->epoch) {
        return;
    }
    if (begins_anew(kept, look)) {
        kept->epoch = look->epoch;
        wh_signals_close(&kept->signals);
        wh_signals_begin(&kept->signals, layout, is_start);
        kept->is_anew = true;
    }
    kept->has_looks = true;
    if (!is_start) {
        add_look(kept, look);
    }
}

/* Texts of the entries from `count` on go. */
static void cut(wh_live_kept_t *kept, wh_live_list_t list, const entries_t *entries, void *items,
                size_t *count, size_t left) {
    free_texts(entries, items, left, *count);
    *count = left;
    kept->due[list] = left < kept->due[list] ? left : kept->due[list];
}

/* Commands that ended, and events, after that time have not been. A frame was said all the same: it stands
 * where the clock then stood. */
static void take_set_back(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    size_t commands = 0;
    size_t events = 0;
    size_t stations = 0;
    wh_live_kept_look(kept, news->look);
    while (commands < record->command_count &&
           record->commands[commands].end_s <= (double)news->utime / 1e6) {
        ++commands;
    }
    while (events < record->event_count && record->events[events].utime <= news->utime) {
        ++events;
    }
    while (stations < record->station_event_count &&
           record->station_events[stations].event.at_us <= news->utime) {
        ++stations;
    }
    cut(kept, WH_LIVE_COMMANDS, &command_entries, record->commands, &record->command_count, commands);
    cut(kept, WH_LIVE_EVENTS, &event_entries, record->events, &record->event_count, events);
    cut(kept, WH_LIVE_STATIONS, &station_entries, record->station_events, &record->station_event_count,
        stations);
    cut(kept, WH_LIVE_WAITS, &wait_entries, record->waits, &record->wait_count, 0);
    for (size_t i = 0; i < kept->frame_count; ++i) {
        const int64_t utime = kept->frames[i].utime;
        kept->frames[i].utime = utime < news->utime ? utime : news->utime;
    }
    kept->is_anew = true;
}

static void take_events(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    make_room(kept, &event_entries, record->events, &record->event_count);
    note(kept, WH_LIVE_EVENTS, record->event_count);
    wh_live_kept_look(kept, news->look);
    for (size_t i = 0; i < news->event_count; ++i) {
        wh_record_add_event(record, news->utime, WH_NONE, &news->events[i], &news->seats[i]);
    }
}

static void take_begin(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    make_room(kept, &command_entries, record->commands, &record->command_count);
    note(kept, WH_LIVE_COMMANDS, record->command_count);
    wh_command_record_t *command = wh_record_add_command(record, news->line, news->text, news->begin_s);
    command->task = news->task;
    command->end_s = HUGE_VAL; /* it runs */
}

/* The task's last command, which runs; else what ends has never begun. */
static size_t find_running(const wh_record_t *record, int32_t task) {
    for (size_t i = record->command_count; i > 0; --i) {
        if (record->commands[i - 1].task == task) {
            return isinf(record->commands[i - 1].end_s) ? i - 1 : record->command_count;
        }
    }
    return record->command_count;
}

static void take_end(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    if (find_running(record, news->task) == record->command_count) {
        take_begin(kept, news);
    }
    const size_t i = find_running(record, news->task);
    wh_command_record_t *command = &record->commands[i];
    free(command->text); /* in which the end may stand */
    command->text = wh_text_copy(news->text);
    command->end_s = news->end_s;
    command->error = news->error;
    command->message = news->more ? wh_text_copy(news->more) : NULL;
    note(kept, WH_LIVE_COMMANDS, i);
}

static int64_t slice_of(const wh_live_kept_t *kept, const wh_news_t *news) {
    return news->utime / kept->record.layout->slice_us;
}

static void end_wait(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    for (size_t i = record->wait_count; i > 0; --i) {
        wh_wait_record_t *wait = &record->waits[i - 1];
        if (wait->task == news->task && wait->is_open) {
            wait->is_open = false;
            wait->end = slice_of(kept, news);
            note(kept, WH_LIVE_WAITS, i - 1);
        }
    }
}

static void take_wait(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    end_wait(kept, news);
    make_room(kept, &wait_entries, record->waits, &record->wait_count);
    note(kept, WH_LIVE_WAITS, record->wait_count);
    wh_record_add_wait(record, news->task, WH_NONE, news->text, slice_of(kept, news));
}

static void take_frame(wh_live_kept_t *kept, const wh_news_t *news) {
    make_room(kept, &frame_entries, kept->frames, &kept->frame_count);
    note(kept, WH_LIVE_FRAMES, kept->frame_count);
    kept->frames =
        wh_array_grow(kept->frames, kept->frame_count, &kept->frame_capacity, sizeof *kept->frames);
    kept->frames[kept->frame_count++] =
        (wh_live_frame_t){news->utime, (char)news->line, wh_text_copy(news->more), wh_text_copy(news->text)};
}

static void take_rest(wh_live_kept_t *kept, const wh_news_t *news) {
    wh_record_t *record = &kept->record;
    switch ((int)news->kind) {
    case WH_NEWS_EXPECTED:
        make_room(kept, &expectation_entries, record->expectations, &record->expectation_count);
        note(kept, WH_LIVE_EXPECTATIONS, record->expectation_count);
        wh_record_add_expectation(record, news->line, news->text, news->good);
        break;
    case WH_NEWS_STATION:
        make_room(kept, &station_entries, record->station_events, &record->station_event_count);
        note(kept, WH_LIVE_STATIONS, record->station_event_count);
        wh_record_add_station_event(record, &news->station);
        break;
    case WH_NEWS_HELD:
        kept->has_news = true;
        kept->is_held = news->good;
        free(kept->held);
        kept->held = news->text && news->text[0] ? wh_text_copy(news->text) : NULL;
        break;
    case WH_NEWS_ENDED:
        kept->is_over = kept->has_news = true;
        kept->is_good = news->good;
        free(kept->failure);
        kept->failure = news->text ? wh_text_copy(news->text) : NULL;
        break;
    default:
        break;
    }
}

void wh_live_kept_news(wh_live_kept_t *kept, const wh_news_t *news) {
    static void (*const take[])(wh_live_kept_t *, const wh_news_t *) = {[WH_NEWS_EVENTS] = take_events,
                                                                        [WH_NEWS_SET_BACK] = take_set_back,
                                                                        [WH_NEWS_COMMAND_BEGINS] = take_begin,
                                                                        [WH_NEWS_COMMAND_ENDED] = take_end,
                                                                        [WH_NEWS_EXPECTED] = take_rest,
                                                                        [WH_NEWS_STATION] = take_rest,
                                                                        [WH_NEWS_WAITS] = take_wait,
                                                                        [WH_NEWS_GOES_ON] = end_wait,
                                                                        [WH_NEWS_FRAME] = take_frame,
                                                                        [WH_NEWS_ENDED] = take_rest,
                                                                        [WH_NEWS_HELD] = take_rest};
    take[news->kind](kept, news);
}
