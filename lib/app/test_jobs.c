#include "test_jobs.h"

#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "../text/output.h"

/* A longer list ends in "...". */
#define NEVER_CAME_BYTES 2000

/* The message of a script's process when it has ended: fewer bytes than a pipe takes at once. */
typedef struct {
    wh_test_verdict_t verdict;
    size_t reads; /* the output that it reads, from 1; 0: none */
    uint64_t expectations, errors;
    double simulated_s;
    uint64_t hash;
    bool is_unlooked, is_timed, has_timed, is_cut;
    char reason[WH_SANDBOX_MESSAGE_BYTES + 80];
    char never_came[NEVER_CAME_BYTES]; /* empty: all faults came */
} told_t;

/* A script that is being played. */
typedef struct {
    pid_t pid; /* 0: none */
    size_t job;
    int answer; /* the end of the pipe that is read */
    FILE *output;
    double begin;
    bool is_late;
} player_t;

typedef struct {
    const wh_test_options_t *options;
    const wh_test_job_t *jobs;
    size_t count, begun, ended, told;
    wh_test_result_t *results;
    bool *is_done;
    player_t *players;
    bool failed;
} crew_t;

/* ----------------------------------------------------------------------------------------- in the process */

static void judge_script(const wh_script_run_t *run, wh_script_run_outcome_t outcome,
                         const wh_test_job_t *job, bool needs_expectations, told_t *told) {
    const wh_record_t *record = &run->record;
    if (outcome == WH_RUN_BAD_INPUT) {
        told->verdict = job->was_found && run->is_no_script ? WH_TEST_PASSED_OVER : WH_TEST_BAD;
        (void)snprintf(told->reason, sizeof told->reason, "%.1023s", run->message);
    } else if (outcome == WH_RUN_FAILED) {
        told->verdict = WH_TEST_FAILED;
        wh_record_reason(record, told->reason, sizeof told->reason);
    } else if (wh_record_kept_still(record) && wh_record_expectations(record) == 0) {
        told->verdict = WH_TEST_FAILED;
        (void)snprintf(told->reason, sizeof told->reason, "%s", WH_RECORD_IDLE);
    } else if (needs_expectations && wh_record_expectations(record) == 0) {
        told->verdict = WH_TEST_FAILED;
        (void)snprintf(told->reason, sizeof told->reason, "it expects nothing (--require-expectations)");
    }
}

static void tell_never_came(const wh_record_t *record, told_t *told) {
    const char *list = record->never_came ? record->never_came : "";
    const bool is_cut = strlen(list) >= sizeof told->never_came;
    (void)snprintf(told->never_came, sizeof told->never_came, "%.*s%s", NEVER_CAME_BYTES - 4, list,
                   is_cut ? "..." : "");
}

/* Does not return: the process ends as a script's run does. */
static void play(const crew_t *crew, const wh_test_job_t *job, int answer) {
    wh_script_run_options_t options = crew->options->run;
    wh_script_run_t run;
    told_t told;
    memset(&told, 0, sizeof told);
    options.script = job->path;
    options.limits.print_to = stdout;
    options.drops_rows = true;
    options.keeps = WH_FLOW_PATH;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &options);
    judge_script(&run, outcome, job, crew->options->needs_expectations, &told);
    told.hash = run.record.hash;
    told.expectations = wh_record_expectations(&run.record);
    told.errors = wh_record_errors(&run.record);
    told.simulated_s = run.record.simulated_s;
    told.is_unlooked = outcome != WH_RUN_BAD_INPUT && run.record.unlooked;
    tell_never_came(&run.record, &told);
    told.is_timed = told.is_unlooked && wh_record_is_timed(&run.record);
    told.has_timed = outcome != WH_RUN_BAD_INPUT && run.record.times_alone;
    told.is_cut = outcome != WH_RUN_BAD_INPUT && run.record.flow && wh_flow_is_cut(run.record.flow);
    for (size_t i = 0; i < WH_TEST_OUTPUTS; ++i) {
        const char *output = crew->options->outputs[i];
        told.reads = output && wh_output_is_kept(output) ? i + 1 : told.reads;
    }
    (void)fflush(stdout);
    (void)fflush(stderr);
    const bool has_told = write(answer, &told, sizeof told) == (ssize_t)sizeof told;
    _exit(has_told ? 0 : 1);
}

/* Runs in the script's process: it ends with this one, and its output goes into a file. */
static void settle(const crew_t *crew, const wh_test_job_t *job, int answer, FILE *output, pid_t parent) {
    const struct rlimit limit = {WH_TEST_OUTPUT_BYTES, WH_TEST_OUTPUT_BYTES};
    sigset_t none;
    sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, NULL);
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent ||
        setrlimit(RLIMIT_FSIZE, &limit) != 0 || dup2(fileno(output), STDOUT_FILENO) < 0 ||
        dup2(fileno(output), STDERR_FILENO) < 0) {
        _exit(1);
    }
    play(crew, job, answer);
}

/* --------------------------------------------------------------------------------------- from the outside */

/* Makes a file for a script's output, and a pipe for its process's message; null, and no pipe, if the system
 * refuses. */
static FILE *make_ends(int ends[2]) {
    FILE *output = pipe(ends) == 0 ? tmpfile() : NULL;
    if (!output) {
        perror("waferhand test: no room for what a script prints");
        (void)close(ends[0]);
        (void)close(ends[1]);
    }
    return output;
}

static bool begin_job(crew_t *crew, player_t *player) {
    int ends[2] = {-1, -1};
    const pid_t parent = getpid();
    *player = (player_t){.job = crew->begun, .begin = wh_clock_seconds()};
    player->output = make_ends(ends);
    if (!player->output) {
        return false;
    }
    (void)fflush(stdout);
    (void)fflush(stderr);
    const pid_t pid = fork();
    if (pid == 0) {
        (void)close(ends[0]);
        settle(crew, &crew->jobs[crew->begun], ends[1], player->output, parent);
    }
    (void)close(ends[1]);
    if (pid < 0) {
        perror("waferhand test: no process");
        (void)close(ends[0]);
        (void)fclose(player->output);
        return false;
    }
    player->pid = pid;
    player->answer = ends[0];
    ++crew->begun;
    return true;
}

/* All of it; null: nothing. */
static char *read_output(FILE *file) {
    if (fseek(file, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long size = ftell(file);
    char *text = size > 0 ? wh_array_new((size_t)size + 1, 1) : NULL;
    rewind(file);
    if (text) {
        const size_t got = fread(text, 1, (size_t)size, file);
        for (size_t i = 0; i < got; ++i) {
            text[i] = text[i] == '\0' ? ' ' : text[i];
        }
    }
    return text;
}

__attribute__((format(printf, 2, 3))) static void explain(wh_test_result_t *result, const char *format, ...) {
    char text[200];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    free(result->reason);
    result->reason = wh_text_copy(text);
}

static void take_end(const crew_t *crew, const player_t *player, int status, const told_t *told,
                     wh_test_result_t *result) {
    if (player->is_late) {
        result->verdict = WH_TEST_ENDLESS;
        explain(result, "it did not end within %g s", crew->options->timeout_s);
    } else if (WIFSIGNALED(status)) {
        result->verdict = WH_TEST_KILLED;
        explain(result, "signal %d (%s) ended it%s", WTERMSIG(status), strsignal(WTERMSIG(status)),
                WTERMSIG(status) == SIGXFSZ ? ", as it printed more than 16 MiB" : "");
    } else if (!told) {
        result->verdict = WH_TEST_BAD;
        explain(result, "its process ended with status %d and told nothing", WEXITSTATUS(status));
    } else {
        result->verdict = told->verdict;
        result->reason = told->reason[0] != '\0' ? wh_text_copy(told->reason) : NULL;
        result->expectations = told->expectations;
        result->errors = told->errors;
        result->simulated_s = told->simulated_s;
        result->hash = told->hash;
        result->is_unlooked = told->is_unlooked;
        result->never_came = told->never_came[0] != '\0' ? wh_text_copy(told->never_came) : NULL;
        result->is_timed = told->is_timed;
        result->has_timed = told->has_timed;
        result->is_cut = told->is_cut;
    }
}

static void tell_results(crew_t *crew) {
    while (crew->told < crew->count && crew->is_done[crew->told]) {
        crew->options->listener(crew->options->user, &crew->results[crew->told++]);
    }
}

static void end(crew_t *crew, player_t *player, int status) {
    told_t told;
    wh_test_result_t *result = &crew->results[player->job];
    const bool has_told = read(player->answer, &told, sizeof told) == (ssize_t)sizeof told;
    *result = (wh_test_result_t){.path = crew->jobs[player->job].path,
                                 .output = read_output(player->output),
                                 .wall_s = wh_clock_seconds() - player->begin};
    take_end(crew, player, status, has_told ? &told : NULL, result);
    if (has_told && told.reads > 0) {
        fprintf(stderr, "%s: %s reads it: it is not written (expected a file of its own)\n",
                crew->options->outputs[told.reads - 1], result->path);
        crew->failed = true;
    }
    (void)close(player->answer);
    (void)fclose(player->output);
    player->pid = 0;
    crew->is_done[player->job] = true;
    ++crew->ended;
    tell_results(crew);
}

/* Takes the results of ended scripts, and ends late ones. Returns the seconds until the next one is late. */
static double look(crew_t *crew) {
    double wait = 1;
    for (size_t i = 0; i < crew->options->processes; ++i) {
        player_t *player = &crew->players[i];
        int status = 0;
        if (player->pid > 0 && waitpid(player->pid, &status, WNOHANG) == player->pid) {
            end(crew, player, status);
        } else if (player->pid > 0) {
            const double left = player->begin + crew->options->timeout_s - wh_clock_seconds();
            if (left <= 0 && !player->is_late) {
                player->is_late = kill(player->pid, SIGKILL) == 0;
            }
            wait = left < wait ? left : wait;
        }
    }
    return wait > 1e-3 ? wait : 1e-3;
}

static void stop_all(crew_t *crew) {
    for (size_t i = 0; i < crew->options->processes; ++i) {
        player_t *player = &crew->players[i];
        if (player->pid > 0) {
            (void)kill(player->pid, SIGKILL);
            (void)waitpid(player->pid, NULL, 0);
            (void)close(player->answer);
            (void)fclose(player->output);
        }
    }
}

static void play_all(crew_t *crew, const sigset_t *children) {
    const size_t most = crew->options->processes;
    while (!crew->failed && crew->ended < crew->count) {
        for (size_t i = 0; !crew->failed && i < most && crew->begun < crew->count; ++i) {
            crew->failed = crew->players[i].pid == 0 && !begin_job(crew, &crew->players[i]);
        }
        const size_t before = crew->ended;
        const double wait = look(crew);
        if (crew->ended == before) {
            const struct timespec time = {(time_t)wait, (long)((wait - (double)(time_t)wait) * 1e9)};
            (void)sigtimedwait(children, NULL, &time);
        }
    }
    stop_all(crew);
}

bool wh_test_play(const wh_test_job_t jobs[], size_t count, const wh_test_options_t *options,
                  wh_test_result_t results[]) {
    crew_t crew = {.options = options, .jobs = jobs, .count = count, .results = results};
    sigset_t children;
    sigset_t before;
    crew.is_done = wh_array_new(count, sizeof *crew.is_done);
    crew.players = wh_array_new(options->processes, sizeof *crew.players);
    sigemptyset(&children);
    sigaddset(&children, SIGCHLD);
    (void)sigprocmask(SIG_BLOCK, &children, &before); /* so that an end is not missed before the wait */
    play_all(&crew, &children);
    (void)sigprocmask(SIG_SETMASK, &before, NULL);
    free(crew.is_done);
    free(crew.players);
    return !crew.failed;
}

void wh_test_results_free(wh_test_result_t results[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        free(results[i].reason);
        free(results[i].output);
        free(results[i].never_came);
    }
}
