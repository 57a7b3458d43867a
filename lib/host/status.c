#include "status.h"

#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "queue.h"
#include "values.h"

bool wh_host_plays_jobs(const wh_host_t *host) {
    return host->leaders > 1 || (host->count > 0 && host->controllers[0]->mechanism.name);
}

bool wh_host_is_first_of_port(const wh_host_t *host, size_t i) {
    return i == 0 || host->controllers[i]->leader != host->controllers[i - 1]->leader ||
           host->controllers[i]->role != host->controllers[i - 1]->role;
}

int32_t wh_controller_job(const wh_controller_t *controller) {
    return controller->leader->is_tester ? WH_MCS_NOBODYS_JOB : (int32_t)controller->leader->number + 1;
}

bool wh_controller_needs_all(const wh_controller_t *controller) {
    static const char *const words[] = {"RESET", "SAVE", "RESTORE", "UNDO"};
    bool needs = false;
    for (size_t i = 0; i < controller->action.lines.count; ++i) {
        for (size_t w = 0; w < sizeof words / sizeof words[0]; ++w) {
            needs = needs || wh_word_of(controller->action.lines.lines[i]) == wh_word_of(words[w]);
        }
    }
    return needs;
}

bool wh_controller_waits(const wh_controller_t *controller) {
    return controller->action.is_running &&
           wh_mcs_job_waits(&controller->host->session->mcs, wh_controller_job(controller));
}

wh_controller_t *wh_host_next_action(const wh_host_t *host) {
    wh_controller_t *next = NULL;
    for (size_t i = 0; i < host->count && !host->is_ended; ++i) {
        wh_controller_t *controller = host->controllers[i];
        if (controller->action.is_there && !controller->action.is_running &&
            (!next || controller->action.order < next->action.order)) {
            next = controller;
        }
    }
    return next;
}

bool wh_controller_is_held(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    bool is_any = controller->leader->is_held;
    for (size_t i = 0; i < host->count && controller->leader->is_tester; ++i) {
        is_any = is_any || host->controllers[i]->is_held;
    }
    return is_any;
}

bool wh_host_is_held(const wh_host_t *host) {
    bool is_any = false;
    bool is_all = !wh_host_next_action(host);
    for (size_t i = 0; i < host->count; ++i) {
        const wh_controller_t *controller = host->controllers[i];
        const bool is_held = controller->action.is_running && controller->leader->is_held;
        is_any = is_any || is_held;
        is_all = is_all && (!controller->action.is_running || is_held || wh_controller_waits(controller));
    }
    return is_any && is_all;
}

bool wh_host_is_stopped(const wh_host_t *host) {
    bool is_any = wh_session_has_stop(host->session);
    bool is_all = true;
    for (size_t i = 0; i < host->count; ++i) {
        const wh_controller_t *controller = host->controllers[i];
        is_any = is_any || (controller->action.is_running && controller->action.is_stopped);
        is_all = is_all && (!controller->action.is_running || controller->action.is_stopped);
    }
    return is_any && is_all;
}

/* ------------------------------------------------------------------------------------------------- STATUS */

static const char *spell_line(const char *line, char spelt[2 * WH_DIALECT_LINE_BYTES]) {
    spelt[0] = '\0';
    (void)wh_value_spell(line, spelt, (size_t)(2 * WH_DIALECT_LINE_BYTES));
    return spelt;
}

/* Its line, or the command that the robot holds. */
static void put_phase(const wh_controller_t *asked, FILE *out) {
    const wh_controller_t *acting = wh_controller_acting(asked);
    const wh_controller_t *controller = acting ? acting : asked;
    const bool is_robot = controller->mechanism.kind == WH_MECHANISM_ROBOT;
    const wh_mcs_t *mcs = &controller->host->session->mcs;
    const wh_mcs_held_t *held = is_robot ? wh_mcs_find_held(mcs, controller->mechanism.index) : NULL;
    const size_t last = controller->action.lines.count - 1;
    const size_t at = controller->action.line_number < last ? controller->action.line_number : last;
    char spelt[2 * WH_DIALECT_LINE_BYTES];
    if (controller->action.is_there) {
        (void)fprintf(out, "phase=running command=%s", spell_line(controller->action.lines.lines[at], spelt));
    } else if (held) {
        (void)fprintf(out, "phase=held command=%s stop=%s", spell_line(held->command, spelt), held->phase);
    } else {
        (void)fprintf(out, "phase=idle");
    }
}

const char *wh_controller_known_as(const wh_controller_t *controller) {
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    const char *kind = controller->leader->is_tester ? "control" : wh_mechanism_names[mechanism->kind];
    return mechanism->name ? mechanism->name : kind;
}

/* The port whose last error is told: its own; to a tester the latest of all. */
static const wh_controller_t *find_failed(const wh_controller_t *controller) {
    const wh_host_t *host = controller->host;
    const wh_controller_t *found = controller->leader;
    for (size_t i = 0; i < host->count && controller->leader->is_tester; ++i) {
        const wh_controller_t *other = host->controllers[i]->leader;
        const bool is_later =
            found->action.failed == WH_OK || other->action.failed_order > found->action.failed_order;
        found = other->action.failed != WH_OK && is_later ? other : found;
    }
    return found;
}

static void put_failed(const wh_controller_t *controller, FILE *out) {
    const wh_controller_t *failed = find_failed(controller);
    const wh_action_t *action = &failed->leader->action;
    char spelt[2 * WH_DIALECT_LINE_BYTES];
    (void)fprintf(out, " error=%d", (int)action->failed);
    if (action->failed != WH_OK) {
        (void)fprintf(out, " error_name=%s error_command=%s", wh_status_name(action->failed),
                      spell_line(action->failed_line, spelt));
    }
    if (action->failed != WH_OK && controller->leader->is_tester) {
        (void)fprintf(out, " error_port=%s", spell_line(wh_controller_known_as(failed), spelt));
    }
}

/* The running command and the last failure are the controller's; the text between them is the cell's. */
void wh_controller_describe(const wh_controller_t *controller, char text[WH_MCS_DESCRIPTION_BYTES]) {
    char *whole = controller->host->texts->own_status;
    wh_mcs_describe(&controller->host->session->mcs, text);
    const char *begin = strstr(text, " seq=");
    const char *end = begin ? strstr(begin, " error=") : NULL;
    if (!wh_host_plays_jobs(controller->host) || !end) {
        return;
    }
    const bool is_cell = controller->mechanism.kind == WH_MECHANISM_CELL && !wh_controller_acting(controller);
    FILE *out = wh_memory_need(fmemopen(whole, WH_MCS_DESCRIPTION_BYTES, "w"));
    if (is_cell) {
        (void)fprintf(out, "%.*s", (int)(begin - text), text); /* it may hold any robot in a phase */
    } else {
        put_phase(controller, out);
    }
    (void)fprintf(out, "%.*s", (int)(end - begin), begin);
    put_failed(controller, out);
    (void)fclose(out);
    memcpy(text, whole, WH_MCS_DESCRIPTION_BYTES);
}
