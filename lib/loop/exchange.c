#include "exchange.h"

#include <string.h>

static wh_exchange_slot_t *slot_of(wh_exchange_t *exchange, uint32_t slice) {
    return &exchange->slots[slice % WH_EXCHANGE_SLICES];
}

/* Makes the entry of a slice that has none yet. */
static wh_exchange_slot_t *open_slot(wh_exchange_t *exchange, uint32_t slice) {
    wh_exchange_slot_t *slot = slot_of(exchange, slice);
    if (slot->slice != slice) {
        slot->slice = slice;
        slot->state = WH_EXCHANGE_AWAITED;
        slot->sent_us = 0;
    }
    return slot;
}

void wh_exchange_init(wh_exchange_t *exchange, size_t axes, uint32_t lag) {
    memset(exchange, 0, sizeof *exchange);
    exchange->axes = axes;
    exchange->lag = lag;
    exchange->next = 1;
}

/* ------------------------------------------------------------------------------------------------ hearing */

/* A frame that overtook another one has a smaller count and a smaller number; a board that was reset has a
 * smaller count and goes on. The first frame of all may be of a board that has answered other runs. */
static void count_sent(wh_exchange_t *exchange, uint32_t sent, uint32_t number) {
    const bool is_older = exchange->is_heard && number < exchange->last_number;
    if (is_older && sent < exchange->last_sent) {
        exchange->counters.lost_answers -= exchange->counters.lost_answers > 0 ? 1 : 0;
        return;
    }
    if (exchange->is_heard && sent <= exchange->last_sent && number > exchange->last_number) {
        ++exchange->counters.resets;
        exchange->is_reset = true;
        exchange->last_sent = 0;
    }
    if (exchange->is_heard && sent > exchange->last_sent + 1) {
        exchange->counters.lost_answers += sent - exchange->last_sent - 1;
    }
    exchange->is_heard = true;
    exchange->last_sent = sent;
    exchange->last_number = number;
}

static wh_exchange_news_t hear_hello(wh_exchange_t *exchange) {
    if (exchange->is_heard) {
        ++exchange->counters.resets;
        exchange->is_reset = true;
        exchange->is_heard = false;
        exchange->last_sent = 0;
    }
    return WH_EXCHANGE_HELLO;
}

static void fill_slot(wh_exchange_t *exchange, uint32_t slice, const uint8_t frame[]) {
    wh_exchange_slot_t *slot = open_slot(exchange, slice);
    slot->state = WH_EXCHANGE_THERE;
    slot->valves = (uint32_t)wh_board_get(frame + 12, 4);
    for (size_t axis = 0; axis < exchange->axes; ++axis) {
        const uint64_t bits = wh_board_get(frame + WH_BOARD_HEAD + 8 * axis, 8);
        memcpy(&slot->axes[axis], &bits, sizeof bits);
    }
}

static void time_answer(wh_exchange_t *exchange, uint32_t number, int64_t now_us) {
    const wh_exchange_slot_t *sent = slot_of(exchange, number);
    wh_exchange_counters_t *counters = &exchange->counters;
    if (sent->slice == number && sent->sent_us > 0) {
        const int64_t took_us = now_us - sent->sent_us;
        ++counters->answers;
        counters->sum_us += took_us;
        counters->slowest_us = took_us > counters->slowest_us ? took_us : counters->slowest_us;
    }
}

/* The answer to state `number`. */
static wh_exchange_news_t hear_answer(wh_exchange_t *exchange, uint32_t number, const uint8_t frame[],
                                      int64_t now_us) {
    const uint32_t slice = number + exchange->lag;
    if (slice < exchange->next) {
        wh_exchange_slot_t *slot = slot_of(exchange, slice);
        const bool is_again = slot->slice == slice && slot->state != WH_EXCHANGE_HELD;
        if (slot->slice == slice) {
            slot->state = WH_EXCHANGE_USED;
        }
        return is_again ? WH_EXCHANGE_DOUBLED : WH_EXCHANGE_LATE;
    }
    if (open_slot(exchange, slice)->state == WH_EXCHANGE_THERE) {
        return WH_EXCHANGE_DOUBLED;
    }
    time_answer(exchange, number, now_us);
    for (uint32_t other = number == 0 ? exchange->next : slice; other <= slice; ++other) {
        fill_slot(exchange, other, frame);
    }
    return WH_EXCHANGE_TAKEN;
}

wh_exchange_news_t wh_exchange_hear(wh_exchange_t *exchange, const uint8_t frame[], int64_t now_us) {
    const uint32_t number = (uint32_t)wh_board_get(frame + 4, 4);
    wh_exchange_news_t news;
    if (frame[3] != exchange->axes) {
        news = WH_EXCHANGE_OTHER_AXES;
    } else if (number == WH_BOARD_HELLO) {
        news = hear_hello(exchange);
    } else if (number >= exchange->next) {
        news = WH_EXCHANGE_UNKNOWN;
    } else {
        count_sent(exchange, (uint32_t)wh_board_get(frame + 8, 4), number);
        news = hear_answer(exchange, number, frame, now_us);
    }
    ++exchange->counters.frames[news];
    return news;
}

/* ------------------------------------------------------------------------------------------------- slices */

void wh_exchange_note_sent(wh_exchange_t *exchange, int64_t now_us) {
    wh_exchange_slot_t *slot = open_slot(exchange, exchange->next - 1);
    slot->sent_us = slot->sent_us > 0 ? slot->sent_us : now_us;
}

bool wh_exchange_is_ready(const wh_exchange_t *exchange) {
    const wh_exchange_slot_t *slot = &exchange->slots[exchange->next % WH_EXCHANGE_SLICES];
    return slot->slice == exchange->next && slot->state == WH_EXCHANGE_THERE;
}

const wh_exchange_slot_t *wh_exchange_take(wh_exchange_t *exchange) {
    const bool is_ready = wh_exchange_is_ready(exchange);
    wh_exchange_slot_t *slot = open_slot(exchange, exchange->next);
    slot->state = is_ready ? WH_EXCHANGE_USED : WH_EXCHANGE_HELD;
    exchange->counters.held += is_ready ? 0 : 1;
    ++exchange->next;
    return is_ready ? slot : NULL;
}

uint64_t wh_exchange_lost(const wh_exchange_t *exchange) {
    const uint64_t late = exchange->counters.frames[WH_EXCHANGE_LATE];
    return exchange->counters.held > late ? exchange->counters.held - late : 0;
}

void wh_exchange_write(const wh_exchange_t *exchange, const wh_board_state_t *state, uint8_t frame[]) {
    wh_board_open(frame, WH_BOARD_KIND_STATE, (uint8_t)exchange->axes, state->number);
    wh_board_put(frame + 8, 4, state->sensors);
    wh_board_put(frame + 12, 2, state->status);
    wh_board_put(frame + 14, 2, state->held);
    wh_board_put(frame + 16, 8, state->hash);
    wh_board_seal(frame, WH_BOARD_STATE_BYTES);
}
