/* How the reader learns that the file may have changed: inotify on its folder. */
#include <errno.h>
#include <linux/magic.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "outputs_internal.h"

/* Reads of events in one update: a neighbour that never stops writing must not keep it for ever. */
#define READS 16

#define FILE_EVENTS                                                                                          \
    (IN_MODIFY | IN_CLOSE_WRITE | IN_ATTRIB | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO)
#define FOLDER_EVENTS (IN_DELETE_SELF | IN_MOVE_SELF)
/* After these the watch is no longer the folder's, if it is one at all. */
#define LOST_EVENTS (FOLDER_EVENTS | IN_IGNORED | IN_UNMOUNT)

/* File systems on which all changes are made by this machine, so that inotify sees them. */
static bool sees_all(const char *folder) {
    static const unsigned long magics[] = {EXT4_SUPER_MAGIC,     TMPFS_MAGIC,       RAMFS_MAGIC,
                                           XFS_SUPER_MAGIC,      BTRFS_SUPER_MAGIC, F2FS_SUPER_MAGIC,
                                           OVERLAYFS_SUPER_MAGIC};
    struct statfs system;
    if (statfs(folder, &system) != 0) {
        return false;
    }
    for (size_t i = 0; i < sizeof magics / sizeof magics[0]; ++i) {
        if ((unsigned long)system.f_type == magics[i]) {
            return true;
        }
    }
    return false;
}

/* The path up to the file's name, in `folder`. */
static void copy_folder(const wh_outputs_t *outputs, char folder[WH_OUTPUTS_PATH]) {
    if (outputs->name == 0) {
        memcpy(folder, ".", 2);
        return;
    }
    memcpy(folder, outputs->path, outputs->name);
    folder[outputs->name] = '\0';
}

static void unwatch(wh_outputs_t *outputs) {
    if (outputs->watch >= 0) {
        (void)inotify_rm_watch(outputs->fd, outputs->watch);
    }
    outputs->watch = -1;
    outputs->quiet = true;
}

void wh_outputs_watch_open(wh_outputs_t *outputs) {
    outputs->fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    outputs->watch = -1;
    outputs->quiet = true;
}

/* The folder is identified before it is watched: if it is exchanged in between, the next call sees that the
 * noted one is gone and does it again. */
void wh_outputs_watch_renew(wh_outputs_t *outputs) {
    if (outputs->fd < 0) {
        return;
    }
    char folder[WH_OUTPUTS_PATH];
    copy_folder(outputs, folder);
    struct stat status;
    if (stat(folder, &status) != 0) {
        unwatch(outputs);
        return;
    }
    if (outputs->watch >= 0 && status.st_dev == outputs->folder_device &&
        status.st_ino == outputs->folder_inode) {
        return;
    }
    unwatch(outputs);
    outputs->folder_device = status.st_dev;
    outputs->folder_inode = status.st_ino;
    outputs->watch = inotify_add_watch(outputs->fd, folder, FILE_EVENTS | FOLDER_EVENTS | IN_ONLYDIR);
    outputs->quiet = outputs->watch < 0 || !sees_all(folder);
}

/* True if the event is a reason to look. Events of a watch that was given up do not count. */
static bool take(wh_outputs_t *outputs, const struct inotify_event *event) {
    if ((event->mask & IN_Q_OVERFLOW) != 0) {
        outputs->moved = true;
        return true;
    }
    if (event->wd != outputs->watch) {
        return false;
    }
    if ((event->mask & LOST_EVENTS) != 0) {
        unwatch(outputs);
        return true;
    }
    if (event->len == 0 || strcmp(event->name, outputs->path + outputs->name) != 0) {
        return false;
    }
    outputs->moved = true;
    return true;
}

/* The events of one read. The kernel pads each so that the next one is aligned. */
static bool take_all(wh_outputs_t *outputs, const char *bytes, const char *end) {
    bool look = false;
    while (bytes < end) {
        const struct inotify_event *const event = (const struct inotify_event *)(const void *)bytes;
        look |= take(outputs, event);
        bytes += sizeof *event + event->len;
    }
    return look;
}

bool wh_outputs_watch_drain(wh_outputs_t *outputs) {
    union {
        struct inotify_event first; /* aligns the others */
        char bytes[4096];
    } buffer;
    bool look = false;
    for (int i = 0; i < READS && outputs->fd >= 0; ++i) {
        const ssize_t size = read(outputs->fd, buffer.bytes, sizeof buffer);
        if (size <= 0) {
            break;
        }
        look |= take_all(outputs, buffer.bytes, buffer.bytes + size);
    }
    return look;
}
