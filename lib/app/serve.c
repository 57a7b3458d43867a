/* waferhand serve LAYOUT --dialect FILE --tcp ADDRESS:PORT | --pty LINK */
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../host/host.h"
#include "../play/run_document.h"
#include "../text/array.h"
#include "../text/output.h"
#include "../text/utf8.h"
#include "apart.h"
#include "app.h"
#include "layout_arguments.h"
#include "run_arguments.h"
#include "serve_beside.h"
#include "serve_cell.h"
#include "serve_coverage.h"
#include "serve_ports.h"

typedef struct {
    wh_layout_arguments_t layout;
    wh_run_arguments_t run; /* only its files come from the command line */
    wh_serve_ports_t ports;
    double rate; /* 0: not given */
    bool lockstep;
    const char *transcript, *coverage;
    wh_serve_cell_arguments_t cell;
    wh_serve_beside_t beside;
    wh_allow_t allow;
    wh_live_arguments_t page;
} arguments_t;

static const wh_option_t options[] = {
    {"rate", 0, "FACTOR", "Let simulated time pass so much faster than the wall clock (default 1)",
     WH_OPTION_REAL, .variable = offsetof(arguments_t, rate), 1e-3, 1e3},
    {"lockstep", 0, NULL, "Wait for no clock: commands take as long as they take to compute", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, lockstep)},
    {"transcript", 0, "FILE",
     "Write down what was said, a line for each frame; JSON lines if its name ends in .jsonl", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, transcript)},
    {"coverage", 0, "FILE",
     "Count in this file which errors hosts were shown and which never; it goes on from what it says already",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, coverage)},
    {0}};

static void check_serve_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->lockstep && arguments->rate > 0) {
        argp_error(state, "--lockstep waits for no clock: no --rate beside it");
    }
}

static const wh_option_table_t tables[] = {
    {wh_serve_ports_options, offsetof(arguments_t, ports), NULL, wh_serve_ports_check},
    {options, 0, NULL, check_serve_arguments},
    {wh_serve_beside_options, offsetof(arguments_t, beside), NULL, NULL},
    {wh_serve_cell_options, offsetof(arguments_t, cell), NULL, wh_serve_cell_check},
    {wh_record_options, offsetof(arguments_t, cell.record), NULL, wh_record_arguments_check},
    {wh_run_files_options, offsetof(arguments_t, run.files), NULL, NULL},
    {wh_live_options, offsetof(arguments_t, page), NULL, wh_live_check},
    {wh_layout_options, offsetof(arguments_t, layout), NULL, NULL},
    {0}};

static const wh_command_line_t command_line = {
    .name = "serve",
    .synopsis = "LAYOUT --dialect FILE --tcp ADDRESS:PORT|--pty LINK [...]",
    .about = "Simulates the layout's cell for a tool's host software, which talks to each controller in its "
             "own dialect, until SIGINT or SIGTERM.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "layout",
    .operand_variable = offsetof(arguments_t, layout.path)};

/* ------------------------------------------------------------------------------------------------ outputs */

/* Writes the first line and the description of the run, from which `waferhand converse` plays it. */
static bool write_heads(const wh_host_t *host, const arguments_t *arguments) {
    wh_transcript_head_t *heads =
        wh_array_new(2 + arguments->layout.parameters.count + 4 * host->count, sizeof *heads);
    char(*ports)[PATH_MAX + 80] = wh_array_new(host->count + 1, sizeof *ports);
    size_t count = 0;
    heads[count++] = (wh_transcript_head_t){"layout", arguments->layout.path, 0};
    for (size_t i = 0; i < arguments->layout.parameters.count; ++i) {
        heads[count++] = (wh_transcript_head_t){"set", arguments->layout.parameters.items[i], 0};
    }
    if (host->shows_one_run) {
        heads[count++] = (wh_transcript_head_t){"shows", "one run", 0};
    }
    for (size_t i = 0; i < host->count; ++i) {
        const wh_controller_t *controller = host->controllers[i];
        snprintf(ports[i], sizeof *ports, "%s %s", controller->name, controller->dialect->path);
        heads[count++] = (wh_transcript_head_t){"port", ports[i], 0};
        if (controller->mechanism.name && controller->leader == controller) {
            heads[count++] = (wh_transcript_head_t){"mechanism", controller->mechanism.name, 0};
        }
        if (controller->unit) {
            heads[count++] = (wh_transcript_head_t){"unit", controller->unit, 0};
        }
        if (controller->carrier != controller) {
            heads[count++] = (wh_transcript_head_t){"line", controller->carrier->name, 0};
        }
    }
    const bool written = (host->writes_json ? wh_transcript_write_json_heads
                                            : wh_transcript_write_heads)(host->transcript, heads, count);
    free(heads);
    free(ports);
    return written;
}

static bool open_transcript(wh_host_t *host, const arguments_t *arguments) {
    if (!arguments->transcript) {
        return true;
    }
    if (wh_file_is_free("--transcript", arguments->transcript)) {
        const size_t length = strlen(arguments->transcript);
        host->writes_json = length >= 6 && strcmp(arguments->transcript + length - 6, ".jsonl") == 0;
        host->transcript = fopen(arguments->transcript, "we");
        /* Each line is there at once, for who watches. */
        if (host->transcript && setvbuf(host->transcript, NULL, _IOLBF, BUFSIZ) == 0 &&
            write_heads(host, arguments)) {
            return true;
        }
        fprintf(stderr, "--transcript %s: %s (expected the path of a file)\n", arguments->transcript,
                strerror(errno));
    }
    return false;
}

static bool close_transcript(wh_host_t *host, const arguments_t *arguments) {
    if (!host->transcript) {
        return true;
    }
    const bool is_bad = ferror(host->transcript) != 0;
    if (fclose(host->transcript) != 0 || is_bad) {
        fprintf(stderr, "--transcript %s: not written: %s\n", arguments->transcript, strerror(errno));
        return false;
    }
    return true;
}

/* Tests before the first client if each output that is written at the end can be written. */
static bool are_writable(const arguments_t *arguments) {
    const wh_run_files_t *files = &arguments->run.files;
    const struct {
        const char *option, *path;
    } outputs[] = {{"--report", files->page},
                   {"--gltf", files->scene},
                   {"--data", files->document},
                   {"--svg", files->plots},
                   {"--coverage", arguments->coverage}};
    bool good = true;
    for (size_t i = 0; good && i < sizeof outputs / sizeof outputs[0]; ++i) {
        good = !outputs[i].path || wh_file_is_writable(outputs[i].option, outputs[i].path);
    }
    return good;
}

static bool write_report(arguments_t *arguments, wh_session_t *session, wh_signals_t *signals) {
    char *command = NULL;
    size_t size = 0;
    if (!wh_run_files_wanted(&arguments->run.files)) {
        return true;
    }
    if (!signals->layout) {
        wh_signals_begin(signals, session->record.layout, true);
    }
    wh_signals_finish(signals);
    FILE *out = wh_memory_need(open_memstream(&command, &size));
    fputs("serve", out);
    for (size_t i = 0; i < arguments->ports.dialects.count; ++i) {
        fputs(" --dialect ", out);
        wh_output_word(out, arguments->ports.dialects.items[i]);
    }
    (void)fclose(out);
    arguments->run.command = command;
    const wh_document_t document = {.source = "session", .record = &session->record, .signals = signals};
    const bool written = wh_run_files_write(&arguments->run, &document);
    free(command);
    return written;
}

/* ------------------------------------------------------------------------------------------------ serving */

static void say_untried(void *user, const char *list) {
    (void)user;
    fprintf(stderr, "serve: never came, and so were not tried: %s\n", list);
}

static void say_controller(const wh_controller_t *controller) {
    const wh_controller_counters_t *c = &controller->counters;
    const wh_port_counters_t *port = &controller->carrier->line.port.counters;
    fprintf(stderr,
            "serve: %s: %" PRIu64 " client%s, %" PRIu64 " frame%s, %" PRIu64 " bad, %" PRIu64
            " repeated, %" PRIu64 " action%s, %" PRIu64 " busy, %" PRIu64 " without an ACKN, %" PRIu64
            " mistake%s of the dialect\n",
            controller->name, port->clients, WH_PLURAL(port->clients), c->frames, WH_PLURAL(c->frames),
            c->bad, c->repeated, c->actions, WH_PLURAL(c->actions), c->busy, c->unacknowledged, c->mistakes,
            WH_PLURAL(c->mistakes));
    if (c->nobodys > 0) {
        char address[4 * sizeof c->nobody];
        wh_utf8_visible(address, sizeof address, c->nobody);
        fprintf(stderr,
                "serve: %s: %" PRIu64 " frame%s for units that its line does not have, first \"%s\"\n",
                controller->name, c->nobodys, WH_PLURAL(c->nobodys), address);
    }
    if (port->idle > 0) {
        fprintf(stderr, "serve: %s: %" PRIu64 " silent client%s closed\n", controller->name, port->idle,
                port->idle == 1 ? " was" : "s were");
    }
}

static void say_counters(const wh_host_t *host) {
    const wh_session_t *session = host->session;
    for (size_t i = 0; i < host->count; ++i) {
        if (wh_host_is_first_of_port(host, i) || host->controllers[i]->line.port.counters.clients > 0) {
            say_controller(host->controllers[i]);
        }
    }
    const int64_t slices = wh_session_slice(session);
    if (session->complaints > 0) {
        fprintf(stderr, "serve: the cell complained %" PRId64 " time%s, such as %s\n",
                (int64_t)session->complaints, WH_PLURAL(session->complaints),
                wh_event_name(host->seen.complaint));
    }
    if (session->unmet > 0) {
        fprintf(stderr, "serve: %" PRId64 " PUT%s ended in another slot than was asked\n",
                (int64_t)session->unmet, WH_PLURAL(session->unmet));
    }
    if (session->record.never_came) {
        say_untried(NULL, session->record.never_came);
    }
    fprintf(stderr, "serve: %" PRId64 " slice%s, hash %016" PRIx64 "\n", slices, WH_PLURAL(slices),
            wh_session_hash(session));
}

/* How fast simulated time has passed, if a rate was asked for. */
static void say_rate(const wh_host_t *host, const arguments_t *arguments) {
    const int64_t wall_us = host->clock.wall_us - host->clock.held_us;
    if (arguments->rate > 0 && wall_us > 0 && host->clock.run_us > 0) {
        const uint64_t rates = host->so_far.rates;
        char changed[60] = "";
        if (rates > 0) {
            (void)snprintf(changed, sizeof changed, ", set anew %" PRIu64 " time%s", rates, WH_PLURAL(rates));
        }
        fprintf(stderr, "serve: --rate %g%s: %.3g reached, %.3f s in %.3f s\n", arguments->rate, changed,
                (double)host->clock.run_us / (double)wall_us, (double)host->clock.run_us / 1e6,
                (double)wall_us / 1e6);
    }
}

/* A served run: its session, host, signals and cell. */
typedef struct {
    wh_session_t session;
    wh_host_t host;
    wh_signals_t signals;
    wh_serve_cell_t cell;
    wh_live_t *live; /* its page; null: none */
} served_t;

static bool open_session(served_t *served, const arguments_t *arguments) {
    wh_session_options_t wanted = {
        .layout = arguments->layout.path,
        .limits = {.memory_bytes = (size_t)(arguments->layout.memory_mib * 1048576), .print_to = stderr},
        .parameters = arguments->layout.parameters.items,
        .parameter_count = arguments->layout.parameters.count,
        .listener = wh_host_listener(&served->host),
        .keeps_all = wh_run_files_wanted(&arguments->run.files),
        .is_of_hosts = true,
        .slows_down = true,
        .untried = say_untried};
    if (!wh_serve_cell_open(&served->cell, &arguments->cell, &served->host, &wanted.partners)) {
        return false;
    }
    if (!wh_session_open(&served->session, &wanted)) {
        fprintf(stderr, "%s\n", served->session.message);
        return false;
    }
    return true;
}

static bool close_served(served_t *served) {
    wh_live_close(served->live);
    wh_host_close(&served->host);
    wh_signals_close(&served->signals);
    const bool is_sound = wh_serve_cell_close(&served->cell);
    wh_session_close(&served->session);
    return is_sound;
}

static double rate_of(const arguments_t *arguments) {
    const double rate = arguments->rate > 0 ? arguments->rate : 1;
    return arguments->lockstep ? 0 : rate;
}

/* Runs until the host is stopped; false if a requested file could not be written. */
static bool run_host(served_t *served, arguments_t *arguments) {
    wh_host_run(&served->host);
    wh_mcs_finish(&served->session.mcs);
    say_counters(&served->host);
    say_rate(&served->host, arguments);
    const bool reported = write_report(arguments, &served->session, &served->signals);
    const bool covered = wh_serve_coverage_keep(arguments->coverage, &served->host);
    return close_transcript(&served->host, arguments) && reported && covered;
}

/* Opens all ports and the transcript, and says so. */
static bool listen_all(served_t *served, const arguments_t *arguments, int argc, char **argv) {
    wh_host_t *host = &served->host;
    if (!wh_serve_ports_open(&arguments->ports, host, argc, argv) ||
        !wh_serve_beside_open(&arguments->beside, host)) {
        return false;
    }
    for (size_t i = 0; i < host->count; ++i) {
        if (host->controllers[i]->leader->is_tester) {
            wh_live_set_tester(served->live, host->controllers[i]->line.port.place);
        }
    }
    return open_transcript(host, arguments) && wh_serve_beside_ready(&arguments->beside, host);
}

static bool open_page(served_t *served, const arguments_t *arguments) {
    wh_host_t *host = &served->host;
    const wh_live_options_t wanted = {.speaker = "serve",
                                      .title = arguments->layout.path,
                                      .controlled = WH_LIVE_TESTER,
                                      .rate = rate_of(arguments)};
    const bool opened = wh_live_open(&served->live, &arguments->page, &wanted);
    if (served->live) {
        host->next = wh_live_listener(served->live, &host->next);
        host->callbacks.heard = wh_live_heard;
        host->callbacks.heard_user = served->live;
    }
    return opened;
}

/* Opens the page, and tests what would be too late at the end. */
static bool may_begin(served_t *served, arguments_t *arguments) {
    if (arguments->page.controls && !arguments->beside.control) {
        arguments->beside.control = "127.0.0.1:0"; /* the page is a tester */
    }
    served->host.allow = arguments->beside.allowed.count > 0 ? &arguments->allow : NULL;
    return open_page(served, arguments) && wh_serve_beside_allow(&arguments->beside, &arguments->allow) &&
           wh_serve_coverage_check(arguments->coverage) && are_writable(arguments);
}

static int serve(arguments_t *arguments, int argc, char **argv) {
    static served_t served; /* most of it is for LCM, and not touched without that */
    wh_host_t *host = &served.host;
    *host = (wh_host_t){.session = &served.session,
                        .rate = rate_of(arguments),
                        .shows_one_run = wh_run_files_wanted(&arguments->run.files),
                        .stop = &wh_stop_requested};
    if (wh_run_files_wanted(&arguments->run.files)) {
        host->next = wh_run_listener(&served.signals);
    }
    const bool good = may_begin(&served, arguments) && open_session(&served, arguments) &&
                      listen_all(&served, arguments, argc, argv) && run_host(&served, arguments);
    return close_served(&served) && good ? WH_EXIT_MET : WH_EXIT_USAGE;
}

static bool is_apart(const arguments_t *arguments) {
    const wh_run_files_t *files = &arguments->run.files;
    const char *option = NULL;
    const char *record = wh_record_arguments_path(&arguments->cell.record, &option);
    const wh_named_file_t named[] = {{"the layout", arguments->layout.path, false},
                                     {"--report", files->page, true},
                                     {"--gltf", files->scene, true},
                                     {"--data", files->document, true},
                                     {"--svg", files->plots, true},
                                     {"--transcript", arguments->transcript, true},
                                     {"--ready", arguments->beside.ready, true},
                                     {option, record, true},
                                     {"--coverage", arguments->coverage, true}};
    return wh_files_are_apart(named, sizeof named / sizeof named[0], false);
}

int wh_app_serve(int argc, char **argv) {
    arguments_t arguments = {.run = {.quiet = true}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    arguments.run.run.script = arguments.layout.path;
    arguments.run.run.parameters = arguments.layout.parameters.items;
    arguments.run.run.parameter_count = arguments.layout.parameters.count;
    wh_catch_signals();
    const int status = is_apart(&arguments) && wh_serve_beside_forget(&arguments.beside)
                           ? serve(&arguments, argc, argv)
                           : WH_EXIT_USAGE;
    wh_layout_arguments_free(&arguments.layout);
    wh_serve_ports_free(&arguments.ports);
    wh_option_list_free(&arguments.beside.allowed);
    return status;
}
