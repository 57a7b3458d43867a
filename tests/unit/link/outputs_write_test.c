/* The writer of outputs.txt, and a reader beside writers that never stop. */
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "link/outputs.h"
#include "support/outputs.h"
#include "support/support.h"

#define WRITES 10000

static const int32_t two[2] = {0, 1};

static void assert_file(const char *path, const char *text) {
    char bytes[64] = "";
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    assert_true(fd >= 0);
    assert_true(read(fd, bytes, sizeof bytes - 1) >= 0);
    close(fd);
    assert_string_equal(bytes, text);
}

static mode_t mode_of(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return status.st_mode & 07777;
}

static void it_writes_a_value_a_line(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_file(f.path, "0\n1\n");
    assert_int_equal(wh_outputs_write(f.path, (const int32_t[]){1, 1, 0, 1, 0, 0, 0, 1}, 8), 0);
    assert_file(f.path, "1\n1\n0\n1\n0\n0\n0\n1\n");
    assert_int_equal(outputs_files(&f), 1);
    outputs_teardown(&f);
}

static void permissions_are_kept_or_usual(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    const mode_t before = umask(027);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(mode_of(f.path), 0640);
    assert_int_equal(chmod(f.path, 0606), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(mode_of(f.path), 0606);
    (void)umask(before);
    outputs_teardown(&f);
}

static void a_link_stays_a_link(void **state) {
    (void)state;
    outputs_fixture_t f;
    struct stat status;
    outputs_setup(&f);
    assert_int_equal(mkdir(outputs_path(&f, "there"), 0777), 0);
    outputs_put(outputs_path(&f, "there/real"), "1");
    assert_int_equal(symlink("there/real", f.path), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
    assert_int_equal(lstat(f.path, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_file(outputs_path(&f, "there/real"), "0\n1\n");
    outputs_teardown(&f);
}

static void what_is_refused_leaves_nothing_behind(void **state) {
    (void)state;
    const int32_t bad[2] = {0, -1};
    outputs_fixture_t f;
    outputs_setup(&f);
    assert_int_equal(wh_outputs_write(NULL, two, 2), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, NULL, 2), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, two, 0), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, two, WH_GRIPPERS + 1), EINVAL);
    assert_int_equal(wh_outputs_write(f.path, bad, 2), EINVAL);
    assert_int_equal(wh_outputs_write(outputs_path(&f, "no/outputs.txt"), two, 2), ENOENT);
    assert_int_equal(wh_outputs_write(outputs_path(&f, ""), two, 2), EINVAL);
    assert_int_equal(outputs_files(&f), 0);
    assert_int_equal(mkdir(f.path, 0777), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), EISDIR);
    assert_int_equal(rmdir(f.path), 0);
    assert_int_equal(mkfifo(f.path, 0666), 0); /* as /dev/null would be */
    assert_int_equal(wh_outputs_write(f.path, two, 2), EINVAL);
    assert_int_equal(wh_outputs_write(outputs_path(&f, "outputs.txt/x"), two, 2), ENOTDIR);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(symlink("outputs.txt", f.path), 0);
    assert_int_equal(wh_outputs_write(f.path, two, 2), ELOOP);
    assert_int_equal(outputs_files(&f), 1);
    outputs_teardown(&f);
}

/* A limit on the size of files stands for a full disk. */
static void a_failed_write_leaves_the_old_file(void **state) {
    (void)state;
    outputs_fixture_t f;
    struct rlimit limit, none;
    outputs_setup(&f);
    outputs_put(f.path, "1 1");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    none = limit;
    for (rlim_t size = 0; size < 4; ++size) {
        none.rlim_cur = size;
        (void)signal(SIGXFSZ, SIG_IGN);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &none), 0);
        const int error = wh_outputs_write(f.path, two, 2);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        assert_int_equal(error, size == 0 ? EFBIG : ENOSPC);
        assert_file(f.path, "1 1");
        assert_int_equal(outputs_files(&f), 1);
    }
    outputs_teardown(&f);
}

/* Temporary files that killed writers left do not stop it, up to a point. */
static void leftovers_are_stepped_over(void **state) {
    (void)state;
    outputs_fixture_t f;
    outputs_setup(&f);
    for (int i = 0; i < 100; ++i) {
        char name[64];
        assert_int_equal(wh_outputs_write(f.path, two, 2), 0);
        snprintf(name, sizeof name, ".waferhand-%ld-%d", (long)getpid(), i);
        outputs_put(outputs_path(&f, name), "");
    }
    assert_int_equal(wh_outputs_write(f.path, two, 2), EEXIST);
    assert_int_equal(outputs_files(&f), 101);
    outputs_teardown(&f);
}

/* ---- beside writers: eight valves, of which only four patterns are ever written, far from each other ----
 */

static const int32_t patterns[4][WH_GRIPPERS] = {
    {0, 0, 0, 0, 0, 0, 0, 0}, {1, 1, 1, 1, 0, 0, 0, 0}, {0, 0, 1, 1, 1, 1, 0, 0}, {1, 1, 0, 0, 1, 1, 1, 1}};

static void write_by_rename(const char *path, const int32_t *valves) {
    if (wh_outputs_write(path, valves, WH_GRIPPERS) != 0) {
        _exit(1);
    }
}

/* As a program with a buffer does: truncate, write once. */
static void write_at_once(const char *path, const int32_t *valves) {
    char text[2 * WH_GRIPPERS];
    for (size_t i = 0; i < WH_GRIPPERS; ++i) {
        text[2 * i] = (char)('0' + valves[i]);
        text[2 * i + 1] = '\n';
    }
    const int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (write(fd, text, sizeof text) != (ssize_t)sizeof text || close(fd) != 0) {
        _exit(1);
    }
}

/* As one without does: truncate, write each value and each line feed on its own. */
static void write_by_byte(const char *path, const int32_t *valves) {
    const int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    for (size_t i = 0; i < WH_GRIPPERS; ++i) {
        const char digit = (char)('0' + valves[i]);
        if (write(fd, &digit, 1) != 1 || write(fd, "\n", 1) != 1) {
            _exit(1);
        }
    }
    close(fd);
}

typedef void (*writer_t)(const char *path, const int32_t *valves);

static pid_t start(writer_t writer, const char *path) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        for (int i = 0; i < WRITES; ++i) {
            writer(path, patterns[i % 4]);
        }
        _exit(0);
    }
    return child;
}

static void assert_is_a_pattern(const int32_t *valves) {
    for (size_t i = 0; i < 4; ++i) {
        if (memcmp(valves, patterns[i], sizeof patterns[i]) == 0) {
            return;
        }
    }
    fail_msg("valves that were never written");
}

static bool has_ended(pid_t child) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    assert_true(ended == 0 || (ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0));
    return ended == child;
}

/* The clock stands still: whatever the machine does meanwhile, no bad state lasts. */
static void hammer(writer_t writer, const char *name) {
    outputs_fixture_t f;
    outputs_setup(&f);
    outputs_put(f.path, "0 0 0 0 0 0 0 0");
    outputs_open(&f, f.path, "00000000");
    assert_int_equal(outputs_update(&f), 0);
    const pid_t child = start(writer, f.path);
    for (bool ended = false; !ended;) {
        struct pollfd waiting = {.fd = f.reader.fd, .events = POLLIN};
        (void)poll(&waiting, 1, 10);
        ended = has_ended(child);
        do {
            (void)outputs_update(&f);
            assert_is_a_pattern(f.reader.valves);
        } while (ended && poll(&waiting, 1, 0) == 1);
    }
    assert_memory_equal(f.reader.valves, patterns[(WRITES - 1) % 4], sizeof patterns[0]);
    assert_int_equal(f.reader.counters.reports, 0);
    const uint64_t looks = outputs_looks(&f.reader), good = f.reader.counters.looks[WH_OUTPUTS_GOOD];
    printf("%s: %llu looks, %.1f %% torn\n", name, (unsigned long long)looks,
           100.0 * (double)(looks - good) / (double)looks);
    assert_true(good > 1 && (writer != write_by_rename || looks == good));
    outputs_teardown(&f);
}

static void writers_by_rename_are_never_torn(void **state) {
    (void)state;
    hammer(write_by_rename, "rename");
}

static void writers_in_place_are_never_believed_half_way(void **state) {
    (void)state;
    hammer(write_at_once, "in place, at once");
    hammer(write_by_byte, "in place, by byte");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_writes_a_value_a_line),
        cmocka_unit_test(permissions_are_kept_or_usual),
        cmocka_unit_test(a_link_stays_a_link),
        cmocka_unit_test(what_is_refused_leaves_nothing_behind),
        cmocka_unit_test(a_failed_write_leaves_the_old_file),
        cmocka_unit_test(leftovers_are_stepped_over),
        cmocka_unit_test(writers_by_rename_are_never_torn),
        cmocka_unit_test(writers_in_place_are_never_believed_half_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
