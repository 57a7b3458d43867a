#include "conditions.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "../text/array.h"
#include "values.h"

/* Room for a value as it is typed. */
#define VALUE_BYTES 200

/* A line's changes, and the robot that it names; empty: none. */
typedef struct {
    char names[WH_MCS_CHANGES][WH_DIALECT_NAME_BYTES];
    char values[WH_MCS_CHANGES][VALUE_BYTES];
    wh_mcs_change_t changes[WH_MCS_CHANGES];
    size_t count;
    char robot[VALUE_BYTES];
} said_t;

static wh_status_t refuse_line(char reason[WH_MCS_CHANGE_BYTES], const char *what, const char *expected) {
    (void)snprintf(reason, WH_MCS_CHANGE_BYTES, "CONTROLLER: %.100s (expected %.200s)", what, expected);
    return WH_STATUS_BAD_ARGUMENT;
}

/* Takes the word at `word`, of `length` bytes: name=value. */
static wh_status_t take_word(said_t *said, const char *line, const char *word, size_t length,
                             char reason[WH_MCS_CHANGE_BYTES]) {
    char name[WH_DIALECT_NAME_BYTES];
    const size_t name_length = strcspn(word, "= ");
    if (word[name_length] != '=' || name_length >= sizeof name || length - name_length > VALUE_BYTES) {
        return refuse_line(reason, word, "options, such as power=off");
    }
    (void)snprintf(name, sizeof name, "%.*s", (int)name_length, word);
    if (strcmp(name, "robot") == 0) {
        wh_value_copy(line, name, said->robot, sizeof said->robot);
        return WH_OK;
    }
    if (said->count == WH_MCS_CHANGES) {
        return refuse_line(reason, word, "each option once");
    }
    memcpy(said->names[said->count], name, sizeof name);
    wh_value_copy(word, name, said->values[said->count], VALUE_BYTES);
    for (char *c = said->names[said->count]; *c; ++c) {
        *c = (char)tolower((unsigned char)*c);
    }
    said->changes[said->count] = (wh_mcs_change_t){said->names[said->count], said->values[said->count]};
    ++said->count;
    return WH_OK;
}

/* The place behind a word, whose value may be in quotes. */
static const char *end_of_word(const char *word) {
    bool is_quoted = false;
    while (*word && (is_quoted || *word != ' ')) {
        is_quoted = *word == '"' ? !is_quoted : is_quoted;
        ++word;
    }
    return word;
}

static wh_status_t read_line(said_t *said, const char *line, char reason[WH_MCS_CHANGE_BYTES]) {
    wh_status_t status = WH_OK;
    const char *at = end_of_word(line + strspn(line, " "));
    memset(said, 0, sizeof *said);
    for (at += strspn(at, " "); *at && status == WH_OK; at += strspn(at, " ")) {
        const char *end = end_of_word(at);
        status = take_word(said, line, at, (size_t)(end - at), reason);
        at = end;
    }
    return status;
}

/* The robot of this name as it is typed; WH_NONE: there is none. */
static int32_t find_robot(const wh_layout_t *layout, const char *typed) {
    char spelt[VALUE_BYTES];
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        if (wh_value_spell(layout->robots[robot].name, spelt, sizeof spelt) && strcmp(spelt, typed) == 0) {
            return (int32_t)robot;
        }
    }
    return WH_NONE;
}

/* The robot whose controller the port is; WH_NONE: it is one of several. */
static int32_t find_own_robot(const wh_controller_t *controller) {
    const wh_layout_t *layout = wh_session_layout(controller->host->session);
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    if (mechanism->kind == WH_MECHANISM_ROBOT && mechanism->index != WH_NONE) {
        return mechanism->index;
    }
    return wh_machine_robots(&layout->machine) > 1 ? WH_NONE : 0;
}

/* The robot that is meant: the port's, or the one that is named. */
static wh_status_t choose_robot(const wh_controller_t *controller, const char *typed, size_t *robot,
                                char reason[WH_MCS_CHANGE_BYTES]) {
    const int32_t own = find_own_robot(controller);
    const bool is_named = typed[0] != '\0';
    const int32_t meant = is_named ? find_robot(wh_session_layout(controller->host->session), typed) : own;
    if (meant == WH_NONE && !is_named) {
        (void)refuse_line(reason, "no robot", "robot=, one of several");
        return WH_STATUS_AMBIGUOUS_ROBOT;
    }
    if (meant == WH_NONE || (own != WH_NONE && meant != own)) {
        (void)refuse_line(reason, typed,
                          own != WH_NONE ? "the robot whose controller this is" : "a robot's name");
        return WH_STATUS_NO_SUCH_ROBOT;
    }
    *robot = (size_t)meant;
    return WH_OK;
}

static wh_status_t change_by(wh_controller_t *controller, const char *line,
                             char reason[WH_MCS_CHANGE_BYTES]) {
    said_t said;
    size_t robot = 0;
    wh_status_t status = read_line(&said, line, reason);
    status = status == WH_OK ? choose_robot(controller, said.robot, &robot, reason) : status;
    return status == WH_OK ? wh_mcs_change_controller(&controller->host->session->mcs, robot, said.changes,
                                                      said.count, reason)
                           : status;
}

wh_status_t wh_controller_change(wh_controller_t *controller, const wh_lines_t *lines,
                                 char reason[WH_MCS_CHANGE_BYTES]) {
    wh_status_t status = WH_OK;
    for (size_t i = 0; i < lines->count && status == WH_OK; ++i) {
        status = change_by(controller, lines->lines[i], reason);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ telling */

static void put_value(void *user, const char *name, const char *value, bool usual) {
    FILE *out = user;
    (void)usual;
    (void)fprintf(out, "%s%s=%s", ftell(out) > 0 ? " " : "", name, value);
}

void wh_host_tell_conditions(const wh_host_t *host, size_t robot, char *text, size_t size) {
    const wh_mcs_t *mcs = &host->session->mcs;
    text[0] = '\0';
    FILE *out = wh_memory_need(fmemopen(text, size, "w"));
    if (wh_mcs_layout(mcs)) {
        wh_mcs_tell_controller(mcs, robot, put_value, out);
    }
    (void)fclose(out);
}

void wh_controller_tell_conditions(const wh_controller_t *controller, char *text, size_t size) {
    const wh_port_mechanism_t *mechanism = &controller->mechanism;
    const bool is_bound = mechanism->kind == WH_MECHANISM_ROBOT && mechanism->index != WH_NONE;
    wh_host_tell_conditions(controller->host, is_bound ? (size_t)mechanism->index : 0, text, size);
}

/* Nobody is told of what they are at the start. */
static void see_conditions(wh_host_t *host) {
    const wh_layout_t *layout = wh_session_layout(host->session);
    for (size_t robot = 0; layout && robot < layout->robot_count; ++robot) {
        host->seen.controllers[robot] = *wh_mcs_controller(&host->session->mcs, robot);
    }
}

bool wh_controller_begin_conditions(wh_controller_t *controller) {
    char reason[WH_MCS_CHANGE_BYTES];
    char text[WH_SANDBOX_MESSAGE_BYTES];
    wh_dialect_t *dialect = controller->dialect;
    wh_host_t *host = controller->host;
    const bool has_layout = wh_session_layout(host->session);
    if (controller->leader != controller || !has_layout || dialect->begins.count == 0 ||
        wh_controller_change(controller, &dialect->begins, reason) == WH_OK) {
        see_conditions(host);
        return true;
    }
    (void)snprintf(text, sizeof text, "begins: %s", reason);
    wh_dialect_note(dialect, text);
    return false;
}
