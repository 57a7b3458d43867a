#include "output.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_plain(const char *path) {
    struct stat status;
    return stat(path, &status) != 0 || S_ISREG(status.st_mode);
}

/* The permissions of the file that is replaced, or those of any new file. */
static mode_t mode_of(const char *path) {
    struct stat status;
    if (stat(path, &status) == 0) {
        return status.st_mode & 0777U;
    }
    const mode_t mask = umask(0);
    (void)umask(mask);
    return 0666U & ~mask;
}

static FILE *open_beside(wh_output_t *output) {
    const size_t size = sizeof output->beside;
    if ((size_t)snprintf(output->beside, size, "%s.XXXXXX", output->path) >= size) {
        output->beside[0] = '\0';
        errno = ENAMETOOLONG;
        return NULL;
    }
    const int descriptor = mkstemp(output->beside);
    if (descriptor < 0) {
        output->beside[0] = '\0';
        return NULL;
    }
    (void)fchmod(descriptor, mode_of(output->path));
    return fdopen(descriptor, "wb");
}

bool wh_output_open(wh_output_t *output, const char *path) {
    output->path = path;
    output->beside[0] = '\0';
    if (is_plain(path) && access(path, F_OK) == 0 && access(path, W_OK) != 0) {
        return false;
    }
    output->file = is_plain(path) ? open_beside(output) : fopen(path, "wb");
    return output->file != NULL;
}

/* True if all bytes are on the disk: a power cut after the renaming must not leave an empty file. */
static bool is_stored(const wh_output_t *output) {
    return fflush(output->file) == 0 && !ferror(output->file) &&
           (output->beside[0] == '\0' || fsync(fileno(output->file)) == 0);
}

bool wh_output_commit(wh_output_t *output) {
    const bool stored = is_stored(output);
    const bool closed = fclose(output->file) == 0;
    output->file = NULL;
    const bool placed =
        stored && closed && (output->beside[0] == '\0' || rename(output->beside, output->path) == 0);
    if (!placed && output->beside[0] != '\0') {
        const int reason = errno;
        (void)unlink(output->beside);
        errno = reason;
    }
    output->beside[0] = '\0';
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

/* -------------------------------------------------------------------------------------------------- state */

void wh_output_state_path(const char *name, char *path, size_t size) {
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    /* The XDG specification has relative paths ignored. */
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
