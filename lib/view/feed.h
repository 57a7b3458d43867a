/* The messages of a live page, in order, for readers of different speed: server-sent events.
 *
 * Each message is kept for all readers together, up to WH_FEED_BYTES; so memory is bounded, and a reader
 * never holds up another. There are two kinds. `frame` is the present place of everything: a reader that is
 * behind gets the newest one alone. Any other message counts: if a reader is so far behind that one of them
 * is gone, it gets `anew` in its place, and fetches the document, which holds all of it.
 *
 * One thread. It ends the program if out of memory.
 */
#ifndef WH_VIEW_FEED_H
#define WH_VIEW_FEED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most bytes that are kept, unless a single message is larger. */
#define WH_FEED_BYTES ((size_t)4 << 20)

typedef struct wh_feed_message wh_feed_message_t;

/* Zero it to begin with. Read only `last`. */
typedef struct {
    wh_feed_message_t *messages; /* a ring */
    size_t first, count, capacity, bytes;
    uint64_t last;  /* the number of the newest message; 0: there was none */
    uint64_t frame; /* of the newest frame */
} wh_feed_t;

/* A reader's place. Zero it, and set `next`; wh_feed_leave ends it. */
typedef struct {
    uint64_t next;              /* the number of the message that comes next */
    wh_feed_message_t *message; /* that is being read; its text is kept for that long */
    size_t offset;              /* of its bytes read so far */
    uint64_t missed;            /* frames passed over */
} wh_feed_reader_t;

/* Adds a message of this kind; `text` is one line of JSON. */
void wh_feed_add(wh_feed_t *feed, const char *kind, const char *text);

/* Copies what comes next for a reader, at most `size` bytes; 0: there is nothing yet. */
size_t wh_feed_read(wh_feed_t *feed, wh_feed_reader_t *reader, char *to, size_t size);

/* True if wh_feed_read would return something. */
bool wh_feed_has_news(const wh_feed_t *feed, const wh_feed_reader_t *reader);

/* Lets go of the message that is being read. */
void wh_feed_leave(wh_feed_reader_t *reader);

/* Frees all messages; readers keep what they are reading. */
void wh_feed_close(wh_feed_t *feed);

#endif
