#include "showing.h"

#include <stdlib.h>
#include <string.h>

#include "../record/seat.h"
#include "../text/array.h"

/* The room between the two sides has this bit while nobody has taken what is in it. */
#define IS_NEW 4U

struct wh_showing {
    const wh_layout_t *layout;
    wh_glimpse_t rooms[3];
    unsigned between; /* atomic: a room's number, and IS_NEW */
    unsigned back;    /* the stepping side's room */
    unsigned front;   /* the showing side's */
    bool is_asked;    /* atomic */
    wh_news_t *news;  /* atomic: the newest first */
    /* The stepping side's: */
    double axes[WH_AXES]; /* of the last slice: its command may already be the next one's */
    size_t axis_count;
    const wh_state_t *state; /* of the last slice; null: none */
    int64_t shown;           /* the slice that was last handed over */
    uint64_t eventful;       /* the number of slices with events */
    int64_t last;            /* the last slice */
    uint64_t epoch;
};

wh_showing_t *wh_showing_open(const wh_layout_t *layout) {
    wh_showing_t *showing = wh_array_new(1, sizeof *showing);
    showing->layout = layout;
    showing->back = 0;
    showing->between = 1;
    showing->front = 2;
    showing->shown = -1;
    showing->eventful = 1;
    for (size_t i = 0; i < 3; ++i) {
        showing->rooms[i].wafers = wh_array_new(layout->wafer_count, sizeof(wh_wafer_t));
    }
    return showing;
}

void wh_showing_close(wh_showing_t *showing) {
    if (!showing) {
        return;
    }
    wh_news_t *news = wh_showing_take_news(showing);
    while (news) {
        wh_news_t *next = news->next;
        wh_news_free(news);
        news = next;
    }
    for (size_t i = 0; i < 3; ++i) {
        free(showing->rooms[i].wafers);
    }
    free(showing);
}

/* -------------------------------------------------------------------------------------- the stepping side */

/* Wafers move in slices with events, or with their grippers. */
static void copy_wafers(const wh_showing_t *showing, wh_glimpse_t *look, const wh_state_t *state) {
    if (look->wafers_at != showing->eventful) {
        memcpy(look->wafers, state->wafers, state->wafer_count * sizeof *state->wafers);
        look->wafers_at = showing->eventful;
        return;
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const int32_t wafer = state->grippers[g].wafer;
        if (wafer != WH_NONE) {
            look->wafers[wafer] = state->wafers[wafer];
        }
    }
}

static void copy(const wh_showing_t *showing, wh_glimpse_t *look) {
    const wh_state_t *state = showing->state;
    look->axis_count = showing->axis_count;
    memcpy(look->axes, showing->axes, showing->axis_count * sizeof *showing->axes);
    copy_wafers(showing, look, state);
    memcpy(look->grippers, state->grippers, state->gripper_count * sizeof *state->grippers);
    look->physics = *state->physics;
    look->epoch = showing->epoch;
    look->state = *state;
    look->state.wafers = look->wafers;
    look->state.grippers = look->grippers;
    look->state.physics = &look->physics;
    look->state.events = NULL;
    look->state.event_count = 0;
}

static void hand_over(wh_showing_t *showing) {
    copy(showing, &showing->rooms[showing->back]);
    showing->shown = showing->state->seq;
    __atomic_store_n(&showing->is_asked, false, __ATOMIC_RELAXED);
    showing->back =
        __atomic_exchange_n(&showing->between, showing->back | IS_NEW, __ATOMIC_ACQ_REL) & ~IS_NEW;
}

wh_news_t *wh_news_make(wh_news_kind_t kind, int64_t utime, const char *text, const char *more) {
    wh_news_t *news = wh_array_new(1, sizeof *news);
    news->kind = kind;
    news->utime = utime;
    news->text = text ? wh_text_copy(text) : NULL;
    news->more = more ? wh_text_copy(more) : NULL;
    return news;
}

void wh_showing_tell(wh_showing_t *showing, wh_news_t *news) {
    news->next = __atomic_load_n(&showing->news, __ATOMIC_RELAXED);
    while (!__atomic_compare_exchange_n(&showing->news, &news->next, news, true, __ATOMIC_RELEASE,
                                        __ATOMIC_RELAXED)) {
    }
}

static wh_glimpse_t *copy_look(const wh_showing_t *showing) {
    wh_glimpse_t *look = wh_array_new(1, sizeof *look);
    look->wafers = wh_array_new(showing->state->wafer_count, sizeof(wh_wafer_t));
    copy(showing, look);
    return look;
}

static void tell_events(wh_showing_t *showing) {
    const wh_state_t *state = showing->state;
    wh_news_t *news = wh_news_make(WH_NEWS_EVENTS, state->utime, NULL, NULL);
    news->event_count = state->event_count;
    news->events = wh_array_new(state->event_count, sizeof *news->events);
    memcpy(news->events, state->events, state->event_count * sizeof *news->events);
    news->seats = wh_array_new(state->event_count, sizeof *news->seats);
    for (size_t i = 0; i < state->event_count; ++i) {
        news->seats[i] = wh_seat_of(showing->layout, state, &state->events[i]);
    }
    news->look = copy_look(showing);
    news->look->state.events = news->events;
    news->look->state.event_count = news->event_count;
    wh_showing_tell(showing, news);
}

static void take_slice(wh_showing_t *showing, const wh_command_t *command, const wh_state_t *state) {
    showing->last = state->seq;
    showing->axis_count = command->axis_count < WH_AXES ? command->axis_count : WH_AXES;
    memcpy(showing->axes, command->axes, showing->axis_count * sizeof *showing->axes);
    showing->state = state;
}

void wh_showing_slice(wh_showing_t *showing, const wh_command_t *command, const wh_state_t *state) {
    if (state->status != WH_OK || !state->physics) {
        return;
    }
    if (state->seq <= showing->last) {
        ++showing->epoch;
        ++showing->eventful; /* any wafer may be elsewhere */
    }
    take_slice(showing, command, state);
    if (state->event_count > 0) {
        ++showing->eventful;
        tell_events(showing);
    }
    if (__atomic_load_n(&showing->is_asked, __ATOMIC_RELAXED)) {
        hand_over(showing);
    }
}

void wh_showing_set_back(wh_showing_t *showing, const wh_command_t *command, const wh_state_t *state) {
    if (!state->physics) {
        return;
    }
    ++showing->epoch;
    ++showing->eventful;
    take_slice(showing, command, state);
    wh_news_t *news = wh_news_make(WH_NEWS_SET_BACK, state->utime, NULL, NULL);
    news->look = copy_look(showing);
    wh_showing_tell(showing, news);
    hand_over(showing);
}

void wh_showing_rest(wh_showing_t *showing) {
    if (showing->state && showing->state->seq != showing->shown) {
        hand_over(showing);
    }
}

void wh_showing_forget(wh_showing_t *showing) {
    showing->state = NULL;
}

/* --------------------------------------------------------------------------------------- the showing side */

void wh_showing_ask(wh_showing_t *showing) {
    __atomic_store_n(&showing->is_asked, true, __ATOMIC_RELAXED);
}

const wh_glimpse_t *wh_showing_take(wh_showing_t *showing) {
    if ((__atomic_load_n(&showing->between, __ATOMIC_RELAXED) & IS_NEW) == 0) {
        return NULL;
    }
    showing->front = __atomic_exchange_n(&showing->between, showing->front, __ATOMIC_ACQ_REL) & ~IS_NEW;
    return &showing->rooms[showing->front];
}

wh_news_t *wh_showing_take_news(wh_showing_t *showing) {
    wh_news_t *newest = __atomic_exchange_n(&showing->news, NULL, __ATOMIC_ACQUIRE);
    wh_news_t *oldest = NULL;
    while (newest) {
        wh_news_t *next = newest->next;
        newest->next = oldest;
        oldest = newest;
        newest = next;
    }
    return oldest;
}

void wh_news_free(wh_news_t *news) {
    if (news->look) {
        free(news->look->wafers);
        free(news->look);
    }
    free(news->events);
    free(news->seats);
    free(news->text);
    free(news->more);
    free(news);
}
