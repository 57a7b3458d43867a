#include "watch.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "../text/output.h"
#include "app.h"

/* After a first event it waits until no event comes for this time: saving has several steps. */
#define SETTLE_MS 15
/* A missing file may be about to be replaced: it is looked for again after this time. */
#define MISSING_MS 150

/* The state of a file just before it was read; all zero: it was not there. */
typedef struct {
    uint64_t device, number, size;
    int64_t changed_ns, modified_ns;
} stand_t;

/* The message of a process to its parent about a file. */
typedef struct {
    stand_t stand;
    char path[PATH_MAX];
} told_t;

typedef struct {
    const wh_watch_options_t *options;
    int events, signals; /* descriptors: inotify's, and of the signals */
    int ear;             /* the descriptor of the running process's messages; -1: none */
    pid_t process;       /* 0: none runs */
    double begin;        /* s: of the running command */
    told_t *files;       /* the files that it has read so far */
    size_t file_count, file_capacity;
} watch_t;

/* ------------------------------------------------------------------------------------------------ files */

static stand_t stand_of(const char *path) {
    struct stat status;
    stand_t stand;
    memset(&stand, 0, sizeof stand); /* compared by its bytes */
    if (stat(path, &status) == 0) {
        stand.device = (uint64_t)status.st_dev;
        stand.number = (uint64_t)status.st_ino;
        stand.size = (uint64_t)status.st_size;
        stand.changed_ns = (int64_t)status.st_ctim.tv_sec * 1000000000 + status.st_ctim.tv_nsec;
        stand.modified_ns = (int64_t)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
    }
    return stand;
}

/* Watches the folder of a file, and if the file is a link, the folder of its target: an editor may put a new
 * file in its place. */
static void watch_folder(const watch_t *watch, const char *path) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 0;
    (void)snprintf(folder, sizeof folder, "%.*s", length, path);
    (void)inotify_add_watch(watch->events, length > 0 ? folder : ".",
                            IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE |
                                IN_ONLYDIR);
}

static void watch_file(const watch_t *watch, const char *path) {
    char target[PATH_MAX];
    watch_folder(watch, path);
    if (realpath(path, target)) {
        watch_folder(watch, target);
    }
}

/* The first file that is no longer as it was read; null: all are. */
static const char *find_changed(const watch_t *watch, bool *is_missing) {
    const char *changed = NULL;
    *is_missing = false;
    for (size_t i = 0; i < watch->file_count; ++i) {
        const told_t *file = &watch->files[i];
        const stand_t now = stand_of(file->path);
        if (memcmp(&now, &file->stand, sizeof now) != 0) {
            *is_missing = *is_missing || now.number == 0;
            changed = changed ? changed : file->path;
        }
    }
    return changed;
}

/* --------------------------------------------------------------------------------------- in the process */

static void tell_parent(void *user, const char *path) {
    const int *mouth = user;
    told_t told;
    memset(&told, 0, sizeof told);
    if (snprintf(told.path, sizeof told.path, "%s", path) < (int)sizeof told.path) {
        told.stand = stand_of(path);
        (void)!write(*mouth, &told, sizeof told);
    }
}

/* Does not return. It ends with its parent, and by Ctrl-C as ever. */
__attribute__((noreturn)) static void carry_out(const watch_t *watch, int mouth, pid_t parent) {
    sigset_t none;
    sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, NULL);
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) {
        _exit(WH_EXIT_USAGE);
    }
    wh_output_hear_inputs(tell_parent, &mouth);
    const int status = watch->options->act(watch->options->user);
    (void)fflush(stdout);
    (void)fflush(stderr);
    _exit(status);
}

/* ---------------------------------------------------------------------------------------- in the parent */

static bool begin_round(watch_t *watch) {
    int ends[2];
    const pid_t parent = getpid();
    if (pipe(ends) != 0) {
        return false;
    }
    watch->file_count = 0;
    watch->begin = wh_clock_seconds();
    (void)fflush(stdout);
    (void)fflush(stderr);
    watch->process = fork();
    if (watch->process == 0) {
        (void)close(ends[0]);
        carry_out(watch, ends[1], parent);
    }
    (void)close(ends[1]);
    watch->ear = ends[0];
    return watch->process > 0;
}

static bool is_known(const watch_t *watch, const char *path) {
    for (size_t i = 0; i < watch->file_count; ++i) {
        if (strcmp(watch->files[i].path, path) == 0) {
            return true;
        }
    }
    return false;
}

/* Takes a message; waits for one until the other end is closed. False at that end. */
static bool hear(watch_t *watch) {
    told_t told;
    size_t size = 0;
    while (size < sizeof told) {
        const ssize_t got = read(watch->ear, (char *)&told + size, sizeof told - size);
        if (got == 0 || (got < 0 && errno != EINTR)) {
            return false;
        }
        size += got > 0 ? (size_t)got : 0;
    }
    if (!is_known(watch, told.path)) {
        watch->files =
            wh_array_grow(watch->files, watch->file_count, &watch->file_capacity, sizeof *watch->files);
        watch->files[watch->file_count++] = told;
        watch_file(watch, told.path);
    }
    return true;
}

static void stop_hearing(watch_t *watch) {
    if (watch->ear >= 0) {
        (void)close(watch->ear);
        watch->ear = -1;
    }
}

/* Removes files that a killed process was about to put in an output's place: see wh_output_t. */
static void remove_leftovers(const watch_t *watch, pid_t process) {
    for (size_t i = 0; i < watch->options->output_count; ++i) {
        const char *path = watch->options->outputs[i];
        const char *slash = path ? strrchr(path, '/') : NULL;
        const int length = slash ? (int)(slash - path) + 1 : 0;
        char beside[PATH_MAX];
        for (int place = 0; path && place < 2; ++place) { /* beside it, and in it if it is a folder */
            (void)snprintf(beside, sizeof beside, "%.*s%s.waferhand-%ld-0",
                           place == 0 ? length : (int)strlen(path), path, place == 0 ? "" : "/",
                           (long)process);
            (void)unlink(beside);
        }
    }
}

static void give_up(watch_t *watch) {
    if (watch->process > 0) {
        (void)kill(watch->process, SIGKILL);
        (void)waitpid(watch->process, NULL, 0);
        remove_leftovers(watch, watch->process);
    }
    watch->process = 0;
    stop_hearing(watch);
}

static void tell_end(const watch_t *watch, int status) {
    static const char *const words[] = {
        [WH_EXIT_MET] = "ok", [WH_EXIT_FAILED] = "failed", [WH_EXIT_USAGE] = "not usable"};
    const double took = wh_clock_seconds() - watch->begin;
    const size_t files = watch->file_count;
    if (WIFSIGNALED(status)) {
        fprintf(stderr, "watch: signal %d ended it (%s)", WTERMSIG(status), strsignal(WTERMSIG(status)));
    } else {
        const size_t code = (size_t)WEXITSTATUS(status);
        fprintf(stderr, "watch: %s", code < sizeof words / sizeof words[0] ? words[code] : "ended");
    }
    fprintf(stderr, " after %.2f s; %zu file%s watched until Ctrl-C\n", took, files, files == 1 ? "" : "s");
}

/* The process may have ended: its last messages are still read. */
static void look_for_end(watch_t *watch) {
    int status = 0;
    if (watch->process > 0 && waitpid(watch->process, &status, WNOHANG) == watch->process) {
        watch->process = 0;
        while (watch->ear >= 0 && hear(watch)) {
        }
        stop_hearing(watch);
        tell_end(watch, status);
    }
}

static bool is_readable(int descriptor, int wait_ms) {
    struct pollfd one = {.fd = descriptor, .events = POLLIN};
    return poll(&one, 1, wait_ms) > 0;
}

/* Takes all events from inotify, and waits until no more come. */
static void drain(const watch_t *watch) {
    char events[4096] __attribute__((aligned(8)));
    while (is_readable(watch->events, SETTLE_MS) && read(watch->events, events, sizeof events) > 0) {
    }
}

/* False if no process could be begun. */
static bool look_at_files(watch_t *watch) {
    bool is_missing = false;
    const char *changed = find_changed(watch, &is_missing);
    for (int waited = 0; changed && is_missing && waited < MISSING_MS; waited += SETTLE_MS) {
        (void)is_readable(watch->events, SETTLE_MS);
        drain(watch);
        changed = find_changed(watch, &is_missing);
    }
    if (!changed) {
        return true;
    }
    fprintf(stderr, "\nwatch: %s has changed\n", changed);
    give_up(watch);
    return begin_round(watch);
}

/* True if a signal came that ends the watch. */
static bool take_signals(watch_t *watch) {
    struct signalfd_siginfo come;
    if (!is_readable(watch->signals, 0) || read(watch->signals, &come, sizeof come) != (ssize_t)sizeof come) {
        return false;
    }
    look_for_end(watch);
    return come.ssi_signo != SIGCHLD;
}

static bool go_on(watch_t *watch) {
    for (;;) {
        struct pollfd all[3] = {{.fd = watch->signals, .events = POLLIN},
                                {.fd = watch->events, .events = POLLIN},
                                {.fd = watch->ear, .events = POLLIN}};
        (void)poll(all, 3, -1);
        if (take_signals(watch)) {
            return true;
        }
        if (all[2].revents != 0 && watch->ear >= 0 && !hear(watch)) {
            stop_hearing(watch);
        }
        if (all[1].revents != 0) {
            drain(watch);
        }
        /* The check also runs if nothing was reported: a file may have been saved before its folder was
         * watched. */
        if (!look_at_files(watch)) {
            return false;
        }
    }
}

int wh_watch(const wh_watch_options_t *options) {
    watch_t watch = {.options = options, .ear = -1};
    sigset_t wanted;
    sigset_t before;
    sigemptyset(&wanted);
    sigaddset(&wanted, SIGINT);
    sigaddset(&wanted, SIGTERM);
    sigaddset(&wanted, SIGCHLD);
    (void)sigprocmask(SIG_BLOCK, &wanted, &before);
    watch.events = inotify_init1(IN_CLOEXEC);
    watch.signals = signalfd(-1, &wanted, SFD_CLOEXEC);
    const bool good = watch.events >= 0 && watch.signals >= 0 && begin_round(&watch) && go_on(&watch);
    if (!good) {
        fprintf(stderr, "--watch: %s\n", strerror(errno));
    }
    give_up(&watch);
    (void)close(watch.events);
    (void)close(watch.signals);
    free(watch.files);
    /* The signal may come twice, to the process and to its group: the second one has nothing left to end. */
    (void)signal(SIGINT, SIG_IGN);
    (void)signal(SIGTERM, SIG_IGN);
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    return good ? WH_EXIT_MET : WH_EXIT_USAGE;
}
