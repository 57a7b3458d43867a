#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "array.h"

/* The number of names that are tried, because other processes may write in the same folder, or may have
 * been killed. */
#define ATTEMPTS 100

bool wh_output_resolve(const char *path, char resolved[PATH_MAX]) {
    char folder[PATH_MAX];
    char whole[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const int length = slash ? (int)(slash - path) + 1 : 0;
    (void)snprintf(folder, sizeof folder, "%.*s.", length, path);
    if (!realpath(folder, whole)) {
        return false;
    }
    return snprintf(resolved, PATH_MAX, "%s/%s", whole, slash ? slash + 1 : path) < PATH_MAX;
}

/* The file to replace: the path, or the target of a link. Its permissions go to `mode`, 0 if there is none.
 * Returns 0 or an errno. */
static int find_target(const char *path, char target[PATH_MAX], mode_t *mode) {
    struct stat status;
    const bool exists = stat(path, &status) == 0;
    *mode = exists ? status.st_mode & 0777U : 0;
    if (!exists && errno != ENOENT) {
        return errno;
    }
    if (exists && !S_ISREG(status.st_mode)) {
        return S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
    }
    if (!exists || !realpath(path, target)) {
        (void)snprintf(target, PATH_MAX, "%s", path);
    }
    return 0;
}

/* Returns a descriptor, or -1 and errno. */
static int create_beside(wh_output_t *output) {
    const char *const slash = strrchr(output->target, '/');
    const int folder = slash ? (int)(slash - output->target) + 1 : 0;
    int fd = -1;
    for (int i = 0; fd < 0 && i < ATTEMPTS && (i == 0 || errno == EEXIST); ++i) {
        (void)snprintf(output->beside, sizeof output->beside, "%.*s.waferhand-%ld-%d", folder, output->target,
                       (long)getpid(), i);
        fd = open(output->beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (fd < 0) {
        output->beside[0] = '\0';
    }
    return fd;
}

bool wh_output_open(wh_output_t *output, const char *path) {
    mode_t mode;
    output->file = NULL;
    output->beside[0] = '\0';
    errno = find_target(path, output->target, &mode);
    if (errno == EINVAL) {
        output->file = fopen(path, "wb");
    } else if (errno == 0 && (access(output->target, W_OK) == 0 || errno == ENOENT)) {
        const int fd = create_beside(output);
        if (fd >= 0 && mode != 0) {
            (void)fchmod(fd, mode);
        }
        output->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    }
    return output->file != NULL;
}

/* True if all bytes are on the disk, because a power cut after the renaming must not leave an empty
 * file. */
static bool is_stored(const wh_output_t *output) {
    return fflush(output->file) == 0 && !ferror(output->file) &&
           (output->beside[0] == '\0' || fsync(fileno(output->file)) == 0);
}

bool wh_output_commit(wh_output_t *output) {
    const bool stored = is_stored(output);
    const bool closed = fclose(output->file) == 0;
    output->file = NULL;
    const bool placed =
        stored && closed && (output->beside[0] == '\0' || rename(output->beside, output->target) == 0);
    const int reason = errno;
    if (placed) {
        output->beside[0] = '\0';
    }
    wh_output_drop(output);
    errno = reason;
    return placed;
}

void wh_output_drop(wh_output_t *output) {
    if (output->file) {
        (void)fclose(output->file);
        output->file = NULL;
    }
    if (output->beside[0] != '\0') {
        (void)unlink(output->beside);
        output->beside[0] = '\0';
    }
}

void wh_output_tell(const char *option, const char *path, int error) {
    fprintf(stderr, "%s %s: %s (expected a file that can be written)\n", option, path, strerror(error));
}

/* Returns true, or errno gives the reason: with a full disk close itself may fail. */
static bool fill(int fd, mode_t mode, const void *bytes, size_t size) {
    errno = ENOSPC;
    const bool filled = write(fd, bytes, size) == (ssize_t)size && (mode == 0 || fchmod(fd, mode) == 0);
    const int error = errno;
    const bool closed = close(fd) == 0;
    errno = filled ? errno : error;
    return filled && closed;
}

int wh_output_replace(const char *path, const void *bytes, size_t size) {
    wh_output_t output = {0};
    mode_t mode;
    int error = find_target(path, output.target, &mode);
    if (error != 0) {
        return error;
    }
    const int fd = create_beside(&output);
    if (fd >= 0 && fill(fd, mode, bytes, size) && rename(output.beside, output.target) == 0) {
        return 0;
    }
    error = errno;
    wh_output_drop(&output);
    return error;
}

/* --------------------------------------------------------------------------------------------------- kept */

/* The system reuses a file's number once the file is gone; the time of birth tells the two files apart. */
typedef struct {
    uint64_t number;
    uint32_t device[2], born_ns;
    int64_t born_s;
} file_id_t;

/* It is static, because a process reads its inputs in many places, and all of them are inputs of everything
 * that it writes. */
static struct {
    pthread_mutex_t mutex;
    file_id_t *files;
    size_t count, capacity;
} kept = {.mutex = PTHREAD_MUTEX_INITIALIZER};

static bool find_plain(const char *path, file_id_t *id) {
#if defined(STATX_BTIME)
    struct statx status;
    const bool plain = path && statx(AT_FDCWD, path, 0, STATX_TYPE | STATX_INO | STATX_BTIME, &status) == 0 &&
                       S_ISREG(status.stx_mode);
    if (plain) {
        *id = (file_id_t){.number = status.stx_ino,
                          .device = {status.stx_dev_major, status.stx_dev_minor},
                          .born_ns = status.stx_btime.tv_nsec,
                          .born_s = status.stx_btime.tv_sec};
    }
    return plain;
#else /* a page's files, in memory, have no time of birth */
    struct stat status;
    const bool plain = path && stat(path, &status) == 0 && S_ISREG(status.st_mode);
    if (plain) {
        *id = (file_id_t){.number = status.st_ino};
    }
    return plain;
#endif
}

static bool is_listed(const file_id_t *id) {
    for (size_t i = 0; i < kept.count; ++i) {
        const file_id_t *file = &kept.files[i];
        if (file->number == id->number && file->device[0] == id->device[0] &&
            file->device[1] == id->device[1] && file->born_s == id->born_s && file->born_ns == id->born_ns) {
            return true;
        }
    }
    return false;
}

/* True if it is in the list; otherwise, with `adds`, it is added. */
static bool look_up(const char *path, bool adds) {
    file_id_t id;
    if (!find_plain(path, &id)) {
        return false;
    }
    pthread_mutex_lock(&kept.mutex);
    const bool listed = is_listed(&id);
    if (adds && !listed) {
        kept.files = wh_array_grow(kept.files, kept.count, &kept.capacity, sizeof *kept.files);
        kept.files[kept.count++] = id;
    }
    pthread_mutex_unlock(&kept.mutex);
    return listed;
}

void wh_output_keep(const char *path) {
    (void)look_up(path, true);
}

bool wh_output_is_kept(const char *path) {
    return look_up(path, false);
}

/* It is static, like the list. */
static struct {
    void (*hear)(void *user, const char *path);
    void *user;
} listener;

void wh_output_hear_inputs(void (*hear)(void *user, const char *path), void *user) {
    listener.hear = hear;
    listener.user = user;
}

void wh_output_note_input(const char *path) {
    if (listener.hear) {
        listener.hear(listener.user, path);
    }
}

/* -------------------------------------------------------------------------------------------------- state */

void wh_output_state_path(const char *name, char *path, size_t size) {
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    /* The XDG specification requires relative paths to be ignored. */
    if (state && state[0] == '/') {
        length = snprintf(path, size, "%s/waferhand/%s", state, name);
    } else if (home && home[0] == '/') {
        length = snprintf(path, size, "%s/.local/state/waferhand/%s", home, name);
    }
    if (length < 0 || (size_t)length >= size) {
        path[0] = '\0';
    }
}

bool wh_output_make_folders(const char *path) {
    char folder[PATH_MAX];
    bool made = (size_t)snprintf(folder, sizeof folder, "%s", path) < sizeof folder;
    for (char *slash = strchr(folder + 1, '/'); made && slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        made = mkdir(folder, 0700) == 0 || errno == EEXIST;
        *slash = '/';
    }
    return made;
}

bool wh_output_is_one_file(const char *a, const char *b) {
    struct stat one;
    struct stat two;
    return stat(a, &one) == 0 && stat(b, &two) == 0 && one.st_dev == two.st_dev && one.st_ino == two.st_ino;
}

void wh_output_word(FILE *out, const char *word) {
    const char *plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=+,:@%";
    if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (const char *c = word; *c; ++c) {
        if (*c == '\'') {
            fputs("'\\''", out);
        } else {
            fputc((unsigned char)*c, out);
        }
    }
    fputc('\'', out);
}
