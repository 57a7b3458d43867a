#include "log_files.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../text/array.h"
#include "../wire/slices.h"
#include "record_file.h"

wh_log_head_t wh_log_head(wh_log_t *log) {
    waferhand_recording message;
    wh_log_head_t head = {0};
    if (wh_log_next_event(log) && strcmp(log->channel, WH_CHANNEL_RECORDING) == 0 &&
        wh_link_decode_recording(log->data, log->size, &message)) {
        head = (wh_log_head_t){true, message.version, message.part, message.id};
        (void)waferhand_recording_decode_cleanup(&message);
    }
    return head;
}

static wh_log_head_t head_of(FILE *file) {
    wh_log_t *log = wh_array_new(1, sizeof *log);
    wh_log_open(log, file);
    const wh_log_head_t head = wh_log_head(log);
    wh_log_close(log);
    free(log);
    return head;
}

/* Makes the path of the next part from a part's path. False if it is not the path of a part. */
static bool name_next(const char *path, int32_t part, char next[PATH_MAX]) {
    char tag[20];
    char first[PATH_MAX];
    (void)snprintf(tag, sizeof tag, ".part%d", (int)part);
    const char *folder = strrchr(path, '/');
    const char *own = strstr(folder ? folder : path, tag);
    const size_t before = own ? (size_t)(own - path) : strlen(path);
    if ((part > 1 && !own) || strlen(path) >= sizeof first) {
        return false;
    }
    (void)snprintf(first, sizeof first, "%.*s%s", (int)before, path, part > 1 ? own + strlen(tag) : "");
    (void)snprintf(tag, sizeof tag, "part%d", (int)part + 1);
    return wh_record_file_name(first, tag, next);
}

static bool is_there(const wh_log_files_t *files, FILE *file) {
    struct stat one;
    struct stat other;
    bool found = false;
    for (size_t i = 0; i < files->count && fstat(fileno(file), &one) == 0; ++i) {
        const bool is_known = fstat(fileno(files->files[i]), &other) == 0;
        found = found || (is_known && one.st_dev == other.st_dev && one.st_ino == other.st_ino);
    }
    return found;
}

/* True if this part of this recording is there already: a copy would only repeat it, and repeated slices are
 * not compared. */
static bool has_part(const wh_log_files_t *files, const wh_log_head_t *head) {
    bool found = false;
    for (size_t i = 0; i < files->count; ++i) {
        const wh_log_head_t *other = &files->heads[i];
        found =
            found || (head->is_told && other->is_told && other->id == head->id && other->part == head->part);
    }
    return found;
}

/* Adds a file. Returns the reason why that failed; null: it was added. */
static const char *add(wh_log_files_t *files, const char *path) {
    const char *fault = NULL;
    if (files->count == WH_LOG_FILES) {
        return "more files than can be joined";
    }
    FILE *file = wh_log_file(path, &fault);
    if (!file) {
        return fault;
    }
    const wh_log_head_t head = head_of(file);
    if (is_there(files, file) || has_part(files, &head)) {
        (void)fclose(file);
        return "it is there twice";
    }
    files->heads[files->count] = head;
    files->paths[files->count] = wh_text_copy(path);
    files->files[files->count++] = file;
    return NULL;
}

/* Adds the existing parts after the last file. Returns the reason why that failed; null: all are added. */
static const char *add_parts(wh_log_files_t *files) {
    char next[PATH_MAX];
    struct stat status;
    const char *fault = NULL;
    wh_log_head_t head = files->heads[files->count - 1];
    while (!fault && head.part > 0 && name_next(files->paths[files->count - 1], head.part, next) &&
           stat(next, &status) == 0 && S_ISREG(status.st_mode)) {
        fault = add(files, next);
        const wh_log_head_t found = files->heads[files->count - 1];
        if (!fault && (found.id != head.id || found.part != head.part + 1)) {
            --files->count; /* it belongs to another recording */
            (void)fclose(files->files[files->count]);
            free(files->paths[files->count]);
            break;
        }
        head = found;
    }
    return fault;
}

bool wh_log_files_open(wh_log_files_t *files, const wh_log_names_t *names,
                       char message[WH_LOG_FILES_MESSAGE]) {
    memset(files, 0, sizeof *files);
    files->is_alone = names->is_alone;
    for (size_t i = 0; i <= names->then_count; ++i) {
        const char *path = i == 0 ? names->path : names->then[i - 1];
        const char *fault = add(files, path);
        if (!fault && !names->is_alone) {
            fault = add_parts(files);
        }
        if (fault) {
            (void)snprintf(message, WH_LOG_FILES_MESSAGE, "%.1000s: %s (expected an LCM event log)", path,
                           fault);
            return false;
        }
    }
    return true;
}

void wh_log_files_close(wh_log_files_t *files) {
    for (size_t i = 0; i < files->count; ++i) {
        (void)fclose(files->files[i]);
        free(files->paths[i]);
    }
    files->count = 0;
}

void wh_log_files_begin(const wh_log_files_t *files, wh_log_t *log) {
    wh_log_open(log, files->files[0]);
    log->rest = files->files + 1;
    log->rest_count = files->count - 1;
}
