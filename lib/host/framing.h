/* From the bytes of a line to frames, and from a frame's body to bytes.
 *
 * A frame is, in this order: a start (or none), a body, a separator and two hex digits of a check sum (or
 * neither), an end. With starts, bytes before a start are garbage. A start within a frame means that the
 * frame before it lost its end, so a body holds no start. Each bad frame is handed on as such, so the reader
 * knows which mistake it was. The checks are in this order: length, end, check sum.
 *
 * The sum may stand behind the end instead: what comes there is no mark.
 *
 * A frame may tell its length behind the start: then its body holds any bytes, and no mark is looked for in
 * it. Behind a length that cannot be, bytes are passed over up to a start or a pause.
 *
 * The result of a framer depends on the bytes and their times alone, never on how they were cut into pieces.
 * Nothing is allocated. Not for two threads at once. */
#ifndef WH_HOST_FRAMING_H
#define WH_HOST_FRAMING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The longest frame that can be asked for, with start, sum and end, and the shortest such; the most starts,
 * and ends; the longest mark. */
#define WH_FRAMING_LINE 4096
#define WH_FRAMING_LEAST 32
#define WH_FRAMING_MARKS 4
#define WH_FRAMING_MARK 8
#define WH_FRAMING_LENGTH 4 /* the most bytes of a length */

/* The longest time between two bytes of a frame that can be asked for: an hour. */
#define WH_FRAMING_TIMEOUT_US 3600000000

/* Room for what is wrong with a description. */
#define WH_FRAMING_PROBLEM_BYTES 200

/* Bytes that begin or end a frame. Size 0: none. */
typedef struct {
    uint8_t bytes[WH_FRAMING_MARK];
    size_t size;
} wh_framing_mark_t;

/* The check sum of the bytes that count, as two hex digits, or four of a CRC. Its names in a dialect: none,
 * add, xor (a longitudinal redundancy check), complement (the other one of that name), crc16.
 */
typedef enum {
    WH_SUM_NONE,
    WH_SUM_ADD,        /* the bytes added up, modulo 256 */
    WH_SUM_XOR,        /* the bytes, exclusive or */
    WH_SUM_COMPLEMENT, /* the difference to the next multiple of 256 */
    WH_SUM_CRC16       /* x^16 + x^15 + x^2 + 1, bits from the lowest on, begun with FFFF */
} wh_sum_kind_t;

/* A length counts the body; all behind it, but for the end; or the whole frame, with the length. */
typedef enum { WH_LENGTH_BODY, WH_LENGTH_REST, WH_LENGTH_FRAME } wh_length_counts_t;

/* The length of a frame, behind its start. */
typedef struct {
    size_t size;   /* its own bytes, 1 to 4; 0: there is none */
    unsigned base; /* 10 or 16: digits; 256: bytes, the highest first, or the lowest if `low_first` */
    bool low_first;
    wh_length_counts_t counts;
} wh_framing_length_t;

/* How one direction of a line is framed. The body counts into the sum; the fields below say what else does.
 * Digits are written in capitals and read in either case. */
typedef struct {
    wh_framing_mark_t starts[WH_FRAMING_MARKS]; /* any of them begins a frame; no two begin alike */
    size_t start_count;                         /* 0: a frame begins where the one before it ended */
    wh_framing_mark_t ends[WH_FRAMING_MARKS];   /* any of them ends a frame, the first is written; an end may
                                                 * be another end less its last byte; that byte is passed over
                                                 * if it comes next: "\r" and "\r\n" */
    size_t end_count;                           /* at least 1; with a length 0 or 1 */
    wh_framing_length_t length;                 /* with it there is no escape, but a time-out */
    wh_sum_kind_t sum;
    bool sums_as_bytes;          /* the sum is a byte, or two of a CRC: with a length, or behind the end */
    wh_framing_mark_t separator; /* before the digits, such as ","; no part of the body */
    bool sums_start;             /* the start counts into the sum */
    bool sums_separator;         /* the separator does */
    bool sum_is_behind; /* the sum stands behind the end, without a separator; then there is one end, */
    bool sums_end;      /* which counts into it */
    bool sums_length;   /* the length does, as it stands there */
    bool skips_empty;   /* an end alone is no frame: blank lines */
    bool has_escape;    /* a byte of the body that is a start, an end or `escape` has that before it; */
    uint8_t escape;     /* then all marks are of one byte; sums count bytes without escapes */
    size_t shortest;    /* the fewest bytes of a body */
    size_t longest;     /* the most bytes of a frame, all told: WH_FRAMING_LEAST to WH_FRAMING_LINE */
    int64_t timeout_us; /* the time after a byte at which a frame without an end is given up; 0: never */
} wh_framing_t;

/* No starts, end "\n" and "\r\n", no sum, blank lines skipped, the longest line, no time-out. */
wh_framing_t wh_framing_default(void);

/* True if the description makes sense. If not, `problem` tells field, value and what was expected, such as
 * "longest: 5000 (expected 32 to 4096)". Starts and ends share no byte, and none with the separator; with a
 * sum, none is a hex digit. */
bool wh_framing_validate(const wh_framing_t *framing, char problem[WH_FRAMING_PROBLEM_BYTES]);

/* The sum over what counts of a frame: the start's bytes, the length, the body and the separator. */
uint16_t wh_framing_sum(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size);

/* Writes a whole frame with start number `start` (ignored if there are none) around a body. Returns its size.
 * 0, and nothing is written, if there is no such start, the frame would be longer than `longest` or than its
 * length can tell, the body is
 * shorter than `shortest`, or a framer would not read this body back: it holds a start or an end without
 * `has_escape`, or is empty and `skips_empty`. Cost: linear in size, about 20 ns a byte. */
size_t wh_framing_encode(const wh_framing_t *framing, size_t start, const uint8_t *body, size_t size,
                         uint8_t frame[WH_FRAMING_LINE]);

/* The kind of a frame. Bytes behind a frame that is too long, up to an end, a start or a time-out, are passed
 * over. */
typedef enum {
    WH_FRAME_NONE,       /* no frame yet */
    WH_FRAME_GOOD,       /* whole */
    WH_FRAME_TOO_LONG,   /* over `longest`: told at once */
    WH_FRAME_NO_END,     /* a start, or the line's end, came before the frame's end; or none stands where the
                        * length says */
    WH_FRAME_TIMEOUT,    /* nothing came for `timeout_us` before the frame's end */
    WH_FRAME_SHORT,      /* the body, or what should be the sum, has too few bytes */
    WH_FRAME_BAD_SUM,    /* the sum is wrong, or is not as many hex digits */
    WH_FRAME_GARBAGE,    /* bytes without a start, up to an end, a start, a time-out, or too many of them */
    WH_FRAME_BAD_LENGTH, /* the length has other bytes than digits, or is less than a frame has */
    WH_FRAME_KINDS       /* how many there are */
} wh_frame_kind_t;

/* The name of a kind, as in "too long". Never null. */
const char *wh_frame_kind_name(wh_frame_kind_t kind);

/* A frame. Pointers lead into the framer, true until its next call. */
typedef struct {
    wh_frame_kind_t kind;
    /* When its first byte came, or, behind another frame that lost its end, all of its start. */
    int64_t first_us;
    int64_t last_us;      /* when its last byte came */
    const uint8_t *bytes; /* as they came, with start, sum and end; of a frame that is too long the first
                           * `longest`, or those before the last one of its length */
    size_t size;
    bool is_over; /* too long, garbage of that length, or a bad length: the byte that showed it stands behind
                   * them */
    const uint8_t *body; /* of a good frame, without start, length, escapes, sum and end; else as `bytes` */
    size_t body_size;
    size_t start; /* of frames with a start, which one; else 0 */
    size_t end;   /* of a good frame, which of the ends ended it; 0 also without ends */
} wh_frame_t;

/* The counts of a line. */
typedef struct {
    uint64_t bytes;                  /* taken */
    uint64_t frames[WH_FRAME_KINDS]; /* by their kind */
    uint64_t passed;                 /* bytes passed over: behind frames that were too long, and blank
                                      * lines */
} wh_framer_counters_t;

/* One direction of a line, as it is read. Read `counters`; the rest is private. */
typedef struct {
    wh_framer_counters_t counters;
    wh_framing_t framing;
    bool may_mark[256]; /* a start or an end has this byte as its last one */
    uint8_t line[WH_FRAMING_LINE + 1];
    uint8_t plain[WH_FRAMING_LINE]; /* a body without its escapes */
    bool is_escaped;                /* the last byte is an escape: the next one is no mark */
    size_t size;                    /* bytes in line */
    size_t start;                   /* the start that it begins with; start_count: none */
    bool told;                      /* the line was told of: with the next call it leaves, */
    size_t keeps;                   /* but without this number of last bytes, */
    size_t next;                    /* which are this start */
    size_t whole;     /* the bytes of a frame with a length, or with a sum behind the end; 0: not known */
    size_t dropped;   /* bytes behind a frame that was too long; `line` then has only the last bytes */
    int passes;       /* a byte that is passed over if it comes next; -1: none */
    int64_t first_us; /* of the line */
    int64_t last_us;  /* of the last byte */
} wh_framer_t;

/* Begins at an empty line; the counters are zero. False, and nothing has changed, if wh_framing_validate
 * refuses the description. */
bool wh_framer_init(wh_framer_t *framer, const wh_framing_t *framing);

/* Takes bytes that came at `time_us`, which never goes back, until there is a frame or all are taken. Returns
 * how many were taken, perhaps none with a frame; `frame->kind` is WH_FRAME_NONE without one. Called until
 * all are taken and there is no frame:
 *
 *     for (size_t at = 0;;) {
 *         at += wh_framer_feed(&framer, bytes + at, size - at, now_us, &frame);
 *         if (frame.kind == WH_FRAME_NONE) break;
 *         ...
 *     }
 *
 * Cost: linear in the bytes taken, about 10 ns a byte. */
size_t wh_framer_feed(wh_framer_t *framer, const uint8_t *bytes, size_t size, int64_t time_us,
                      wh_frame_t *frame);

/* True if time alone, up to `time_us`, gives a frame: a time-out. */
bool wh_framer_wait(wh_framer_t *framer, int64_t time_us, wh_frame_t *frame);

/* When wh_framer_wait gives a frame if no byte comes; INT64_MAX: never. */
int64_t wh_framer_due(const wh_framer_t *framer);

/* The line's end: the client has gone. True if that leaves a bad frame. The next byte begins a line anew. */
bool wh_framer_finish(wh_framer_t *framer, wh_frame_t *frame);

#endif
