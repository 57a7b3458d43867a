#include "jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/utf8.h"
#include "actions.h"
#include "queue.h"
#include "status.h"

static double seconds_of(const wh_controller_t *controller) {
    const wh_session_t *session = controller->host->session;
    return (double)((wh_session_slice(session) - controller->action.begin_slice) *
                    wh_session_slice_us(session)) /
           1e6;
}

/* The controller whose action still runs, if there is one. */
static wh_controller_t *find_running(const wh_host_t *host) {
    wh_controller_t *running = host->running;
    for (size_t i = 0; i < host->count; ++i) {
        running = host->controllers[i]->action.is_running ? host->controllers[i] : running;
    }
    return running;
}

static bool is_any_running(const wh_host_t *host) {
    return host->running && host->running->action.is_running;
}

/* Actions that were stopped meanwhile end without having begun. While commands run the record cannot drop
 * anything. When it is full, new actions wait until no command runs. */
static bool take_job(void *user, wh_mcs_job_t *job) {
    wh_host_t *host = user;
    wh_controller_t *controller = wh_host_next_action(host);
    while (controller && controller->action.is_stopped) {
        wh_controller_end_unbegun(controller, WH_STATUS_STOPPED, "it waited and was not begun");
        controller = wh_host_next_action(host);
    }
    if (!controller || wh_controller_needs_all(controller) ||
        (is_any_running(host) && wh_session_is_full(host->session))) {
        return false;
    }
    wh_session_renew(host->session);
    controller->action.is_running = controller->action.has_begun = true;
    controller->action.line_number = 0;
    controller->action.line_command = wh_session_record(host->session)->command_count;
    controller->action.ended = WH_OK;
    controller->action.begin_slice = wh_session_slice(host->session);
    host->running = controller;
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    *job = (wh_mcs_job_t){.number = wh_controller_job(controller),
                          .line = controller->action.lines.lines[0],
                          .may_wait = controller->dialect->timing.busy_s > 0,
                          .robot = WH_NONE};
    if (mechanism->kind == WH_MECHANISM_ROBOT) {
        job->robot = mechanism->index;
    } else {
        job->station = mechanism->name;
    }
    return true;
}

static void keep_answer(wh_controller_t *controller, wh_status_t status, const char *answer) {
    const size_t room =
        strlen(answer) + 1 < WH_SESSION_ANSWER_BYTES ? 4 * strlen(answer) + 8 : WH_SESSION_ANSWER_BYTES;
    free(controller->action.ended_text);
    controller->action.ended_text = wh_array_new(room, 1);
    controller->action.ended = status;
    wh_utf8_visible(controller->action.ended_text, room, answer);
}

/* True if the line's own command failed: one that was refused before it began is not in the record. The job's
 * task is the current one. */
static bool has_failed(const wh_controller_t *controller) {
    const wh_record_t *record = wh_session_record(controller->host->session);
    const int32_t task = wh_session_task(controller->host->session);
    bool failed = false;
    for (size_t i = controller->action.line_command; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        failed = failed || (command->task == task && command->error != WH_OK);
    }
    return failed;
}

static void end_action(wh_controller_t *controller, bool failed) {
    wh_host_t *host = controller->host;
    const size_t last = controller->action.lines.count - 1;
    const size_t at = controller->action.line_number < last ? controller->action.line_number : last;
    controller->action.is_running = false;
    if (failed) {
        wh_action_t *told = &controller->leader->action;
        told->failed = controller->action.ended;
        told->failed_order = ++host->so_far.failures;
        (void)snprintf(told->failed_line, sizeof told->failed_line, "%s", controller->action.lines.lines[at]);
    }
    controller->leader->is_held = false;
    host->running = find_running(host);
    wh_controller_end(controller, controller->action.ended, controller->action.ended_text,
                      seconds_of(controller));
}

/* The controller whose action this job is. */
static wh_controller_t *find_of_job(const wh_host_t *host, int32_t job) {
    size_t i = 0;
    while (!host->controllers[i]->action.is_running || wh_controller_job(host->controllers[i]) != job) {
        ++i;
    }
    return host->controllers[i];
}

/* After a CLEAR it waits for a slice, with which the fault ends; nobody hears the answer of that wait. */
static const char *end_job_line(void *user, int32_t job, wh_status_t status, const char *answer) {
    wh_host_t *host = user;
    wh_controller_t *controller = find_of_job(host, job);
    const size_t last = controller->action.lines.count - 1;
    if (controller->action.line_number <= last) {
        keep_answer(controller, status, answer);
    }
    if (status == WH_OK && controller->action.line_number < last) {
        controller->action.line_command = wh_session_record(host->session)->command_count;
        return controller->action.lines.lines[++controller->action.line_number];
    }
    if (status == WH_OK && controller->action.line_number == last &&
        wh_word_of(controller->action.lines.lines[last]) == wh_word_of("CLEAR")) {
        char *line = controller->action.wait_line;
        (void)snprintf(line, sizeof controller->action.wait_line, "WAIT %.6f",
                       (double)wh_session_slice_us(host->session) / 1e6);
        ++controller->action.line_number;
        return line;
    }
    end_action(controller, controller->action.ended != WH_OK && has_failed(controller));
    return NULL;
}

void wh_host_play_jobs(wh_host_t *host) {
    char *text = host->texts->played;
    const wh_mcs_jobs_t jobs = {take_job, end_job_line, host};
    wh_host_begin_clock(host, wh_host_next_action(host));
    const wh_status_t status = wh_session_play(host->session, &jobs, text, WH_SESSION_ANSWER_BYTES);
    wh_host_heed_stop(host, status);
    for (size_t i = 0; i < host->count; ++i) {
        if (host->controllers[i]->action.is_running) {
            keep_answer(host->controllers[i], status, text);
            end_action(host->controllers[i], status != WH_OK);
        }
    }
    host->running = NULL;
}
