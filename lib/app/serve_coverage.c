#include "serve_coverage.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "apart.h"

static bool is_name(const char *name, const char *text, size_t size) {
    return strlen(name) == size && memcmp(name, text, size) == 0;
}

/* The counts of an earlier run, which go on. False if the file is not one of ours. */
static bool read_coverage(const char *path, uint64_t shown[]) {
    FILE *in = fopen(path, "re");
    char line[200];
    bool is_ours = true;
    if (!in) {
        return errno == ENOENT;
    }
    while (is_ours && fgets(line, sizeof line, in)) {
        char *name = NULL;
        const long number = strtol(line, &name, 10);
        const char *count = *name == ' ' ? strchr(name + 1, ' ') : NULL;
        is_ours = count && number > 0 && number < WH_HOST_NUMBERS &&
                  is_name(wh_status_name((wh_status_t)number), name + 1, (size_t)(count - name - 1));
        shown[is_ours ? number : 0] += is_ours ? strtoull(count + 1, NULL, 10) : 0;
    }
    (void)fclose(in);
    return is_ours;
}

static bool write_coverage(void *user, FILE *out) {
    const uint64_t *shown = user;
    for (int number = 1; number < WH_HOST_NUMBERS; ++number) {
        const char *name = wh_status_name((wh_status_t)number);
        if (strcmp(name, "UNKNOWN") != 0) {
            fprintf(out, "%d %s %" PRIu64 "\n", number, name, shown[number]);
        }
    }
    return ferror(out) == 0;
}

/* Adds the counts of that text; false if it is no coverage. */
static bool add_coverage(const char *path, uint64_t shown[]) {
    if (!path || read_coverage(path, shown)) {
        return true;
    }
    fprintf(stderr,
            "--coverage %s: no coverage (expected a file of lines such as 42 WAFER_MISSING 3, or none)\n",
            path);
    return false;
}

bool wh_serve_coverage_check(const char *path) {
    uint64_t earlier[WH_HOST_NUMBERS] = {0};
    return add_coverage(path, earlier);
}

bool wh_serve_coverage_keep(const char *path, wh_host_t *host) {
    return !path || (add_coverage(path, host->shown) &&
                     wh_file_write("--coverage", path, write_coverage, host->shown, NULL));
}
