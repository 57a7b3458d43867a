/* The paper's own channel: a text file, outputs.txt, that holds one valve per gripper. Any motion control
 * software writes it, the simulator takes its valves from it. Linux only.
 *
 * The file holds exactly one value for each gripper, in the grippers' order: 0 (open, vacuum on) or 1
 * (closed). Values are separated by one or more blanks, tabs, line feeds or carriage returns, which may also
 * stand before the first and after the last: "0 1", "0\n1\n" and "0\t1\r\n" are the same file. There are no
 * comments, signs, names or commas, and no more than WH_OUTPUTS_BYTES bytes. A last line without its line
 * feed is no sign of a torn read: a value is one byte, so whatever begins a good file and holds all of its
 * values holds the same ones.
 *
 * A read is never trusted to be whole. A file that is truncated and written again is empty or short in
 * between (13 to 72 % of reads, measured); one that is replaced by rename never is. A bad read leaves the
 * last good valves in force, and is reported only if it lasts:
 *
 *     good --bad look--> good, suspect --good look--> good        (a torn read: counted, not reported)
 *                               |
 *                               +-- settle time without a change --> bad: one report
 *     bad  --good look--> good: one report
 *
 * Every change of the file starts the settle time anew, so that a writer caught in the act twice in a row is
 * not reported either; 64 bad looks running are reported all the same once the spell is as old as the settle
 * time. From one bad condition to another it goes the same way. What no reader can tell: a writer that
 * changes the values one by one in place, without truncating first, has really written every mixture on the
 * way.
 *
 * Changes are noticed by inotify on the file's folder, which sees writing, renaming, creating, removing and
 * permissions. Where that can miss something (a symbolic link, a network file system, no folder yet, no
 * inotify to be had) the file is looked at every WH_OUTPUTS_POLL_US; elsewhere every WH_OUTPUTS_CHECK_US,
 * for the few ways past inotify: a hard link in another folder, a memory mapping, a folder exchanged further
 * up. A folder of its own keeps the file's reader from waking for its neighbours.
 *
 * All memory is the caller's; the only system resource is one descriptor. Not for two threads at once.
 */
#ifndef WH_LINK_OUTPUTS_H
#define WH_LINK_OUTPUTS_H

#include <sys/types.h>

#include "../sim/slice.h"

/* The largest file that is looked into. */
#define WH_OUTPUTS_BYTES 4096
/* The longest path, with the zero at its end. */
#define WH_OUTPUTS_PATH 4096
/* The longest report, with the zero at its end. */
#define WH_OUTPUTS_REPORT 512

/* Defaults, in us: how long a bad state must last to be reported; how often the file is looked at where
 * inotify may see nothing; and where it sees everything that is usual. */
#define WH_OUTPUTS_SETTLE_US 20000
#define WH_OUTPUTS_POLL_US 50000
#define WH_OUTPUTS_CHECK_US 1000000

/* What a look at the file can find. */
typedef enum {
    WH_OUTPUTS_GOOD,
    WH_OUTPUTS_MISSING,    /* no file, or no folder */
    WH_OUTPUTS_UNREADABLE, /* permissions, a loop of links, an I/O error, ... */
    WH_OUTPUTS_NO_FILE,    /* a directory, a fifo, a device: never opened */
    WH_OUTPUTS_EMPTY,      /* no value */
    WH_OUTPUTS_SHORT,      /* too few values */
    WH_OUTPUTS_LONG,       /* too many values, or bytes */
    WH_OUTPUTS_GARBLED,    /* something that is neither 0 nor 1; goes before the three above */
    WH_OUTPUTS_CONDITIONS  /* how many there are */
} wh_outputs_condition_t;

/* What one look found, with what a report needs. */
typedef struct {
    wh_outputs_condition_t condition;
    size_t found;  /* values read; of a garbled file, those before the one that is none */
    char text[16]; /* what stands instead of a value, cut, unprintable bytes as '?'; else empty */
    int error;     /* UNREADABLE: the errno */
    bool oversize; /* LONG: by bytes, and nothing was read */
    bool folder;   /* NO_FILE: a directory */
} wh_outputs_look_t;

/* All of them since opening. The sum of `looks` is the number of looks, and `spells` is always torn +
 * reports - recoveries, plus one while a spell has not been decided. */
typedef struct {
    uint64_t looks[WH_OUTPUTS_CONDITIONS]; /* by what they found */
    uint64_t switches;                     /* looks that changed a valve */
    uint64_t spells;     /* times that looks began to find a bad condition other than the one in force */
    uint64_t torn;       /* spells that were over before they had to be reported */
    uint64_t reports;    /* changes of the condition in force, recoveries among them */
    uint64_t recoveries; /* changes to good */
} wh_outputs_counters_t;

/* A reader. The first group is there to be read; the second may be changed between open and the first update;
 * the rest is the reader's own. */
typedef struct {
    int32_t valves[WH_GRIPPERS];      /* the last good ones; `count` of them */
    size_t count;                     /* grippers */
    wh_outputs_condition_t condition; /* the one in force: the last that was reported, good at first */
    char report[WH_OUTPUTS_REPORT];   /* the last report, one line without its line feed; empty at first */
    wh_outputs_counters_t counters;

    int64_t settle_us, poll_us, check_us;

    char path[WH_OUTPUTS_PATH];
    size_t name;            /* where in path the file's name begins, behind the folder's */
    int fd;                 /* inotify's, or -1 */
    int watch;              /* the folder's, or -1 */
    dev_t folder_device;    /* which folder that is */
    ino_t folder_inode;     /* likewise */
    bool quiet;             /* changes may come without an event */
    bool linked;            /* the path is a symbolic link */
    bool moved;             /* an event named the file since the last look */
    int64_t due_us;         /* when to look without an event */
    uint64_t print;         /* of the file's identity, size and times at the last look */
    bool suspect;           /* a spell is on */
    unsigned suspect_looks; /* in it */
    int64_t suspect_us;     /* when it began */
    int64_t still_us;       /* when the file last changed in it */
} wh_outputs_t;

/* What wh_outputs_update returns, or-ed. */
enum {
    WH_OUTPUTS_SWITCHED = 1, /* valves are others than before */
    WH_OUTPUTS_REPORTED = 2  /* the condition in force changed; `report` says what to what */
};

/* Prepares to read `count` (1 to WH_GRIPPERS) valves from `path`; `valves` are in force until the first good
 * look. Neither file nor folder need exist. Does not look yet: call wh_outputs_update next. Returns 0, or
 * EINVAL (a null pointer, count, a valve that is neither 0 nor 1, a path that is empty or ends in '/') or
 * ENAMETOOLONG, `outputs` then being unchanged. When inotify is not to be had the descriptor is -1 and the
 * reader polls. */
int wh_outputs_open(wh_outputs_t *outputs, const char *path, const int32_t *valves, size_t count);

/* Closes the descriptor. May be called twice; not on one that was never opened. */
void wh_outputs_close(wh_outputs_t *outputs);

/* For poll: readable when the file may have changed. -1, which poll ignores, when there is no inotify. The
 * same for the reader's lifetime. */
int wh_outputs_fd(const wh_outputs_t *outputs);

/* When wh_outputs_update must be called even though the descriptor said nothing, on the clock of `now_us`. */
int64_t wh_outputs_due(const wh_outputs_t *outputs);

/* Looks at the file if the descriptor is readable or the time has come; else it returns 0 at once. `now_us`
 * is from a clock that never goes back, from 0 to 2^62. Returns WH_OUTPUTS_SWITCHED and WH_OUTPUTS_REPORTED
 * or-ed. Never allocates, never waits for a writer, never opens what is not a regular file. Cost: at most
 * sixteen reads of events and ten other system calls: 10 us for a look, under 1 us without one; a file
 * system that hangs, hangs it. */
unsigned wh_outputs_update(wh_outputs_t *outputs, int64_t now_us);

/* The grammar alone: reads `size` bytes of a file (any bytes). Sets `count` valves if, and only if, it
 * returns WH_OUTPUTS_GOOD; a count that is not 1 to WH_GRIPPERS gives WH_OUTPUTS_GARBLED. Cost: linear in
 * size. */
wh_outputs_look_t wh_outputs_parse(const char *text, size_t size, size_t count, int32_t *valves);

/* A condition's name, such as "garbled": a constant string; "unknown" for a number that is none. */
const char *wh_outputs_condition_name(wh_outputs_condition_t condition);

/* Writes the file, a value a line, so that a reader sees the old file or the new one and nothing else: into
 * a new file in the same folder, which is then renamed. A symbolic link stays one, what it points to is
 * replaced (one that points nowhere is itself replaced). A file that is there keeps its permissions, a new
 * one gets 0666 less the umask. Returns 0 or an errno: EINVAL for wrong arguments as at open, and for a path
 * that is there and is neither file nor directory (EISDIR); then nothing has changed and no temporary file
 * is left. (A kill in between leaves one, ".waferhand-PID-N".) Nothing is synced to the disk: the file is a
 * signal among running programs, and after a power cut there are none. */
int wh_outputs_write(const char *path, const int32_t *valves, size_t count);

#endif
