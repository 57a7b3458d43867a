/* A transcript: the frames on the ports of a run, one line a frame, each with its slice.
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
 * The first line is always this one. Heads follow, each a word and a text in quotes: they describe the run.
 * Then come entries: slice, time in seconds with six decimals, kind, port and, for frames, bytes in quotes.
 * Bytes from blank to tilde stand for themselves, except \\ and \"; \r, \n and \t are written so, and \xHH is
 * any byte. Slices and times never go back, except where an entry = says so. Blank lines do not count, and
 * lines whose first byte is # do not either.
 *
 * JSON lines hold the transcript for programs, an object a line, and are read as well:
 *
 *     {"transcript":1}
 *     {"head":"layout","text":"transfer.lua"}
 *     {"slice":12,"time":0.012000,"kind":"said","port":"robot","bytes":"GET LP1 1\r\n"}
 *
 * The kinds are said, timed_out, heard, came, went, clock, stopped, halted, ended and elapsed. A text has,
 * for each byte, the character with its number (as in ISO 8859-1). */
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

/* The kind of an entry; its sign in the file. */
typedef enum {
    WH_TRANSCRIPT_SAID = '>', /* a frame from the host to the controller, as it came, good or bad; if it is
                               * too long, its bytes up to the one that was too many */
    WH_TRANSCRIPT_TIMED_OUT = '~', /* a frame that ended because nothing came for too long */
    WH_TRANSCRIPT_HEARD = '<',     /* a frame from the controller to the host, when it was made: delays on the
                                  * line come after that */
    WH_TRANSCRIPT_CAME = '+',      /* a client came */
    WH_TRANSCRIPT_WENT = '-',      /* it went */
    WH_TRANSCRIPT_CLOCK = '=',     /* this port's command has set the clock back to this slice */
    WH_TRANSCRIPT_STOPPED = '!',   /* the operator has ended the run, while this port's command ran, or no
                                    * command */
    WH_TRANSCRIPT_HALTED = '*',    /* a STOP that came from no port has ended the running and waiting
                                    * commands */
    WH_TRANSCRIPT_ENDED = '.',     /* this port's command has ended, and the host was told nothing then */
    WH_TRANSCRIPT_ELAPSED = '?'    /* this port has waited too long for an acknowledgement, or for its turn */
} wh_transcript_kind_t;

/* An entry. Pointers belong to the caller, or to the transcript that it was read from. */
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

/* Write the first line and heads; write an entry. False if `out` does not take it, or if the entry could not
 * be read back. */
bool wh_transcript_write_heads(FILE *out, const wh_transcript_head_t *heads, size_t count);
bool wh_transcript_write(FILE *out, const wh_transcript_entry_t *entry);

/* Likewise as lines of JSON. */
bool wh_transcript_write_json_heads(FILE *out, const wh_transcript_head_t *heads, size_t count);
bool wh_transcript_write_json(FILE *out, const wh_transcript_entry_t *entry);

/* Writes bytes as in the file, without the quotes, into `size` bytes, as far as they go with an end: an
 * escape is never cut. Returns how many of them were written. */
size_t wh_transcript_escape(char *to, size_t size, const uint8_t *bytes, size_t count);

/* ----------------------------------------------------------------------------------------------- reading */

/* A transcript that was read. Read only the first group; the rest is private. */
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
    bool is_different;  /* a comparison has failed */
    size_t said, heard; /* the next entries of the host's side, and of the frames that it hears */
    char *text;
} wh_transcript_t;

/* Reads a regular file. False if it is refused: `message` says why. To be closed either way. `path` must
 * outlive it. Ends the program if out of memory. Cost: linear in the file. */
bool wh_transcript_open(wh_transcript_t *transcript, const char *path);

/* Likewise reads bytes from memory, with a name for messages. */
bool wh_transcript_parse(wh_transcript_t *transcript, const char *name, const void *bytes, size_t size);

void wh_transcript_close(wh_transcript_t *transcript);

/* --------------------------------------------------------------------------------- the host's side again */

/* The next entry of the host's side, or of the operator's (said, timed out, came, went, stopped, halted,
 * elapsed), if its slice is not after `slice`; else null. Each is given once. Slices count anew behind an
 * entry =: ask for nothing behind it before it was compared. */
const wh_transcript_entry_t *wh_transcript_next(wh_transcript_t *transcript, int64_t slice);

/* Likewise, if that entry is this port's, all answers before it have been compared, and none was
 * different. */
const wh_transcript_entry_t *wh_transcript_next_at(wh_transcript_t *transcript, int64_t slice,
                                                   const char *port);

/* The slice of the next entry of this kind; INT64_MAX: none is left. */
int64_t wh_transcript_due(const wh_transcript_t *transcript);

/* Compares a frame that the host hears now, a clock that was set back, or an end that nobody was told, with
 * the next such entry. False at the first difference, in slice, time, kind, port or bytes: `message` tells
 * both and the line. Entries of other kinds are not compared. */
bool wh_transcript_compare(wh_transcript_t *transcript, const wh_transcript_entry_t *entry);

/* Call it at the end of a run. False, with such a message, if an expected entry was not heard. */
bool wh_transcript_compare_end(wh_transcript_t *transcript);

/* True at the end of a run, at `slice`, that was the transcript's: all was handed out, and all that was
 * expected was heard. Else `message` tells what is missing. */
bool wh_transcript_is_over(wh_transcript_t *transcript, int64_t slice);

/* The last slice that the transcript tells of; 0 if it is empty. */
int64_t wh_transcript_last(const wh_transcript_t *transcript);

#endif
