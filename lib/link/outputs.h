/* The paper's own channel: a text file, outputs.txt, that holds one valve per gripper. Any motion control
 * software writes it, the simulator takes its valves from it. Linux only.
 *
 * The file holds one value for each gripper, in the grippers' order: 0 (open, vacuum on) or 1 (closed).
 * Blanks, tabs, line feeds and carriage returns separate them, and may stand before and after them. There are
 * no comments, signs, names or commas. The last line needs no line feed: a value is one byte, so the
 * beginning of a good file is either short or has the same values.
 *
 * A file that is truncated and written again is empty or short in between (13 to 72 % of reads, measured);
 * one that is replaced by rename never is. So a bad look leaves the last good valves in force. It is
 * reported, once, if it lasts for the settle time, and so is the first good one after it; else it was a torn
 * read, and only counted. Every change of the file starts the settle time anew, but after 64 bad looks in a
 * row the first one counts. From one bad finding to another it goes the same way. A writer that changes
 * values one by one, without truncating, has really written every mixture on the way: no reader can tell.
 *
 * inotify on the file's folder tells of changes. Where it can miss some (a symbolic link, a network file
 * system, no folder yet, no inotify) the file is looked at every WH_OUTPUTS_POLL_US; elsewhere every
 * WH_OUTPUTS_CHECK_US, for a hard link in another folder, a memory mapping, or a folder exchanged further up.
 *
 * All memory is the caller's; the only system resource is one descriptor. Not for two threads at once. */
#ifndef WH_LINK_OUTPUTS_H
#define WH_LINK_OUTPUTS_H

#include <sys/stat.h>

#include "../sim/slice.h"

#define WH_OUTPUTS_BYTES 4096 /* the largest file that is looked into; a report names it */
#define WH_OUTPUTS_PATH 4096  /* the longest path, with the zero at its end */
#define WH_OUTPUTS_REPORT 512 /* the longest report, likewise */

/* Defaults, us: how long a bad finding must last; how often to look where inotify may miss changes, and
 * else. */
#define WH_OUTPUTS_SETTLE_US 20000
#define WH_OUTPUTS_POLL_US 50000
#define WH_OUTPUTS_CHECK_US 1000000

/* What a look at the file can find. */
typedef enum {
    WH_OUTPUTS_GOOD,
    WH_OUTPUTS_MISSING,    /* no file, or no folder */
    WH_OUTPUTS_UNREADABLE, /* permissions, a loop of links, an I/O error */
    WH_OUTPUTS_NO_FILE,    /* a directory, a fifo, a device: never opened */
    WH_OUTPUTS_EMPTY,      /* no value */
    WH_OUTPUTS_SHORT,      /* too few values */
    WH_OUTPUTS_LONG,       /* too many values, or bytes */
    WH_OUTPUTS_GARBLED,    /* something that is neither 0 nor 1; goes before the three above */
    WH_OUTPUTS_FINDINGS    /* how many there are */
} wh_outputs_finding_t;

typedef struct {
    wh_outputs_finding_t finding;
    size_t found;  /* values read; of a garbled file, those before the first that is none */
    char text[80]; /* what was found, for a report; bytes that cannot be printed as '?' */
    bool oversize; /* too many bytes: nothing was read */
} wh_outputs_look_t;

/* Since opening. A spell: looks that find something bad which is not in force yet. Always: spells = torn +
 * reports - recoveries, plus one while a spell is on. */
typedef struct {
    uint64_t looks[WH_OUTPUTS_FINDINGS]; /* by what they found */
    uint64_t switches;                   /* looks that changed a valve */
    uint64_t spells, torn;               /* all; those that were over before they had to be reported */
    uint64_t reports, recoveries;        /* changes of the finding in force; those to good */
} wh_outputs_counters_t;

/* The first group is to be read; the second may be changed before the first update; the rest is its own. */
typedef struct {
    int32_t valves[WH_GRIPPERS];    /* the last good ones; `count` of them */
    size_t count;                   /* grippers */
    wh_outputs_finding_t finding;   /* the one in force: the last that was reported, good at first */
    char report[WH_OUTPUTS_REPORT]; /* the last report, one line without its line feed; empty at first */
    wh_outputs_counters_t counters;
    int fd; /* for poll: readable when the file may have changed; -1, which poll ignores, without inotify */
    int64_t due_us; /* when to update even if the descriptor is silent, on the clock of `now_us` */

    int64_t settle_us, poll_us, check_us;

    char path[WH_OUTPUTS_PATH];
    size_t name;               /* where in path the file's name begins */
    int watch;                 /* inotify's number for the folder; or -1 */
    bool quiet, linked;        /* inotify may miss changes: in this folder; behind a symbolic link */
    bool moved;                /* an event named the file since the last look */
    struct stat last;          /* the file at the last look; zero if there was none */
    bool suspect;              /* a spell is on: */
    unsigned suspect_looks;    /* bad looks in it */
    int64_t spell_us, rest_us; /* when it began, and when the file last changed in it */
} wh_outputs_t;

/* What wh_outputs_update returns, or-ed: valves changed; the finding in force changed, see `report`. */
enum { WH_OUTPUTS_SWITCHED = 1, WH_OUTPUTS_REPORTED = 2 };

/* Prepares to read `count` (1 to WH_GRIPPERS) valves from `path`; `valves` are in force until the first good
 * look. Neither file nor folder need exist. Does not look yet. Returns 0, or EINVAL (a null pointer, count, a
 * valve that is neither 0 nor 1, a path that is empty or ends in '/') or ENAMETOOLONG: nothing is changed. */
int wh_outputs_open(wh_outputs_t *outputs, const char *path, const int32_t *valves, size_t count);

/* Closes the descriptor. May be called twice; not on one that was never opened. */
void wh_outputs_close(wh_outputs_t *outputs);

/* Looks at the file if the descriptor is readable or the time has come; else returns 0 at once. `now_us` is
 * from a clock that never goes back, from 0 to 2^62. Never allocates or waits for a writer. Cost: 10 us for a
 * look, under 1 us without one. If the file system hangs, so does this call. */
unsigned wh_outputs_update(wh_outputs_t *outputs, int64_t now_us);

/* The grammar alone: reads `size` bytes of a file (any bytes). Sets `count` valves if, and only if, it finds
 * WH_OUTPUTS_GOOD; a count that is not 1 to WH_GRIPPERS gives WH_OUTPUTS_GARBLED. Cost: linear in size. */
wh_outputs_look_t wh_outputs_parse(const char *text, size_t size, size_t count, int32_t *valves);

/* What is said of a run for which it was not written, of the file. */
#define WH_OUTPUTS_UNWRITTEN "--outputs %s: the valves were not written"

/* Writes the file, a value a line, by wh_output_replace (text/output.h): nobody sees half of it. Returns 0 or
 * an errno: EINVAL for wrong arguments as at open, else that of wh_output_replace. */
int wh_outputs_write(const char *path, const int32_t *valves, size_t count);

#endif
