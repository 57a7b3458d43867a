#include "test_find.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../text/array.h"

/* Folders within folders; deeper ones are refused. */
#define DEEPEST 64

static char *join(const char *folder, const char *name) {
    const size_t length = strlen(folder);
    const size_t room = length + strlen(name) + 2;
    char *path = wh_array_new(room, 1);
    (void)snprintf(path, room, "%s%s%s", folder, length > 0 && folder[length - 1] != '/' ? "/" : "", name);
    return path;
}

/* True if both paths, without links, are in the same folder. */
static bool are_beside(const char *one, const char *other) {
    const char *slash = strrchr(one, '/');
    const size_t length = slash ? (size_t)(slash - one) + 1 : 0;
    return strncmp(one, other, length) == 0 && !strchr(other + length, '/');
}

/* A script's own path, its folder's links followed. A link to a script of another folder is another script:
 * its paths are relative to another folder. Null if there is no such folder. */
static char *own_path(const char *path) {
    const char *slash = strrchr(path, '/');
    char *folder = wh_text_copy(slash ? path : "./");
    char real[PATH_MAX];
    folder[slash ? slash - path + 1 : 2] = '\0';
    char *own = realpath(folder, real) ? join(real, slash ? slash + 1 : path) : NULL;
    if (own && realpath(path, real) && are_beside(own, real)) {
        free(own);
        own = wh_text_copy(real);
    }
    free(folder);
    return own;
}

/* The place of a script among those that are found, or their count. */
static size_t find_script(const wh_test_found_t *found, const char *own) {
    size_t i = 0;
    while (i < found->count && strcmp(found->own[i], own) != 0) {
        ++i;
    }
    return i;
}

void wh_test_found_add(wh_test_found_t *found, const char *path, bool was_found) {
    char *own = own_path(path);
    const size_t place = own ? find_script(found, own) : found->count;
    ++found->named;
    if (place < found->count) {
        found->jobs[place].was_found = found->jobs[place].was_found && was_found;
        free(own);
        return;
    }
    found->own = wh_array_grow(found->own, found->count, &found->own_capacity, sizeof *found->own);
    found->own[found->count] = own ? own : wh_text_copy(path);
    found->jobs = wh_array_grow(found->jobs, found->count, &found->capacity, sizeof *found->jobs);
    found->paths = wh_array_grow(found->paths, found->count, &found->path_capacity, sizeof *found->paths);
    found->paths[found->count] = wh_text_copy(path);
    found->jobs[found->count] = (wh_test_job_t){found->paths[found->count], was_found};
    found->path_count = ++found->count;
}

void wh_test_found_free(wh_test_found_t *found) {
    for (size_t i = 0; i < found->path_count; ++i) {
        free(found->paths[i]);
        free(found->own[i]);
    }
    free(found->paths);
    free(found->own);
    free(found->jobs);
}

static bool refuse_path(const char *path, const char *why) {
    fprintf(stderr, "%s: %s (expected a script, or a folder of scripts)\n", path, why);
    return false;
}

/* By bytes, whatever the locale says. */
static int by_name(const struct dirent **a, const struct dirent **b) {
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int is_shown(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static bool is_lua(const char *name) {
    const size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".lua") == 0;
}

static bool search(wh_test_found_t *found, const char *folder, int depth);

/* A link to a folder is not followed: it may lead back. */
static bool look_at(wh_test_found_t *found, const char *folder, const char *name, int depth) {
    struct stat status;
    char *path = join(folder, name);
    bool taken = true;
    if (lstat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        taken = search(found, path, depth + 1);
    } else if (is_lua(name) && stat(path, &status) != 0) {
        taken = refuse_path(path, strerror(errno));
    } else if (is_lua(name) && !S_ISREG(status.st_mode)) {
        taken =
            refuse_path(path, S_ISDIR(status.st_mode) ? "it is a link to a folder" : "it is no regular file");
    } else if (is_lua(name)) {
        wh_test_found_add(found, path, true);
    }
    free(path);
    return taken;
}

static bool search(wh_test_found_t *found, const char *folder, int depth) {
    struct dirent **entries = NULL;
    const int count = depth > DEEPEST ? -1 : scandir(folder, &entries, is_shown, by_name);
    bool taken = count >= 0;
    if (!taken) {
        (void)refuse_path(folder, depth > DEEPEST ? "it is too deep" : strerror(errno));
    }
    for (int i = 0; i < count; ++i) {
        taken = taken && look_at(found, folder, entries[i]->d_name, depth);
        free(entries[i]);
    }
    free(entries);
    return taken;
}

bool wh_test_find(const wh_option_list_t *paths, wh_test_found_t *found) {
    bool taken = true;
    for (size_t i = 0; taken && i < paths->count; ++i) {
        struct stat status;
        if (stat(paths->items[i], &status) != 0) {
            taken = refuse_path(paths->items[i], strerror(errno));
        } else if (S_ISDIR(status.st_mode)) {
            const size_t before = found->named;
            taken = search(found, paths->items[i], 0);
            if (taken && found->named == before) {
                taken = refuse_path(paths->items[i], "no scripts found");
            }
        } else {
            wh_test_found_add(found, paths->items[i], false);
        }
    }
    if (taken && found->named > found->count) {
        fprintf(stderr, "waferhand test: %zu named again (each script is played once)\n",
                found->named - found->count);
    }
    return taken;
}
