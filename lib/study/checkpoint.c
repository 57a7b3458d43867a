#include "checkpoint.h"

#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../math/hash.h"
#include "../text/output.h"
#include "checkpoint_internal.h"

/* --------------------------------------------------------------------------------------------------------- file */

bool wh_checkpoint_save(const char *path, const char *text) {
    wh_output_t output = {0};
    if (!wh_output_open(&output, path)) {
        return false;
    }
    (void)fputs(text, output.file);
    return wh_output_commit(&output);
}

/* All of a file; null, with errno, when it cannot be read. */
static char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "r");
    char *text = NULL;
    size_t capacity = 0;
    size_t got = 1;
    *size = 0;
    while (file && got > 0) {
        if (*size == capacity) {
            capacity = capacity > 0 ? 2 * capacity : 65536;
            char *grown = realloc(text, capacity);
            if (!grown) {
                abort();
            }
            text = grown;
        }
        got = fread(text + *size, 1, capacity - *size, file);
        *size += got;
    }
    if (file && ferror(file)) {
        free(text);
        text = NULL;
    }
    if (file) {
        const int reason = errno;
        fclose(file);
        errno = reason;
    }
    return text;
}

wh_checkpoint_found_t wh_checkpoint_load(const char *path, const wh_study_t *study, wh_progress_t *progress) {
    char message[1024] = "";
    size_t size = 0;
    char *text = read_file(path, &size);
    if (!text) {
        if (errno == ENOENT) {
            return WH_STATE_NONE;
        }
        fprintf(stderr, "%s: %s (expected a file that can be read)\n", path, strerror(errno));
        return WH_STATE_REFUSED;
    }
    const bool read = wh_checkpoint_read(study, text, size, progress, message, sizeof message);
    free(text);
    if (!read) {
        fprintf(stderr, "%s: %s\n", path, message);
    }
    return read ? WH_STATE_READ : WH_STATE_REFUSED;
}

/* ------------------------------------------------------------------------------------------------------- default */

static uint64_t hash_text(uint64_t hash, const char *text) {
    for (const char *c = text; *c; ++c) {
        hash = wh_hash_word(hash, (unsigned char)*c);
    }
    return wh_hash_word(hash, 0);
}

static bool make_folder(const char *path) {
    return mkdir(path, 0777) == 0 || errno == EEXIST;
}

/* The folder to keep states in, with the ones above it. */
static bool find_folder(char *folder, size_t size) {
    const char *state = getenv("XDG_STATE_HOME");
    const char *home = getenv("HOME");
    if (state && state[0] == '/') {
        snprintf(folder, size, "%s", state);
        return make_folder(folder);
    }
    if (!home || home[0] != '/') {
        return false;
    }
    snprintf(folder, size, "%s/.local", home);
    if (!make_folder(folder)) {
        return false;
    }
    snprintf(folder, size, "%s/.local/state", home);
    return make_folder(folder);
}

char *wh_checkpoint_default_path(const wh_study_t *study) {
    char folder[3900];
    char path[4096];
    json_t *identity = wh_checkpoint_identity(study);
    char *text = identity ? json_dumps(identity, JSON_COMPACT) : NULL;
    json_decref(identity);
    if (!text || !find_folder(folder, sizeof folder)) {
        free(text);
        return NULL;
    }
    const uint64_t hash = hash_text(WH_HASH_START, text);
    free(text);
    snprintf(path, sizeof path, "%s/waferhand", folder);
    if (!make_folder(path)) {
        return NULL;
    }
    snprintf(path, sizeof path, "%s/waferhand/study-%016llx", folder, (unsigned long long)hash);
    return wh_record_text(path);
}
