/* Several ports: their actions are played side by side, as jobs of a session. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/utf8.h"
#include "host.h"
#include "values.h"

/* A job's number is one more than its port's. */
static int32_t job_of(const wh_controller_t *controller) {
    return (int32_t)controller->number + 1;
}

bool wh_host_plays_jobs(const wh_host_t *host) {
    return host->count > 1 || host->controllers[0]->mechanism.name;
}

bool wh_controller_waits(const wh_controller_t *controller) {
    return controller->is_running && wh_mcs_job_waits(&controller->host->session->mcs, job_of(controller));
}

void wh_controller_end_job(wh_controller_t *controller, wh_status_t status, const char *why) {
    wh_mcs_end_job(&controller->host->session->mcs, job_of(controller), status, why);
}

bool wh_host_is_stopped(const wh_host_t *host) {
    bool is_any = host->session->mcs.stop_requested;
    bool is_all = true;
    for (size_t i = 0; i < host->count; ++i) {
        const wh_controller_t *controller = host->controllers[i];
        is_any = is_any || (controller->is_running && controller->is_stopped);
        is_all = is_all && (!controller->is_running || controller->is_stopped);
    }
    return is_any && is_all;
}

static double seconds_of(const wh_controller_t *controller) {
    const wh_track_t *track = &controller->host->session->mcs.track;
    return (double)((track->slice - controller->begin_slice) * track->slice_us) / 1e6;
}

/* What still runs, if anything does. */
static wh_controller_t *find_running(const wh_host_t *host) {
    wh_controller_t *running = host->running;
    for (size_t i = 0; i < host->count; ++i) {
        running = host->controllers[i]->is_running ? host->controllers[i] : running;
    }
    return running;
}

static bool is_any_running(const wh_host_t *host) {
    return host->running && host->running->is_running;
}

/* Those that were stopped meanwhile end unbegun. While commands run the record cannot forget: when it is
 * full, what comes waits until there is none. */
static bool take(void *user, wh_mcs_job_t *job) {
    wh_host_t *host = user;
    wh_controller_t *controller = wh_host_next_action(host);
    while (controller && controller->is_stopped) {
        wh_controller_end_unbegun(controller, WH_STATUS_STOPPED, "it waited and was not begun");
        controller = wh_host_next_action(host);
    }
    if (!controller || (is_any_running(host) && wh_session_is_full(host->session))) {
        return false;
    }
    wh_session_renew(host->session);
    controller->is_running = true;
    controller->line_number = 0;
    controller->ended = WH_OK;
    controller->begin_slice = host->session->mcs.track.slice;
    host->running = controller;
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    *job = (wh_mcs_job_t){.number = job_of(controller),
                          .line = controller->lines.lines[0],
                          .may_wait = controller->dialect.busy_s > 0,
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
    free(controller->ended_text);
    controller->ended_text = wh_array_new(room, 1);
    controller->ended = status;
    wh_utf8_visible(controller->ended_text, room, answer);
}

static void end_job(wh_controller_t *controller) {
    wh_host_t *host = controller->host;
    const size_t last = controller->lines.count - 1;
    const size_t at = controller->line_number < last ? controller->line_number : last;
    controller->is_running = false;
    if (controller->ended != WH_OK) {
        controller->failed = controller->ended;
        (void)snprintf(controller->failed_line, sizeof controller->failed_line, "%s",
                       controller->lines.lines[at]);
    }
    if (host->holder == controller) {
        host->is_held = false;
    }
    host->running = find_running(host);
    wh_controller_end(controller, controller->ended, controller->ended_text, seconds_of(controller));
}

/* Behind a CLEAR a slice is waited for, with which the fault ends; what that is answered nobody hears. */
static const char *ended(void *user, int32_t job, wh_status_t status, const char *answer) {
    wh_host_t *host = user;
    wh_controller_t *controller = host->controllers[job - 1];
    const size_t last = controller->lines.count - 1;
    if (controller->line_number <= last) {
        keep_answer(controller, status, answer);
    }
    if (status == WH_OK && controller->line_number < last) {
        return controller->lines.lines[++controller->line_number];
    }
    if (status == WH_OK && controller->line_number == last &&
        wh_word_of(controller->lines.lines[last]) == wh_word_of("CLEAR")) {
        static char line[40];
        (void)snprintf(line, sizeof line, "WAIT %.6f", (double)host->session->mcs.track.slice_us / 1e6);
        ++controller->line_number;
        return line;
    }
    end_job(controller);
    return NULL;
}

static const char *spell(const char *line, char spelt[2 * WH_DIALECT_LINE_BYTES]) {
    spelt[0] = '\0';
    (void)wh_value_spell(line, spelt, (size_t)(2 * WH_DIALECT_LINE_BYTES));
    return spelt;
}

/* Its line, or what the robot holds. */
static void put_phase(const wh_controller_t *controller, FILE *out) {
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    const wh_mcs_t *mcs = &controller->host->session->mcs;
    const wh_mcs_held_t *held = is_robot ? wh_mcs_find_held(mcs, controller->mechanism.index) : NULL;
    const size_t last = controller->lines.count - 1;
    const size_t at = controller->line_number < last ? controller->line_number : last;
    char spelt[2 * WH_DIALECT_LINE_BYTES];
    if (controller->has_action) {
        (void)fprintf(out, "phase=running command=%s", spell(controller->lines.lines[at], spelt));
    } else if (held) {
        (void)fprintf(out, "phase=held command=%s stop=%s", spell(held->command, spelt), held->phase);
    } else {
        (void)fprintf(out, "phase=idle");
    }
}

static void put_failed(const wh_controller_t *controller, FILE *out) {
    char spelt[2 * WH_DIALECT_LINE_BYTES];
    (void)fprintf(out, " error=%d", (int)controller->failed);
    if (controller->failed != WH_OK) {
        (void)fprintf(out, " error_name=%s error_command=%s", wh_status_name(controller->failed),
                      spell(controller->failed_line, spelt));
    }
}

/* What lies between what runs and what has failed is the cell's. */
void wh_controller_describe(const wh_controller_t *controller, char text[WH_MCS_DESCRIPTION_BYTES]) {
    static char whole[WH_MCS_DESCRIPTION_BYTES];
    wh_mcs_describe(&controller->host->session->mcs, text);
    const char *begin = strstr(text, " seq=");
    const char *end = begin ? strstr(begin, " error=") : NULL;
    if (!wh_host_plays_jobs(controller->host) || !end) {
        return;
    }
    FILE *out = wh_memory_need(fmemopen(whole, sizeof whole, "w"));
    put_phase(controller, out);
    (void)fprintf(out, "%.*s", (int)(end - begin), begin);
    put_failed(controller, out);
    (void)fclose(out);
    memcpy(text, whole, sizeof whole);
}

void wh_host_play_jobs(wh_host_t *host) {
    static char text[WH_SESSION_ANSWER_BYTES];
    const wh_mcs_jobs_t jobs = {take, ended, host};
    wh_host_begin_clock(host, wh_host_next_action(host));
    const wh_status_t status = wh_session_play(host->session, &jobs, text, sizeof text);
    wh_host_heed_stop(host, status);
    for (size_t i = 0; i < host->count; ++i) {
        if (host->controllers[i]->is_running) {
            keep_answer(host->controllers[i], status, text);
            end_job(host->controllers[i]);
        }
    }
    host->running = NULL;
    host->is_held = false;
}
