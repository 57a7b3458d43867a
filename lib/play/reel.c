#include "reel.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/json.h"
#include "../text/output.h"
#include "../text/packed.h"

#define ENGINE "report_engine.html"

/* -------------------------------------------------------------------------------------------------- files */

/* The bytes of a plain file, with a 0 behind them; null and errno if it cannot be read. */
static char *read_file(const char *path, size_t *size) {
    struct stat found;
    FILE *file = stat(path, &found) == 0 && S_ISREG(found.st_mode) ? fopen(path, "rb") : NULL;
    if (!file) {
        return NULL;
    }
    char *text = wh_memory_need(malloc((size_t)found.st_size + 1));
    *size = fread(text, 1, (size_t)found.st_size, file);
    text[*size] = '\0';
    (void)fclose(file);
    return text;
}

/* A file as JSON has it: its text, or its bytes in base 64 if it is no text. */
static json_t *content_of(const char *bytes, size_t size) {
    json_t *text = strlen(bytes) == size ? json_stringn(bytes, size) : NULL;
    if (text) {
        return text;
    }
    char *packed = wh_packed_bytes("", (const uint8_t *)bytes, size);
    json_t *content = wh_json_set(json_object(), "base64 %s", packed);
    free(packed);
    return content;
}

/* ------------------------------------------------------------------------------------------------- engine */

/* The engine's place: beside the program, or where `make install` puts it. */
static void find_engine(char path[4200]) {
    static const char *const places[] = {"/../share/waferhand/" ENGINE, "/playground/" ENGINE};
    char program[4096] = "";
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    char *end = strrchr(program, '/');
    if (end) {
        *end = '\0';
    }
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        (void)snprintf(path, 4200, "%s%s", program, places[i]);
        if (access(path, R_OK) == 0) {
            return;
        }
    }
}

bool wh_reel_open(wh_reel_t *reel, char message[WH_PAGE_MESSAGE_BYTES]) {
    char path[4200];
    size_t size = 0;
    find_engine(path);
    reel->engine = read_file(path, &size);
    if (!reel->engine) {
        (void)snprintf(message, WH_PAGE_MESSAGE_BYTES,
                       "%.400s: %s (expected the engine for a page: `make playground` builds it)", path,
                       strerror(errno));
        return false;
    }
    if (!strstr(reel->engine, "data-version=\"" WH_VERSION "\"")) {
        (void)snprintf(message, WH_PAGE_MESSAGE_BYTES,
                       "%.400s: of another version (expected that of waferhand " WH_VERSION
                       ": `make playground` builds it)",
                       path);
        return false;
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------- inputs */

static void hear(void *user, const char *path) {
    wh_reel_t *reel = user;
    for (size_t i = 0; i < reel->count; ++i) {
        if (strcmp(reel->paths[i], path) == 0) {
            return;
        }
    }
    reel->paths = wh_array_grow(reel->paths, reel->count, &reel->capacity, sizeof *reel->paths);
    reel->paths[reel->count++] = wh_memory_need(strdup(path));
}

void wh_reel_hear(wh_reel_t *reel) {
    wh_output_hear_inputs(hear, reel);
}

static json_t *parameter(const void *run, size_t i) {
    return wh_json_text(((const wh_script_run_options_t *)run)->parameters[i]);
}

static json_t *files_of(const wh_reel_t *reel) {
    json_t *files = json_object();
    for (size_t i = 0; i < reel->count; ++i) {
        size_t size = 0;
        char *bytes = read_file(reel->paths[i], &size);
        if (bytes) {
            wh_json_put(files, reel->paths[i], content_of(bytes, size));
        }
        free(bytes);
    }
    return files;
}

void wh_reel_pack(wh_reel_t *reel, const wh_script_run_options_t *run) {
    json_t *cell = wh_json_set(json_object(), "script %s", run->script);
    (void)wh_json_add(cell, "parameters budget files", wh_json_list(parameter, run, run->parameter_count),
                      wh_json_real((double)run->limits.instructions), files_of(reel), NULL);
    char *text = wh_memory_need(json_dumps(cell, JSON_COMPACT));
    json_decref(cell);
    reel->cell = wh_packed_text(text, strlen(text));
    free(text);
}

void wh_reel_close(wh_reel_t *reel) {
    if (reel->engine) {
        wh_output_hear_inputs(NULL, NULL);
    }
    for (size_t i = 0; i < reel->count; ++i) {
        free(reel->paths[i]);
    }
    free(reel->paths);
    free(reel->engine);
    free(reel->cell);
    *reel = (wh_reel_t){0};
}
