/* outputs.txt: an update takes events, looks at the file, decides on the result, and reports it. */
#include "outputs.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <stdio.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "../text/output.h"

#define READS 16          /* of events in one update, because a neighbour may never stop writing */
#define RESTLESS_LOOKS 64 /* bad looks in a row after which a file that never rests is reported */
#define SHOWN_PATH 200    /* bytes; a report shows only the end of a longer path */

#define FILE_EVENTS (IN_MODIFY | IN_CLOSE_WRITE | IN_ATTRIB | IN_CREATE | IN_DELETE | IN_MOVE)
#define FOLDER_EVENTS (IN_DELETE_SELF | IN_MOVE_SELF)

static int refuse_file(const char *path, const int32_t *valves, size_t count) {
    if (path == NULL || valves == NULL || count < 1 || count > WH_GRIPPERS || path[0] == '\0' ||
        path[strlen(path) - 1] == '/') {
        return EINVAL;
    }
    for (size_t i = 0; i < count; ++i) {
        if ((uint32_t)valves[i] > WH_VALVE_CLOSED) {
            return EINVAL;
        }
    }
    return strlen(path) < WH_OUTPUTS_PATH ? 0 : ENAMETOOLONG;
}

int wh_outputs_open(wh_outputs_t *outputs, const char *path, const int32_t *valves, size_t count) {
    const int refused = outputs == NULL ? EINVAL : refuse_file(path, valves, count);
    if (refused != 0) {
        return refused;
    }
    const char *const slash = strrchr(path, '/');
    *outputs = (wh_outputs_t){.count = count,
                              .settle_us = WH_OUTPUTS_SETTLE_US,
                              .poll_us = WH_OUTPUTS_POLL_US,
                              .check_us = WH_OUTPUTS_CHECK_US,
                              .name = slash == NULL ? 0 : (size_t)(slash - path) + 1,
                              .fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC),
                              .watch = -1,
                              .quiet = true};
    memcpy(outputs->valves, valves, count * sizeof *valves);
    memcpy(outputs->path, path, strlen(path) + 1);
    return 0;
}

void wh_outputs_close(wh_outputs_t *outputs) {
    (void)close(outputs->fd);
    outputs->fd = outputs->watch = -1;
}

/* True for file systems that only this machine changes, so that inotify sees every change. */
static bool sees_all(const char *folder) {
    struct statfs system;
    const unsigned long type = statfs(folder, &system) == 0 ? (unsigned long)system.f_type : 0;
    return type == EXT4_SUPER_MAGIC || type == XFS_SUPER_MAGIC || type == BTRFS_SUPER_MAGIC ||
           type == F2FS_SUPER_MAGIC || type == TMPFS_MAGIC || type == RAMFS_MAGIC ||
           type == OVERLAYFS_SUPER_MAGIC;
}

/* Watches the folder that has the name at this moment. If it is already watched, the kernel gives the same
 * number. */
static void watch_folder(wh_outputs_t *outputs) {
    char folder[WH_OUTPUTS_PATH] = ".";
    if (outputs->name > 0) {
        memcpy(folder, outputs->path, outputs->name);
        folder[outputs->name] = '\0';
    }
    const int watch = inotify_add_watch(outputs->fd, folder, FILE_EVENTS | FOLDER_EVENTS | IN_ONLYDIR);
    if (watch != outputs->watch) {
        (void)inotify_rm_watch(outputs->fd, outputs->watch);
        outputs->quiet = watch < 0 || !sees_all(folder);
        outputs->watch = watch;
    }
}

/* True if the event is a reason to look at the file. Events of a folder that is no longer watched do not
 * count. */
static bool concerns(wh_outputs_t *outputs, const struct inotify_event *event) {
    const bool ours = event->wd == outputs->watch;
    const bool file = (event->mask & IN_Q_OVERFLOW) != 0 ||
                      (ours && event->len > 0 && strcmp(event->name, outputs->path + outputs->name) == 0);
    outputs->moved = outputs->moved || file;
    return file || (ours && (event->mask & (FOLDER_EVENTS | IN_IGNORED | IN_UNMOUNT)) != 0);
}

/* Takes the waiting events; their number is limited, so that it ends. The kernel pads each event so that
 * the next one is aligned. */
static bool take_events(wh_outputs_t *outputs) {
    char buffer[4096] __attribute__((aligned(__alignof__(struct inotify_event))));
    bool told = false;
    ssize_t size = 1;
    for (int i = 0; i < READS && size > 0; ++i) {
        size = read(outputs->fd, buffer, sizeof buffer);
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *const event = (const void *)(buffer + at);
            told = concerns(outputs, event) || told;
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    return told;
}

/* The length of the next word, which begins at `at`; 0: there is none. */
static size_t next_word(const char *text, size_t size, size_t *at) {
    static const char spaces[] = {' ', '\t', '\r', '\n'};
    size_t length = 0;
    while (*at < size && memchr(spaces, text[*at], sizeof spaces)) {
        ++*at;
    }
    while (*at + length < size && !memchr(spaces, text[*at + length], sizeof spaces)) {
        ++length;
    }
    return length;
}

static void describe_garbled(wh_outputs_look_t *look, const char *word, size_t length) {
    char shown[16] = "";
    for (size_t i = 0; i < length && i < sizeof shown - 1; ++i) {
        shown[i] = (char)(word[i] >= ' ' && word[i] <= '~' ? word[i] : '?');
    }
    (void)snprintf(look->text, sizeof look->text, "value %zu is \"%s\"", look->found + 1, shown);
}

static void judge_count(wh_outputs_look_t *look, size_t count) {
    if (look->found == count) {
        look->finding = WH_OUTPUTS_GOOD;
    } else if (look->found > count) {
        look->finding = WH_OUTPUTS_LONG;
    } else {
        look->finding = look->found > 0 ? WH_OUTPUTS_SHORT : WH_OUTPUTS_EMPTY;
    }
    if (look->found > 0) {
        (void)snprintf(look->text, sizeof look->text, "%zu value%s", look->found,
                       look->found == 1 ? "" : "s");
    }
}

wh_outputs_look_t wh_outputs_parse(const char *text, size_t size, size_t count, int32_t *valves) {
    wh_outputs_look_t look = {.finding = WH_OUTPUTS_GARBLED, .text = "empty"};
    int32_t values[WH_GRIPPERS];
    size_t at = 0;
    if (count < 1 || count > WH_GRIPPERS) {
        return look;
    }
    if (size > WH_OUTPUTS_BYTES) {
        return (wh_outputs_look_t){
            .finding = WH_OUTPUTS_LONG, .oversize = true, .text = "more than 4096 bytes"};
    }
    for (size_t length; (length = next_word(text, size, &at)) > 0; ++at, ++look.found) {
        if (length > 1 || (text[at] != '0' && text[at] != '1')) {
            describe_garbled(&look, text + at, length);
            return look;
        }
        if (look.found < count) {
            values[look.found] = text[at] - '0';
        }
    }
    judge_count(&look, count);
    if (look.finding == WH_OUTPUTS_GOOD) {
        memcpy(valves, values, count * sizeof *valves);
    }
    return look;
}

static wh_outputs_look_t failed(int error) {
    wh_outputs_look_t look = {.finding = WH_OUTPUTS_MISSING, .text = "missing"};
    if (error != ENOENT && error != ENOTDIR) {
        look.finding = WH_OUTPUTS_UNREADABLE;
        (void)snprintf(look.text, sizeof look.text, "cannot be read: %s", strerrordesc_np(error));
    }
    return look;
}

/* On Linux a write may change bytes while a read copies them, so one read can mix two moments. A result
 * counts if a second read finds it again. Otherwise the file was being written, and is treated as empty. */
static wh_outputs_look_t read_values(const wh_outputs_t *outputs, int fd, int32_t *valves) {
    char text[WH_OUTPUTS_BYTES + 1];
    char again[WH_OUTPUTS_BYTES + 1];
    const ssize_t size = pread(fd, text, sizeof text, 0);
    if (size < 0) {
        return failed(errno);
    }
    const bool same = pread(fd, again, sizeof again, 0) == size && memcmp(text, again, (size_t)size) == 0;
    return wh_outputs_parse(text, same ? (size_t)size : 0, outputs->count, valves);
}

/* Writes good values to `valves`. It does not open anything but a plain file. The file may have become a
 * fifo since stat: O_NONBLOCK, fstat. */
static wh_outputs_look_t look_at_file(wh_outputs_t *outputs, int32_t *valves, struct stat *status) {
    wh_outputs_look_t look = {.finding = WH_OUTPUTS_NO_FILE, .text = "not a regular file"};
    char byte;
    outputs->linked = readlink(outputs->path, &byte, 1) >= 0;
    if (stat(outputs->path, status) != 0) {
        return failed(errno);
    }
    if (S_ISREG(status->st_mode)) {
        const int fd = open(outputs->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        if (fd < 0) {
            return failed(errno);
        }
        if (fstat(fd, status) == 0 && S_ISREG(status->st_mode)) {
            look = read_values(outputs, fd, valves);
        }
        (void)close(fd);
    } else if (S_ISDIR(status->st_mode)) {
        (void)snprintf(look.text, sizeof look.text, "a directory");
    }
    return look;
}

/* UTF-8 passes, control characters do not, so the report is one line for any file name. */
static void report(wh_outputs_t *outputs, const wh_outputs_look_t *look) {
    const size_t length = strlen(outputs->path);
    const size_t cut = length > SHOWN_PATH ? length - SHOWN_PATH : 0;
    char valves[2 * WH_GRIPPERS + 1] = "";
    char text[160] = "good again, the valves are";
    for (size_t i = 0; i < outputs->count; ++i) {
        (void)snprintf(valves + 2 * i, 3, " %c", outputs->valves[i] == WH_VALVE_OPEN ? '0' : '1');
    }
    if (look->finding != WH_OUTPUTS_GOOD) {
        (void)snprintf(text, sizeof text, "%s (expected %zu value%s, each 0 or 1); the valves stay",
                       look->text, outputs->count, outputs->count == 1 ? "" : "s");
    }
    (void)snprintf(outputs->report, sizeof outputs->report, "%s%.*s: %s%s", cut > 0 ? "..." : "", SHOWN_PATH,
                   outputs->path + cut, text, valves);
    for (char *c = outputs->report; *c != '\0'; ++c) {
        if ((unsigned char)*c < ' ' || *c == 0x7f) {
            *c = '?';
        }
    }
}

/* Counts one more bad look. Returns true if the finding has lasted long enough. */
static bool has_settled(wh_outputs_t *outputs, bool moved, int64_t now_us) {
    if (!outputs->suspect) {
        ++outputs->counters.spells;
        outputs->suspect = moved = true;
        outputs->suspect_looks = 0;
        outputs->spell_us = now_us;
    }
    ++outputs->suspect_looks;
    outputs->rest_us = moved ? now_us : outputs->rest_us;
    const int64_t since_us = outputs->suspect_looks < RESTLESS_LOOKS ? outputs->rest_us : outputs->spell_us;
    return now_us - since_us >= outputs->settle_us;
}

/* Decides whether the finding in force changes. */
static unsigned judge_look(wh_outputs_t *outputs, const wh_outputs_look_t *look, bool moved, int64_t now_us) {
    const bool same = look->finding == outputs->finding;
    const bool good = look->finding == WH_OUTPUTS_GOOD;
    if (!same && !good && !has_settled(outputs, moved, now_us)) {
        return 0;
    }
    outputs->counters.torn += outputs->suspect && (same || good);
    outputs->suspect = false;
    if (same) {
        return 0;
    }
    outputs->finding = look->finding;
    ++outputs->counters.reports;
    outputs->counters.recoveries += good;
    report(outputs, look);
    return WH_OUTPUTS_REPORTED;
}

/* It watches the folder before the look, so that every change after the look makes an event. */
unsigned wh_outputs_update(wh_outputs_t *outputs, int64_t now_us) {
    if (!take_events(outputs) && now_us < outputs->due_us) {
        return 0;
    }
    watch_folder(outputs);
    int32_t before[WH_GRIPPERS];
    struct stat status = {0};
    memcpy(before, outputs->valves, sizeof before);
    const wh_outputs_look_t look = look_at_file(outputs, outputs->valves, &status);
    const bool switched = memcmp(before, outputs->valves, sizeof before) != 0;
    ++outputs->counters.looks[look.finding];
    outputs->counters.switches += switched;
    status.st_atim = outputs->last.st_atim; /* our own read changes it */
    const bool moved = outputs->moved || memcmp(&status, &outputs->last, sizeof status) != 0;
    outputs->moved = false;
    outputs->last = status;
    const unsigned reported = judge_look(outputs, &look, moved, now_us);
    outputs->due_us = now_us + (outputs->quiet || outputs->linked ? outputs->poll_us : outputs->check_us);
    if (outputs->suspect && outputs->rest_us + outputs->settle_us < outputs->due_us) {
        outputs->due_us = outputs->rest_us + outputs->settle_us;
    }
    return reported | (switched ? WH_OUTPUTS_SWITCHED : 0U);
}

int wh_outputs_write(const char *path, const int32_t *valves, size_t count) {
    char text[2 * WH_GRIPPERS];
    const int refused = refuse_file(path, valves, count);
    for (size_t i = 0; refused == 0 && i < count; ++i) {
        text[2 * i] = valves[i] == WH_VALVE_OPEN ? '0' : '1';
        text[2 * i + 1] = '\n';
    }
    return refused != 0 ? refused : wh_output_replace(path, text, 2 * count);
}
