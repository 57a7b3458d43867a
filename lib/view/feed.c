#include "feed.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* A text that several readers may be reading. */
struct wh_feed_message {
    char *text;
    size_t size;
    uint64_t number;
    size_t *users; /* of the text: the feed, and readers */
    bool is_frame;
};

static wh_feed_message_t *at(const wh_feed_t *feed, size_t i) {
    const size_t place = feed->first + i;
    return &feed->messages[place < feed->capacity ? place : place - feed->capacity];
}

static void let_go(wh_feed_message_t *message) {
    if (message->users && --*message->users == 0) {
        free(message->text);
        free(message->users);
    }
    *message = (wh_feed_message_t){0};
}

static void drop_first(wh_feed_t *feed) {
    wh_feed_message_t *first = at(feed, 0);
    feed->bytes -= first->size;
    let_go(first);
    feed->first = feed->first + 1 < feed->capacity ? feed->first + 1 : 0;
    --feed->count;
}

/* A ring is unrolled when it grows. */
static void make_room(wh_feed_t *feed) {
    if (feed->count < feed->capacity) {
        return;
    }
    const size_t capacity = feed->capacity > 0 ? 2 * feed->capacity : 64;
    wh_feed_message_t *messages = wh_array_new(capacity, sizeof *messages);
    for (size_t i = 0; i < feed->count; ++i) {
        messages[i] = *at(feed, i);
    }
    free(feed->messages);
    feed->messages = messages;
    feed->first = 0;
    feed->capacity = capacity;
}

static wh_feed_message_t make(uint64_t number, const char *kind, const char *text) {
    wh_feed_message_t message = {.number = number, .is_frame = strcmp(kind, "frame") == 0};
    const size_t room = strlen(kind) + strlen(text) + 64;
    message.text = wh_array_new(room, 1);
    message.size =
        (size_t)snprintf(message.text, room, "id: %" PRIu64 "\nevent: %s\ndata: %s\n\n", number, kind, text);
    message.users = wh_array_new(1, sizeof *message.users);
    *message.users = 1;
    return message;
}

void wh_feed_add(wh_feed_t *feed, const char *kind, const char *text) {
    const wh_feed_message_t message = make(++feed->last, kind, text);
    make_room(feed);
    feed->frame = message.is_frame ? message.number : feed->frame;
    *at(feed, feed->count++) = message;
    feed->bytes += message.size;
    while (feed->bytes > WH_FEED_BYTES && feed->count > 1) {
        drop_first(feed);
    }
}

static uint64_t oldest(const wh_feed_t *feed) {
    return feed->last + 1 - feed->count;
}

/* Passes over frames that are not the newest one. */
static void pass_frames(const wh_feed_t *feed, wh_feed_reader_t *reader) {
    while (reader->next >= oldest(feed) && reader->next <= feed->last) {
        const wh_feed_message_t *message = at(feed, (size_t)(reader->next - oldest(feed)));
        if (!message->is_frame || message->number == feed->frame) {
            return;
        }
        ++reader->missed;
        ++reader->next;
    }
}

static void take_up(wh_feed_reader_t *reader, const wh_feed_message_t *message) {
    reader->message = wh_array_new(1, sizeof *reader->message);
    *reader->message = *message;
    reader->offset = 0;
    ++*message->users;
}

/* The reader is asked to fetch all of it: from there on the feed goes on for it. */
static void tell_anew(wh_feed_t *feed, wh_feed_reader_t *reader) {
    wh_feed_message_t message = make(feed->last, "anew", "{}");
    *message.users = 0;
    take_up(reader, &message);
    reader->next = feed->last + 1;
}

bool wh_feed_has_news(const wh_feed_t *feed, const wh_feed_reader_t *reader) {
    return reader->message || reader->next <= feed->last;
}

/* False if there is nothing to read. */
static bool begin_message(wh_feed_t *feed, wh_feed_reader_t *reader) {
    if (reader->next > feed->last + 1 || reader->next < oldest(feed)) {
        tell_anew(feed, reader);
        return true;
    }
    pass_frames(feed, reader);
    if (reader->next > feed->last) {
        return false;
    }
    take_up(reader, at(feed, (size_t)(reader->next - oldest(feed))));
    ++reader->next;
    return true;
}

size_t wh_feed_read(wh_feed_t *feed, wh_feed_reader_t *reader, char *to, size_t size) {
    if (!reader->message && !begin_message(feed, reader)) {
        return 0;
    }
    const wh_feed_message_t *message = reader->message;
    const size_t left = message->size - reader->offset;
    const size_t taken = left < size ? left : size;
    memcpy(to, message->text + reader->offset, taken);
    reader->offset += taken;
    if (reader->offset == message->size) {
        wh_feed_leave(reader);
    }
    return taken;
}

void wh_feed_leave(wh_feed_reader_t *reader) {
    if (reader->message) {
        let_go(reader->message);
        free(reader->message);
        reader->message = NULL;
    }
}

void wh_feed_close(wh_feed_t *feed) {
    while (feed->count > 0) {
        drop_first(feed);
    }
    free(feed->messages);
    *feed = (wh_feed_t){0};
}
