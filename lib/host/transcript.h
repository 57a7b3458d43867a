/* A transcript: what was said on the ports of a run, one line a frame, each with its slice.
 *
 * A text file that a person reads and writes:
 *
 *     waferhand transcript 1
 *     layout "transfer.lua"
 *     port "robot prompt"
 *
 *     0 0.000000 + robot
 *     12 0.012000 > robot "GET LP1 1\r\n"
 *     1640 1.640000 < robot "ok\r\n"
 *     1650 1.650000 - robot
 *
 * The first line is that. Heads follow, each a word and a text in quotes: what the run was. Then entries:
 * slice, time in seconds with six decimals, kind, port and, of frames, bytes in quotes. Of bytes, blank to
 * tilde stand for themselves but for \\ and \", and there are \r, \n, \t and \xHH for any byte. Slices and
 * times never go back, but where an entry = says so. Blank lines do not count, and lines whose first byte is
 * # do not either.
 *
 * JSON lines say the same for programs, an object a line, and are read as well:
 *
 *     {"transcript":1}
 *     {"head":"layout","text":"transfer.lua"}
 *     {"slice":12,"time":0.012000,"kind":"said","port":"robot","bytes":"GET LP1 1\r\n"}
 *
 * The kinds are said, timed_out, heard, came, went, clock, stopped, halted, ended and elapsed. Texts have for
 * each byte the character of its number (as in ISO 8859-1). */
#ifndef WH_HOST_TRANSCRIPT_H
#define WH_HOST_TRANSCRIPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The longest file that is read; the longest name of a port, the most bytes of a frame. */
#define WH_TRANSCRIPT_FILE 268435456
#define WH_TRANSCRIPT_NAME 63
#define WH_TRANSCRIPT_BYTES 8192
/* Room for a message. */
#define WH_TRANSCRIPT_MESSAGE 1024

/* What an entry tells; its sign in the file. */
typedef enum {
    WH_TRANSCRIPT_SAID = '>', /* a frame from the host to the controller, as it came, good or bad; of one that
                                 is too long, what came up to the byte that was too many */
    WH_TRANSCRIPT_TIMED_OUT = '~', /* a frame that ended because nothing came for too long */
    WH_TRANSCRIPT_HEARD = '<',   /* a frame from the controller to the host, when it was made: what is late on
                                      the line is so after that */
    WH_TRANSCRIPT_CAME = '+',    /* a client came */
    WH_TRANSCRIPT_WENT = '-',    /* it went */
    WH_TRANSCRIPT_CLOCK = '=',   /* this port's command has set the clock back to this slice */
    WH_TRANSCRIPT_STOPPED = '!', /* the operator has ended all, while this port's command ran or none */
    WH_TRANSCRIPT_HALTED = '*',  /* a STOP that came over no port has ended what ran and what waited */
    WH_TRANSCRIPT_ENDED = '.',   /* this port's command has ended, and the host was told nothing then */
    WH_TRANSCRIPT_ELAPSED = '?'  /* this port has waited too long for an acknowledgement, or for its turn */
} wh_transcript_kind_t;

/* An entry. Pointers are the caller's, or the transcript's that it was read from. */
typedef struct {
    int64_t slice;   /* from 0 */
    int64_t time_us; /* of the run, from 0 */
    wh_transcript_kind_t kind;
    const char *port; /* letters, digits and _ - . */
    const uint8_t *bytes;
    size_t size; /* 0 to WH_TRANSCRIPT_BYTES; 0 if it is no frame */
    size_t line; /* in the file that it was read from, from 1 */
} wh_transcript_entry_t;

/* A head: a word of small letters and _, and a text without control characters. */
typedef struct {
    const char *name, *text;
    size_t line;
} wh_transcript_head_t;

/* ----------------------------------------------------------------------------------------------- writing */

/* Write the first line and heads; an entry. False if `out` does not take it, or the entry is none that could
 * be read. */
bool wh_transcript_write_heads(FILE *out, const wh_transcript_head_t *heads, size_t count);
bool wh_transcript_write(FILE *out, const wh_transcript_entry_t *entry);

/* Likewise as lines of JSON. */
bool wh_transcript_write_json_heads(FILE *out, const wh_transcript_head_t *heads, size_t count);
bool wh_transcript_write_json(FILE *out, const wh_transcript_entry_t *entry);

/* Writes bytes as in the file, without the quotes, into `size` bytes, as far as they go with an end: an
 * escape is never cut. Returns how many of them were written. */
size_t wh_transcript_escape(char *to, size_t size, const uint8_t *bytes, size_t count);

/* ----------------------------------------------------------------------------------------------- reading */

/* A transcript that was read. The first group is to be read, the rest is its own. */
typedef struct {
    wh_transcript_head_t *heads;
    size_t head_count;
    wh_transcript_entry_t *entries;
    size_t count;
    char message
        [WH_TRANSCRIPT_MESSAGE]; /* what is wrong: "a.txt:3: time: 1,5 (expected ...)"; empty: nothing */

    const char *path;
    bool is_json;
    size_t head_capacity, capacity;
    size_t said, heard; /* the entries that come next of the host's side, and of what it hears */
    char *text;
} wh_transcript_t;

/* Reads a regular file. False if it is refused: `message` says why. To be closed either way. `path` must
 * outlive it. Ends the program if out of memory. Cost: linear in the file. */
bool wh_transcript_open(wh_transcript_t *transcript, const char *path);

/* Likewise bytes that are there already, with a name for messages. */
bool wh_transcript_parse(wh_transcript_t *transcript, const char *name, const void *bytes, size_t size);

void wh_transcript_close(wh_transcript_t *transcript);

/* --------------------------------------------------------------------------------- the host's side again */

/* The next entry of the host's side, or of the operator's (said, timed out, came, went, stopped, halted,
 * elapsed), if its slice is not after `slice`; else null. Each is given once. Slices count anew behind an
 * entry =: nothing behind it is to be asked for before that was compared. */
const wh_transcript_entry_t *wh_transcript_next(wh_transcript_t *transcript, int64_t slice);

/* The slice of the entry that comes next so; INT64_MAX: none is left. */
int64_t wh_transcript_due(const wh_transcript_t *transcript);

/* Holds what the host hears now, a clock that was set back, or an end that nobody was told, against the next
 * such entry. False at the first difference, in slice, time, kind, port or bytes: `message` tells both and
 * the line. Entries of other kinds are not compared. */
bool wh_transcript_compare(wh_transcript_t *transcript, const wh_transcript_entry_t *entry);

/* At the end of a run: false, with the same message, if something was to be heard that was not. */
bool wh_transcript_compare_end(wh_transcript_t *transcript);

/* The last slice that the transcript tells of; 0 if it is empty. */
int64_t wh_transcript_last(const wh_transcript_t *transcript);

#endif
