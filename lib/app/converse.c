/* waferhand converse TRANSCRIPT */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../host/host.h"
#include "../text/array.h"
#include "app.h"
#include "connection.h"

typedef struct {
    const char *path;
} arguments_t;

static const wh_option_t options[] = {{0}};
static const wh_option_table_t tables[] = {{options, 0, NULL, NULL}, {0}};

static const wh_command_line_t command_line = {
    .name = "converse",
    .synopsis = "TRANSCRIPT",
    .about = "Plays the host's side of what `waferhand serve --transcript` has written, each frame at its "
             "slice, and "
             "shows the first frame of the controllers' that differs.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "transcript",
    .operand_variable = offsetof(arguments_t, path)};

/* The run that the transcript's heads describe. */
typedef struct {
    const char *layout;
    const char **parameters;
    size_t count;
    bool shows_one_run;
} heads_t;

static bool refuse_line(const wh_transcript_t *played, size_t line, const char *what) {
    fprintf(stderr, "%s:%zu: %s\n", played->path, line, what);
    return false;
}

/* True for a head that says more of the port before it. */
static bool says_more(const wh_transcript_head_t *head) {
    return strcmp(head->name, "mechanism") == 0 || strcmp(head->name, "unit") == 0 ||
           strcmp(head->name, "line") == 0;
}

static bool is_of_port(const wh_transcript_t *played, size_t i) {
    size_t port = i;
    while (port > 0 && says_more(&played->heads[port])) {
        --port;
    }
    return port < i && strcmp(played->heads[port].name, "port") == 0;
}

static bool read_heads(const wh_transcript_t *played, heads_t *heads) {
    heads->parameters = wh_array_new(played->head_count + 1, sizeof *heads->parameters);
    for (size_t i = 0; i < played->head_count; ++i) {
        const wh_transcript_head_t *head = &played->heads[i];
        if (strcmp(head->name, "layout") == 0) {
            heads->layout = head->text;
        } else if (strcmp(head->name, "set") == 0) {
            heads->parameters[heads->count++] = head->text;
        } else if (strcmp(head->name, "shows") == 0 && strcmp(head->text, "one run") == 0) {
            heads->shows_one_run = true;
        } else if (strcmp(head->name, "port") != 0 && !is_of_port(played, i)) {
            return refuse_line(played, head->line,
                               "no such head (expected layout, set, shows \"one run\", port, or mechanism, "
                               "unit or line behind "
                               "its port)");
        }
    }
    return heads->layout || refuse_line(played, 1, "no layout (expected a head: layout \"FILE\")");
}

/* The text of a head of this name that says more of that port, such as `mechanism "NAME"`; null: there is
 * none. */
static const char *find_more(const wh_transcript_t *played, size_t port, const char *name) {
    for (size_t i = port + 1; i < played->head_count && says_more(&played->heads[i]); ++i) {
        if (strcmp(played->heads[i].name, name) == 0) {
            return played->heads[i].text;
        }
    }
    return NULL;
}

static bool add_port(wh_host_t *host, const wh_host_port_t *port) {
    if (strcmp(port->dialect, WH_DIALECT_CONTROL) == 0) {
        return wh_host_add_control(host, NULL);
    }
    return (host->count > 0 && wh_host_needs_port(host) ? wh_host_add_port : wh_host_add)(host, port);
}

/* Checks a port that was added against its head. */
static bool is_as_told(const wh_transcript_t *played, size_t port, const wh_controller_t *added) {
    const wh_transcript_head_t *head = &played->heads[port];
    const char *line = find_more(played, port, "line");
    const size_t length = strlen(added->name);
    if (line && strcmp(line, added->carrier->name) != 0) {
        return refuse_line(played, head->line, "its line is that of another port than the one before it");
    }
    return (strncmp(added->name, head->text, length) == 0 && head->text[length] == ' ') ||
           refuse_line(played, head->line, "the dialect is of another mechanism than its port");
}

/* Adds each port's dialect, from `port "NAME FILE"`. */
static bool add_ports(wh_host_t *host) {
    const wh_transcript_t *played = host->played;
    size_t at = 0; /* the controller of the next head: clients who share a port come with it */
    for (size_t i = 0; i < played->head_count; ++i) {
        const wh_transcript_head_t *head = &played->heads[i];
        const char *file = strchr(head->text, ' ');
        if (strcmp(head->name, "port") != 0) {
            continue;
        }
        if (!file || at == (size_t)WH_HOST_CONTROLLERS) {
            return refuse_line(played, head->line, "no port (expected \"NAME DIALECT\", at most 8)");
        }
        const wh_host_port_t port = {.dialect = file + 1,
                                     .mechanism = find_more(played, i, "mechanism"),
                                     .unit = find_more(played, i, "unit"),
                                     .shares_line = find_more(played, i, "line")};
        if (at == host->count && !add_port(host, &port)) {
            fprintf(stderr, "%s\n", host->controllers[host->count - 1]->dialect->message);
            return false;
        }
        if (!is_as_told(played, i, host->controllers[at++])) {
            return false;
        }
    }
    return true;
}

/* Checks that all entries name existing ports, and that there is something to compare. */
static bool check_entries(const wh_host_t *host) {
    const wh_transcript_t *played = host->played;
    bool is_any_heard = false;
    for (size_t i = 0; i < played->count; ++i) {
        bool is_known = false;
        is_any_heard = is_any_heard || played->entries[i].kind == WH_TRANSCRIPT_HEARD;
        for (size_t c = 0; c < host->count; ++c) {
            is_known = is_known || strcmp(host->controllers[c]->name, played->entries[i].port) == 0;
        }
        if (!is_known) {
            return refuse_line(played, played->entries[i].line, "no such port (expected one of the heads)");
        }
    }
    return is_any_heard ||
           refuse_line(played, 1, "nothing to compare (expected a frame of a controller's, a line with <)");
}

static int play(wh_host_t *host) {
    wh_transcript_t *played = host->played;
    wh_session_t *session = host->session;
    const bool same = wh_host_converse(host);
    if (wh_stop_requested && !same && !played->is_different) {
        (void)snprintf(played->message, sizeof played->message, "interrupted: no difference up to here");
    }
    printf("%s%sslices: %" PRId64 ", hash %016" PRIx64 "\n", same ? "same; " : played->message,
           same ? "" : "\n", wh_session_slice(session), wh_session_hash(session));
    return !wh_app_is_printed(0) ? WH_EXIT_USAGE : same ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int converse(wh_transcript_t *played) {
    static wh_session_t session;
    heads_t heads = {0};
    wh_host_t host = {.session = &session, .stop = &wh_stop_requested, .played = played};
    int status = WH_EXIT_USAGE;
    if (read_heads(played, &heads)) {
        host.shows_one_run = heads.shows_one_run;
        const wh_session_options_t wanted = {.layout = heads.layout,
                                             .is_of_hosts = true,
                                             .slows_down = true,
                                             .limits = {.print_to = stderr},
                                             .parameters = heads.parameters,
                                             .parameter_count = heads.count,
                                             .listener = wh_host_listener(&host)};
        const bool opened = wh_session_open(&session, &wanted);
        if (!opened) {
            fprintf(stderr, "%s\n", session.message);
        } else if (add_ports(&host) && check_entries(&host)) {
            status = play(&host);
        }
        wh_host_close(&host);
        wh_session_close(&session);
    }
    free(heads.parameters);
    return status;
}

int wh_app_converse(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_transcript_t played;
    int status = WH_EXIT_USAGE;
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_catch_signals();
    if (wh_transcript_open(&played, arguments.path)) {
        status = converse(&played);
    } else {
        fprintf(stderr, "%s\n", played.message);
    }
    wh_transcript_close(&played);
    return status;
}
