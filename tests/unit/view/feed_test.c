/* Messages for readers of different speed: each gets all that counts, in order, or is told to begin anew. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/feed.h"

/* Reads all that is there, `size` bytes at a time. */
static char *read_all(wh_feed_t *feed, wh_feed_reader_t *reader, size_t size) {
    char *text = calloc(1, 1);
    size_t length = 0;
    char piece[64];
    for (size_t got = wh_feed_read(feed, reader, piece, size); got > 0;
         got = wh_feed_read(feed, reader, piece, size)) {
        text = realloc(text, length + got + 1);
        memcpy(text + length, piece, got);
        length += got;
        text[length] = '\0';
    }
    return text;
}

/* Reads all that is there, and keeps nothing. */
static void pass_over(wh_feed_t *feed, wh_feed_reader_t *reader) {
    char piece[4096];
    while (wh_feed_read(feed, reader, piece, sizeof piece) > 0) {
    }
}

static void assert_reads(wh_feed_t *feed, wh_feed_reader_t *reader, size_t size, const char *expected) {
    char *text = read_all(feed, reader, size);
    assert_string_equal(text, expected);
    assert_false(wh_feed_has_news(feed, reader));
    free(text);
}

static void pieces_of_any_size_are_the_same_text(void **state) {
    (void)state;
    for (size_t size = 1; size <= 64; ++size) {
        wh_feed_t feed = {0};
        wh_feed_reader_t reader = {.next = 1};
        assert_reads(&feed, &reader, size, "");
        wh_feed_add(&feed, "growth", "{\"a\":1}");
        wh_feed_add(&feed, "growth", "{}");
        assert_reads(&feed, &reader, size,
                     "id: 1\nevent: growth\ndata: {\"a\":1}\n\nid: 2\nevent: growth\ndata: {}\n\n");
        assert_reads(&feed, &reader, size, "");
        wh_feed_close(&feed);
    }
}

static void only_the_newest_frame_is_read(void **state) {
    (void)state;
    wh_feed_t feed = {0};
    wh_feed_reader_t reader = {.next = 1};
    wh_feed_add(&feed, "frame", "1");
    wh_feed_add(&feed, "frame", "2");
    wh_feed_add(&feed, "growth", "3");
    wh_feed_add(&feed, "frame", "4");
    wh_feed_add(&feed, "frame", "5");
    assert_reads(&feed, &reader, 64, "id: 3\nevent: growth\ndata: 3\n\nid: 5\nevent: frame\ndata: 5\n\n");
    assert_int_equal(reader.missed, 3);
    wh_feed_close(&feed);
}

/* A reader that is far behind, one with numbers of another program, and one that is here. */
static void who_has_missed_what_counts_begins_anew(void **state) {
    (void)state;
    wh_feed_t feed = {0};
    char *large = malloc(WH_FEED_BYTES / 8);
    memset(large, 'x', WH_FEED_BYTES / 8 - 1);
    large[WH_FEED_BYTES / 8 - 1] = '\0';
    wh_feed_reader_t slow = {.next = 1};
    wh_feed_reader_t quick = {.next = 1};
    wh_feed_reader_t stranger = {.next = 1000};
    for (int i = 0; i < 100; ++i) {
        wh_feed_add(&feed, "growth", large);
        pass_over(&feed, &quick);
        assert_true(feed.bytes <= WH_FEED_BYTES);
    }
    assert_reads(&feed, &slow, 7, "id: 100\nevent: anew\ndata: {}\n\n");
    assert_reads(&feed, &stranger, 64, "id: 100\nevent: anew\ndata: {}\n\n");
    assert_reads(&feed, &quick, 64, "");
    wh_feed_add(&feed, "growth", "{}");
    assert_reads(&feed, &slow, 64, "id: 101\nevent: growth\ndata: {}\n\n");
    assert_reads(&feed, &stranger, 64, "id: 101\nevent: growth\ndata: {}\n\n");
    free(large);
    wh_feed_close(&feed);
}

/* The message that is being read is whole, whatever the feed has dropped since. */
static void a_message_is_read_to_its_end(void **state) {
    (void)state;
    wh_feed_t feed = {0};
    wh_feed_reader_t reader = {.next = 1};
    wh_feed_reader_t leaver = {.next = 1};
    char begin[6] = "";
    wh_feed_add(&feed, "growth", "{\"first\":true}");
    assert_int_equal(wh_feed_read(&feed, &reader, begin, 5), 5);
    assert_int_equal(wh_feed_read(&feed, &leaver, begin, 5), 5);
    assert_string_equal(begin, "id: 1");
    wh_feed_close(&feed);
    char rest[64] = "";
    assert_int_equal(wh_feed_read(&feed, &reader, rest, 63), 37);
    assert_string_equal(rest, "\nevent: growth\ndata: {\"first\":true}\n\n");
    wh_feed_leave(&reader);
    wh_feed_leave(&leaver);
    wh_feed_leave(&leaver);
}

/* Random readers against a plain list: what a reader gets is in order, has no gap but for frames, and ends
 * with the newest. */
static void random_readers(void **state) {
    (void)state;
    unsigned random = 1;
    wh_feed_t feed = {0};
    enum { READERS = 8 };
    wh_feed_reader_t readers[READERS] = {{0}};
    uint64_t last[READERS] = {0}; /* growths seen */
    uint64_t growths = 0;
    char piece[64];
    for (size_t r = 0; r < READERS; ++r) {
        readers[r].next = 1;
    }
    for (int step = 0; step < 20000; ++step) {
        char text[32];
        random = random * 1103515245U + 12345U;
        const bool is_frame = (random >> 16) % 3 != 0;
        growths += is_frame ? 0 : 1;
        (void)snprintf(text, sizeof text, "%llu", (unsigned long long)growths);
        wh_feed_add(&feed, is_frame ? "frame" : "growth", text);
        const size_t r = (random >> 20) % READERS;
        char *got = read_all(&feed, &readers[r], 1 + (random >> 10) % 63);
        for (char *at = strstr(got, "event: growth\ndata: "); at;
             at = strstr(at + 1, "event: growth\ndata: ")) {
            assert_int_equal(strtoull(at + 20, NULL, 10), ++last[r]);
        }
        assert_int_equal(last[r], growths);
        free(got);
    }
    assert_int_equal(wh_feed_read(&feed, &readers[0], piece, 0), 0);
    for (size_t r = 0; r < READERS; ++r) {
        wh_feed_leave(&readers[r]);
    }
    wh_feed_close(&feed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_of_any_size_are_the_same_text),
        cmocka_unit_test(only_the_newest_frame_is_read),
        cmocka_unit_test(who_has_missed_what_counts_begins_anew),
        cmocka_unit_test(a_message_is_read_to_its_end),
        cmocka_unit_test(random_readers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
