#include "plots.h"

#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../record/record.h"
#include "../text/array.h"
#include "../text/output.h"
#include "plots_internal.h"

extern char **environ;

/* The plots are made in this folder within the target folder, because renaming works within a file system
 * only. */
#define FOLDER "/.plots.XXXXXX"
#define PATH_BYTES 4096

static const char *const endings[] = {"dat", "gp", "svg"};
#define ENDINGS (sizeof endings / sizeof endings[0])

/* The path of file `i` of all plots, in a folder. False if it is too long. */
static bool path_of(const wh_plots_t *plots, size_t i, const char *folder, char path[PATH_BYTES]) {
    errno = ENAMETOOLONG;
    return snprintf(path, PATH_BYTES, "%s/%s.%s", folder, plots->names[i / ENDINGS], endings[i % ENDINGS]) <
           PATH_BYTES;
}

/* -------------------------------------------------------------------------------------------------- files */

static bool is_taken(const wh_plots_t *plots, const char *name) {
    for (size_t i = 0; i < plots->count; ++i) {
        if (strcmp(plots->names[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/* Makes a name that a shell, LaTeX and every system accept. If two names become equal, the second gets a
 * number. */
static void choose_name(const wh_plots_t *plots, char name[WH_PLOT_NAME_BYTES], const char *stem,
                        const char *of) {
    (void)snprintf(name, WH_PLOT_NAME_BYTES - 20, "%s%s%s", stem, of ? "_" : "", of ? of : "");
    for (char *c = name; *c; ++c) {
        if (!strchr("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-", *c)) {
            *c = '_';
        }
    }
    const size_t length = strlen(name);
    for (int i = 2; is_taken(plots, name); ++i) {
        (void)snprintf(name + length, WH_PLOT_NAME_BYTES - length, "_%d", i);
    }
}

static FILE *open_file(const wh_plots_t *plots, size_t i) {
    char path[PATH_BYTES];
    return path_of(plots, i, plots->folder, path) ? fopen(path, "wb") : NULL;
}

static void close_file(wh_plots_t *plots, FILE *file) {
    const bool failed = file && ferror(file);
    if (file && (fclose(file) != 0 || failed) && plots->error == 0) {
        plots->error = errno ? errno : EIO;
    }
}

bool wh_plots_open(wh_plots_t *plots, wh_plot_t *plot, const char *name, const char *of) {
    if (plots->error != 0) {
        return false;
    }
    memset(plot, 0, sizeof *plot);
    choose_name(plots, plot->name, name, of);
    plots->names = wh_array_grow(plots->names, plots->count, &plots->capacity, sizeof *plots->names);
    memcpy(plots->names[plots->count], plot->name, sizeof plot->name);
    plot->data = open_file(plots, plots->count * ENDINGS);
    plot->script = plot->data ? open_file(plots, plots->count * ENDINGS + 1) : NULL;
    ++plots->count;
    if (!plot->script) {
        plots->error = errno;
        close_file(plots, plot->data);
    }
    return plot->script != NULL;
}

void wh_plots_close(wh_plots_t *plots, wh_plot_t *plot) {
    fputs("unset multiplot\nset output\n", plot->script);
    close_file(plots, plot->script);
    close_file(plots, plot->data);
}

/* ---------------------------------------------------------------------------------------------------- run */

/* A gripper holds one wafer at a time, so its stays end in the order in which they begin. */
wh_plot_hold_t *wh_plots_holds(const wh_plots_t *plots, int32_t gripper, size_t *count) {
    const wh_signals_t *signals = plots->document->signals;
    wh_plot_hold_t *list = NULL;
    wh_plot_hold_t *last = NULL;
    size_t capacity = 0;
    bool holds = false;
    *count = 0;
    for (size_t i = 0; i < signals->stay_count; ++i) {
        const wh_stay_t *stay = &signals->stays[i];
        const double at = wh_signals_seconds(signals, stay->slice);
        if (holds && (stay->wafer == last->wafer || stay->holder == gripper)) {
            last->end_s = at;
            holds = false;
        }
        if (stay->holder != gripper) {
            continue;
        }
        /* If it holds that wafer again at once, the hold goes on. */
        if (!last || last->wafer != stay->wafer || at > last->end_s) {
            list = wh_array_grow(list, *count, &capacity, sizeof *list);
            last = &list[(*count)++];
            *last = (wh_plot_hold_t){at, at, stay->wafer};
        }
        holds = true;
    }
    if (holds) {
        last->end_s = plots->end_s;
    }
    return list;
}

/* ------------------------------------------------------------------------------------------------ gnuplot */

/* The plots are UTF-8, and gnuplot asks the locale for that. Sets LC_ALL, or removes it for null. Returns
 * what was there, to be freed; null if nothing was. */
static char *set_letters(const char *letters) {
    const char *before = getenv("LC_ALL");
    char *kept = before ? wh_text_copy(before) : NULL;
    if (!letters || setenv("LC_ALL", letters, 1) != 0) {
        (void)unsetenv("LC_ALL");
    }
    return kept;
}

/* Runs gnuplot in the plots' folder. Returns 0, an errno if it did not start, or -1 if gnuplot itself
 * reported the error. */
static int start(const wh_plots_t *plots, char *const arguments[]) {
    posix_spawn_file_actions_t actions;
    pid_t process = 0;
    int status = 0;
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0) {
        return error;
    }
    char *letters = set_letters("C.UTF-8");
    error = posix_spawn_file_actions_addchdir_np(&actions, plots->folder);
    if (error == 0) {
        error = posix_spawnp(&process, arguments[0], &actions, NULL, arguments, environ);
    }
    free(set_letters(letters));
    free(letters);
    (void)posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        return error;
    }
    while (waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) {
            return errno;
        }
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : -1;
}

static bool draw(const wh_plots_t *plots, const char *name, char message[WH_PLOTS_MESSAGE_BYTES]) {
    char program[] = "gnuplot";
    char plain[] = "-d";
    char script[WH_PLOT_NAME_BYTES + 4];
    char *const arguments[] = {program, plain, script, NULL};
    (void)snprintf(script, sizeof script, "%s.gp", name);
    const int error = start(plots, arguments);
    if (error > 0) {
        (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES,
                       "gnuplot: %s (expected the program of Debian's package gnuplot-nox: apt-get install "
                       "gnuplot-nox)",
                       strerror(error));
    } else if (error < 0) {
        (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES, "gnuplot could not draw %s", name);
    }
    return error == 0;
}

/* ------------------------------------------------------------------------------------------------ placing */

static bool refuse_plot(const wh_plots_t *plots, size_t i, const char *why,
                        char message[WH_PLOTS_MESSAGE_BYTES]) {
    (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES, "%s.%s: %s", plots->names[i / ENDINGS],
                   endings[i % ENDINGS], why);
    return false;
}

/* No file is placed if one of them is an input or another output. */
static bool is_free(const wh_plots_t *plots, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]) {
    char to[PATH_BYTES];
    for (size_t i = 0; i < plots->count * ENDINGS; ++i) {
        if (path_of(plots, i, folder, to) && wh_output_is_kept(to)) {
            return refuse_plot(plots, i, WH_OUTPUT_KEPT, message);
        }
    }
    return true;
}

static bool place(const wh_plots_t *plots, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]) {
    char from[PATH_BYTES];
    char to[PATH_BYTES];
    for (size_t i = 0; i < plots->count * ENDINGS; ++i) {
        if (!path_of(plots, i, plots->folder, from) || !path_of(plots, i, folder, to) ||
            rename(from, to) != 0) {
            return refuse_plot(plots, i, strerror(errno), message);
        }
    }
    return true;
}

static void clear(const wh_plots_t *plots) {
    char path[PATH_BYTES];
    for (size_t i = 0; i < plots->count * ENDINGS; ++i) {
        if (path_of(plots, i, plots->folder, path)) {
            (void)unlink(path);
        }
    }
    (void)rmdir(plots->folder);
}

/* Plots of a cell with slices. */
static void make_cell(wh_plots_t *plots) {
    if (plots->end_s > plots->begin_s) {
        wh_plots_proximity(plots);
        wh_plots_signals(plots);
        wh_plots_holders(plots);
        wh_plots_commands(plots);
        wh_plots_axes(plots);
        wh_plots_clearances(plots);
    }
    wh_plots_offsets(plots);
    wh_plots_scans(plots);
    wh_plots_centrings(plots);
}

static bool make(wh_plots_t *plots, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]) {
    if (plots->document->signals) {
        make_cell(plots);
    }
    wh_plots_flow(plots);
    wh_plots_shares(plots);
    if (plots->error != 0) {
        (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES, "%s", strerror(plots->error));
        return false;
    }
    if (plots->count == 0) {
        (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES, "nothing to draw (expected a run that takes time)");
        return false;
    }
    bool drawn = true;
    for (size_t i = 0; drawn && i < plots->count; ++i) {
        drawn = draw(plots, plots->names[i], message);
    }
    return drawn && is_free(plots, folder, message) && place(plots, folder, message);
}

static bool make_within(const wh_document_t *document, const char *folder,
                        char message[WH_PLOTS_MESSAGE_BYTES]) {
    char within[PATH_BYTES];
    errno = ENAMETOOLONG;
    if ((size_t)snprintf(within, sizeof within, "%s%s", folder, FOLDER) >= sizeof within ||
        !mkdtemp(within)) {
        (void)snprintf(message, WH_PLOTS_MESSAGE_BYTES, "%s (expected a folder that can be written to)",
                       strerror(errno));
        return false;
    }
    const wh_signals_t *signals = document->signals;
    wh_plots_t plots = {.document = document, .folder = within};
    if (signals) {
        plots.begin_s = signals->first > 0 ? wh_signals_seconds(signals, signals->first) : 0;
        plots.end_s = signals->last > 0 ? wh_signals_seconds(signals, signals->last) : 0;
    } else {
        plots.end_s = document->record->simulated_s;
    }
    const bool made = make(&plots, folder, message);
    clear(&plots);
    free(plots.names);
    return made;
}

bool wh_plots_write(const wh_document_t *document, const char *folder, char message[WH_PLOTS_MESSAGE_BYTES]) {
    const bool is_new = mkdir(folder, 0777) == 0;
    const bool made = make_within(document, folder, message);
    if (!made && is_new) {
        (void)rmdir(folder);
    }
    return made;
}
