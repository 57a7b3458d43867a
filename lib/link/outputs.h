/* The paper's own channel: a text file, outputs.txt, that holds one valve per gripper. Any motion control
 * software writes it, and the simulator takes its valves from it. It works on Linux only.
 *
 * The file holds one value for each gripper, in the grippers' order: 0 (open, vacuum on) or 1 (closed).
 * Blanks, tabs, line feeds and carriage returns separate the values, and may stand before and after them.
 * There are no comments, signs, names or commas. The last line needs no line feed: a value is one byte, so
 * the beginning of a good file either is short or has the same values.
 *
 * A file that is truncated and written again is empty or short in between (13 to 72 % of reads, measured).
 * A file that is replaced by rename never is. So after a bad look the last good valves stay in force. A bad
 * look is reported, once, if it lasts for the settle time; the first good look after it is reported, too.
 * Otherwise it was a torn read, and is only counted. Every change of the file starts the settle time again,
 * but after 64 bad looks in a row the first one counts. A change from one bad finding to another follows
 * these rules, too. A writer may change values one by one, without truncating. It then really writes every
 * mixture on the way, and no reader can tell.
 *
 * inotify on the file's folder tells of changes. In some places it can miss changes: a symbolic link, a
 * network file system, no folder yet, no inotify. There the file is looked at every WH_OUTPUTS_POLL_US.
 * Elsewhere it is looked at every WH_OUTPUTS_CHECK_US, for a hard link in another folder, a memory mapping,
 * or a folder exchanged further up.
 *
 * The caller owns all memory; the only system resource is one descriptor. Two threads must not use it at
 * once. */
#ifndef WH_LINK_OUTPUTS_H
#define WH_LINK_OUTPUTS_H

#include <sys/stat.h>

#include "../sim/slice.h"

#define WH_OUTPUTS_BYTES 4096 /* the largest file that is read; a report names this limit */
#define WH_OUTPUTS_PATH 4096  /* the longest path, with the zero at its end */
#define WH_OUTPUTS_REPORT 512 /* the longest report, also with the zero */

/* Defaults, us: the time that a bad finding must last; the interval of looks where inotify may miss
 * changes, and elsewhere. */
#define WH_OUTPUTS_SETTLE_US 20000
#define WH_OUTPUTS_POLL_US 50000
#define WH_OUTPUTS_CHECK_US 1000000

/* Findings of a look at the file. */
typedef enum {
    WH_OUTPUTS_GOOD,
    WH_OUTPUTS_MISSING,    /* no file, or no folder */
    WH_OUTPUTS_UNREADABLE, /* permissions, a loop of links, an I/O error */
    WH_OUTPUTS_NO_FILE,    /* a directory, a fifo, a device: never opened */
    WH_OUTPUTS_EMPTY,      /* no value */
    WH_OUTPUTS_SHORT,      /* too few values */
    WH_OUTPUTS_LONG,       /* too many values, or bytes */
    WH_OUTPUTS_GARBLED,    /* a value that is neither 0 nor 1; goes before the three above */
    WH_OUTPUTS_FINDINGS    /* the number of findings */
} wh_outputs_finding_t;

typedef struct {
    wh_outputs_finding_t finding;
    size_t found;  /* values read; in a garbled file, those before the first bad one */
    char text[80]; /* the text that was found, for a report; unprintable bytes as '?' */
    bool oversize; /* too many bytes: nothing was read */
} wh_outputs_look_t;

/* Counts since opening. A spell is a row of looks with a bad finding that is not in force yet. This always
 * holds: spells = torn + reports - recoveries, plus one during a spell. */
typedef struct {
    uint64_t looks[WH_OUTPUTS_FINDINGS]; /* by their findings */
    uint64_t switches;                   /* looks that changed a valve */
    uint64_t spells, torn;               /* all spells; those that ended before they had to be reported */
    uint64_t reports, recoveries;        /* changes of the finding in force; changes to good */
} wh_outputs_counters_t;

/* The caller reads the first group, and may change the second before the first update; the rest is
 * internal. */
typedef struct {
    int32_t valves[WH_GRIPPERS];    /* the last good valves; `count` of them */
    size_t count;                   /* grippers */
    wh_outputs_finding_t finding;   /* the one in force: the last that was reported, good at first */
    char report[WH_OUTPUTS_REPORT]; /* the last report, one line without its line feed; empty at first */
    wh_outputs_counters_t counters;
    int fd; /* for poll: readable when the file may have changed; -1, which poll ignores, without inotify */
    int64_t due_us; /* time of the next update even if the descriptor is silent, on the clock of `now_us` */

    int64_t settle_us, poll_us, check_us;

    char path[WH_OUTPUTS_PATH];
    size_t name;               /* where in path the file's name begins */
    int watch;                 /* inotify's number for the folder, or -1 */
    bool quiet, linked;        /* inotify may miss changes: in this folder; behind a symbolic link */
    bool moved;                /* an event named the file since the last look */
    struct stat last;          /* the file at the last look; zero if there was none */
    bool suspect;              /* during a spell: */
    unsigned suspect_looks;    /* its bad looks */
    int64_t spell_us, rest_us; /* its begin, and the last change of the file in it */
} wh_outputs_t;

/* Flags that wh_outputs_update returns: valves changed; the finding in force changed, see `report`. */
enum { WH_OUTPUTS_SWITCHED = 1, WH_OUTPUTS_REPORTED = 2 };

/* Prepares to read `count` (1 to WH_GRIPPERS) valves from `path`; `valves` are in force until the first
 * good look. Neither file nor folder must exist. It does not look yet. Returns 0, or EINVAL (a null
 * pointer, count, a valve that is neither 0 nor 1, a path that is empty or ends in '/') or ENAMETOOLONG:
 * nothing is changed. */
int wh_outputs_open(wh_outputs_t *outputs, const char *path, const int32_t *valves, size_t count);

/* Closes the descriptor. It may be called twice, but not on one that was never opened. */
void wh_outputs_close(wh_outputs_t *outputs);

/* Looks at the file if the descriptor is readable or the time has come; otherwise it returns 0 at once.
 * `now_us` is from a clock that never goes back, from 0 to 2^62. It never allocates or waits for a writer.
 * Cost: 10 us for a look, under 1 us without one. If the file system hangs, so does this call. */
unsigned wh_outputs_update(wh_outputs_t *outputs, int64_t now_us);

/* Only parses: reads `size` bytes of a file (any bytes). Sets `count` valves if, and only if, it finds
 * WH_OUTPUTS_GOOD; a count that is not 1 to WH_GRIPPERS gives WH_OUTPUTS_GARBLED. Cost: linear in size. */
wh_outputs_look_t wh_outputs_parse(const char *text, size_t size, size_t count, int32_t *valves);

/* The message for a run whose valves were not written to the file. */
#define WH_OUTPUTS_UNWRITTEN "--outputs %s: the valves were not written"

/* Writes the file, a value in each line, by wh_output_replace (text/output.h): nobody sees half of it.
 * Returns 0 or an errno: EINVAL for wrong arguments as at open, otherwise that of wh_output_replace. */
int wh_outputs_write(const char *path, const int32_t *valves, size_t count);

#endif
