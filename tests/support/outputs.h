/* Shared by the tests of outputs.txt: a folder of their own, a reader with a clock that the test
 * moves, and the checks that hold after every update. */
#ifndef WH_TESTS_SUPPORT_OUTPUTS_H
#define WH_TESTS_SUPPORT_OUTPUTS_H

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <sys/stat.h>
#include <unistd.h>

#include "link/outputs.h"
#include "support/support.h"

typedef struct {
    char folder[128], path[160];
    wh_outputs_t reader;
    int64_t now_us;
    unsigned reports; /* that updates returned */
} outputs_fixture_t;

static inline int outputs_remove_one(const char *path, const struct stat *status, int type,
                                     struct FTW *where) {
    (void)status;
    (void)type;
    (void)where;
    return remove(path);
}

/* In memory unless TMPDIR says otherwise: there are thousands of files, and each would make a disk
 * write. */
static inline void outputs_setup(outputs_fixture_t *f) {
    const char *const wanted = getenv("TMPDIR");
    const char *const usual = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    memset(f, 0, sizeof *f);
    f->reader.fd = -1; /* not open yet */
    snprintf(f->folder, sizeof f->folder, "%s/outputs_test.XXXXXX", wanted != NULL ? wanted : usual);
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->path, sizeof f->path, "%s/outputs.txt", f->folder);
}

static inline void outputs_teardown(outputs_fixture_t *f) {
    wh_outputs_close(&f->reader);
    assert_int_equal(nftw(f->folder, outputs_remove_one, 8, FTW_DEPTH | FTW_PHYS), 0);
}

/* The path of a file of the folder, in memory that the fourth call from now uses again. */
static inline const char *outputs_path(const outputs_fixture_t *f, const char *name) {
    static char paths[4][256];
    static unsigned next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", f->folder, name);
    return path;
}

/* Writes `size` bytes in place: the file is truncated, then written at once. */
static inline void outputs_put_bytes(const char *path, const void *bytes, size_t size) {
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, bytes, size), size);
    assert_int_equal(close(fd), 0);
}

static inline void outputs_put(const char *path, const char *text) {
    outputs_put_bytes(path, text, strlen(text));
}

static inline void outputs_check_counters(const wh_outputs_t *reader) {
    const wh_outputs_counters_t *c = &reader->counters;
    assert_int_equal(c->spells, c->torn + c->reports - c->recoveries + reader->suspect);
    assert_true(c->switches <= c->looks[WH_OUTPUTS_GOOD] && c->recoveries <= c->looks[WH_OUTPUTS_GOOD]);
}

static inline uint64_t outputs_looks(const wh_outputs_t *reader) {
    uint64_t looks = 0;
    for (int i = 0; i < WH_OUTPUTS_FINDINGS; ++i) {
        looks += reader->counters.looks[i];
    }
    return looks;
}

/* Updates now; the returned result agrees with the change. */
static inline unsigned outputs_update(outputs_fixture_t *f) {
    const wh_outputs_t before = f->reader;
    const unsigned result = wh_outputs_update(&f->reader, f->now_us);
    const bool reported = (result & WH_OUTPUTS_REPORTED) != 0;
    const bool switched = (result & WH_OUTPUTS_SWITCHED) != 0;
    f->reports += reported;
    assert_int_equal(f->reader.counters.reports, f->reports);
    assert_int_equal(reported, f->reader.finding != before.finding);
    assert_int_equal(switched, memcmp(f->reader.valves, before.valves, sizeof before.valves) != 0);
    assert_true(outputs_looks(&f->reader) - outputs_looks(&before) <= 1);
    assert_true(f->reader.due_us > f->now_us);
    outputs_check_counters(&f->reader);
    return result;
}

/* Lets time pass, and updates whenever the reader asks for it. Returns all results or-ed. */
static inline unsigned outputs_pass(outputs_fixture_t *f, int64_t us) {
    const int64_t end_us = f->now_us + us;
    unsigned result = outputs_update(f);
    while (f->reader.due_us <= end_us) {
        f->now_us = f->reader.due_us;
        result |= outputs_update(f);
    }
    f->now_us = end_us;
    return result | outputs_update(f);
}

static inline void outputs_assert_valves(const outputs_fixture_t *f, const char *valves) {
    assert_int_equal(f->reader.count, strlen(valves));
    for (size_t i = 0; i < f->reader.count; ++i) {
        assert_int_equal(f->reader.valves[i], valves[i] - '0');
    }
}

/* A reader with as many valves as the text has digits. */
static inline void outputs_open(outputs_fixture_t *f, const char *path, const char *valves) {
    int32_t values[WH_GRIPPERS];
    for (size_t i = 0; valves[i] != '\0'; ++i) {
        values[i] = valves[i] - '0';
    }
    assert_int_equal(wh_outputs_open(&f->reader, path, values, strlen(valves)), 0);
    f->reports = 0;
}

/* The usual start: the file says 0 1, and the reader has seen it. */
static inline void outputs_begin(outputs_fixture_t *f) {
    outputs_setup(f);
    outputs_put(f->path, "0 1\n");
    outputs_open(f, f->path, "11");
    assert_int_equal(outputs_update(f), WH_OUTPUTS_SWITCHED);
    outputs_assert_valves(f, "01");
}

/* The number of files in the folder. */
static inline int outputs_files(const outputs_fixture_t *f) {
    DIR *folder = opendir(f->folder);
    assert_non_null(folder);
    int files = 0;
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        files += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    }
    closedir(folder);
    return files;
}

#endif
