/* waferhand sim LAYOUT */
#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../link/outputs.h"
#include "../link/sim_process.h"
#include "../log/recording.h"
#include "../text/json.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "broadcast.h"
#include "connection.h"
#include "layout_arguments.h"
#include "live_sim.h"
#include "sim_board.h"

typedef struct {
    wh_layout_arguments_t layout;
    wh_record_arguments_t record;
    const char *url, *outputs;
    bool json, log_time, one_sender;
    wh_live_arguments_t page;
    wh_sim_board_arguments_t board;
} arguments_t;

static const wh_option_t options[] = {
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "; with a board: nowhere)", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {"outputs", 0, "FILE", "Take the valves from this file, one value per gripper, 0 or 1", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, outputs)},
    {"one-sender", 0, NULL,
     "Take commands from the process alone that began the run, until it is over or has been silent for 10 s",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, one_sender)},
    {"json", 0, NULL, "Print the counters as one JSON object at the end", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, json)},
    {"log-time", 0, NULL,
     "Put time (UTC) and level before each line of standard error that begins with \"sim:\"", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, log_time)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_record_options, offsetof(arguments_t, record), NULL, wh_record_arguments_check},
    {wh_live_options, offsetof(arguments_t, page), NULL, wh_live_check},
    {wh_layout_options, offsetof(arguments_t, layout), NULL, NULL},
    {wh_sim_board_options, offsetof(arguments_t, board), "A board in the loop:", wh_sim_board_check},
    {0}};

/* A board's line has one sender anyhow. */
static void check(const void *filled, struct argp_state *state) {
    const arguments_t *arguments = filled;
    if (arguments->one_sender && wh_sim_board_is_wanted(&arguments->board)) {
        argp_error(state, "--one-sender: goes with commands over LCM (expected no --serial and no --udp)");
    }
}

static const wh_command_line_t command_line = {.name = "sim",
                                               .synopsis = "LAYOUT",
                                               .about =
                                                   "Simulates the layout's cell for whoever sends commands "
                                                   "over LCM, or for a controller's board, until SIGINT or "
                                                   "SIGTERM.\v" WH_HELP_EXIT,
                                               .tables = tables,
                                               .operand = "layout",
                                               .operand_variable = offsetof(arguments_t, layout.path),
                                               .check = check};

/* Reports datagrams that were not our messages, or not of LCM. */
static uint64_t count_garbage(const wh_sim_process_t *simulation) {
    return simulation->counters.garbage + simulation->node->receiver.dropped;
}

static void say_counters(const wh_sim_process_t *simulation) {
    const wh_protocol_server_counters_t *c = &simulation->server.counters;
    const uint64_t garbage = count_garbage(simulation);
    wh_node_say(simulation->node,
                "%" PRIu64 " command%s: %" PRIu64 " stepped, %" PRIu64 " repeated, %" PRIu64
                " stale, %" PRIu64 " refused, %" PRIu64 " of unknown runs, %" PRIu64
                " of other layouts, %" PRIu64 " of runs that were over, %" PRIu64 " malformed",
                c->commands, WH_PLURAL(c->commands), c->stepped, c->repeated, c->stale, c->refused,
                c->unknown_run, c->other_layout, c->run_over, c->malformed);
    wh_node_say(simulation->node,
                "%" PRIu64 " state%s taken back of %" PRIu64 "; %" PRId64 " slice%s missed; %" PRIu64
                " datagram%s of garbage, %" PRIu64 " not sent",
                c->restored, WH_PLURAL(c->restored), c->restores, simulation->server.missed,
                WH_PLURAL(simulation->server.missed), garbage, WH_PLURAL(garbage),
                simulation->counters.unsent);
}

static json_t *count(uint64_t value) {
    return json_integer((json_int_t)value);
}

/* True if standard output took it. */
static bool print_counters(const wh_sim_process_t *simulation) {
    const wh_protocol_server_t *server = &simulation->server;
    const wh_protocol_server_counters_t *c = &server->counters;
    json_t *root = wh_json_add(
        json_object(), "layout layout_hash run slice hash", wh_json_text(server->layout->path),
        wh_json_hash(server->identity.layout_hash), wh_json_hash((uint64_t)server->identity.run),
        json_integer((json_int_t)server->seq), wh_json_hash(wh_protocol_server_hash(server)), NULL);
    (void)wh_json_add(
        root, "commands stepped repeated stale refused unknown_run other_layout run_over malformed",
        count(c->commands), count(c->stepped), count(c->repeated), count(c->stale), count(c->refused),
        count(c->unknown_run), count(c->other_layout), count(c->run_over), count(c->malformed), NULL);
    (void)wh_json_add(root, "restores restored restore_ignored restore_refused", count(c->restores),
                      count(c->restored), count(c->restore_ignored), count(c->restore_refused), NULL);
    (void)wh_json_add(root, "missed garbage unsent silences strangers",
                      json_integer((json_int_t)server->missed), count(count_garbage(simulation)),
                      count(simulation->counters.unsent), count(simulation->counters.silences),
                      count(simulation->counters.strangers), NULL);
    const int status = wh_json_print(root, stdout);
    return wh_app_is_printed(status);
}

/* The file is checked before each message, so that valves written before a command apply to it. */
static void update_valves(wh_outputs_t *outputs, wh_sim_process_t *simulation) {
    if (outputs->count > 0 && (wh_outputs_update(outputs, wh_node_clock_us()) & WH_OUTPUTS_REPORTED) != 0) {
        char *report = wh_style_printable(outputs->report);
        wh_node_warn(simulation->node, "%s", report);
        free(report);
    }
    simulation->valves = outputs->count > 0 ? outputs->valves : NULL;
}

/* Waits for a message or a change of the file, at most 100 ms. */
static int wait_and_handle(wh_node_t *node, wh_outputs_t *outputs, wh_sim_process_t *simulation) {
    struct pollfd ready[] = {{.fd = wh_node_descriptor(node), .events = POLLIN},
                             {.fd = outputs->count > 0 ? outputs->fd : -1, .events = POLLIN}};
    int64_t wait_ms = 100;
    if (outputs->count > 0) {
        const int64_t due_ms = (outputs->due_us - wh_node_clock_us()) / 1000 + 1;
        wait_ms = due_ms < wait_ms ? due_ms : wait_ms;
    }
    (void)poll(ready, 2, wait_ms > 0 ? (int)wait_ms : 0);
    update_valves(outputs, simulation);
    return wh_node_wait(node, 0); /* one call of the system: poll has waited */
}

static bool open_outputs(wh_outputs_t *outputs, const char *path, size_t count) {
    int32_t closed[WH_GRIPPERS];
    if (!path) {
        return true;
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        closed[g] = WH_VALVE_CLOSED;
    }
    const int problem = wh_outputs_open(outputs, path, closed, count);
    if (problem != 0) {
        fprintf(stderr, "--outputs %s: %s (expected the path of a file)\n", path,
                problem == EINVAL ? "this is a folder" : strerror(problem));
    }
    return problem == 0;
}

/* Members that were not opened are all zero. */
typedef struct {
    wh_sim_process_t simulation;
    wh_outputs_t outputs;
    wh_live_sim_t live;
} served_t;

static bool open_served(served_t *served, wh_node_t *node, const wh_layout_t *layout,
                        const arguments_t *arguments) {
    const wh_status_t status =
        wh_sim_process_open(&served->simulation, node, layout, !wh_sim_board_is_wanted(&arguments->board));
    if (status == WH_STATUS_NO_NETWORK) {
        wh_node_warn(node, "LCM takes no subscription");
        return false;
    }
    if (status != WH_OK) {
        fprintf(stderr, "%s: %s (expected at most %d wafers, and a cell that fits one datagram)\n",
                layout->path, wh_status_text(status), WH_LINK_WAFERS);
        return false;
    }
    const bool has_board = wh_sim_board_is_wanted(&arguments->board);
    const wh_live_sim_driver_t driver = {has_board, has_board && !arguments->board.lockstep ? 1 : 0};
    return open_outputs(&served->outputs, arguments->outputs, layout->machine.gripper_count) &&
           wh_live_sim_open(&served->live, &arguments->page, &served->simulation, &driver);
}

static void close_served(served_t *served) {
    if (served->outputs.count > 0) {
        wh_outputs_close(&served->outputs);
    }
    wh_live_sim_close(&served->live);
    wh_sim_process_close(&served->simulation);
}

/* Does the work that is due besides the commands. */
static void tick(void *user) {
    served_t *served = user;
    wh_live_sim_tick(&served->live);
}

/* Commands come over LCM. */
static int serve_network(served_t *served, wh_node_t *node, const arguments_t *arguments) {
    wh_sim_process_t *simulation = &served->simulation;
    int handled = 0;
    wh_node_say(node, "%s is ready, layout %016" PRIx64, simulation->server.layout->path,
                simulation->server.identity.layout_hash);
    while (!wh_stop_requested && handled >= 0) {
        handled = wait_and_handle(node, &served->outputs, simulation);
        wh_sim_process_tick(simulation);
        tick(served);
    }
    say_counters(simulation);
    if (arguments->json && !print_counters(simulation)) {
        return WH_EXIT_USAGE;
    }
    return handled < 0 ? WH_EXIT_FAILED : WH_EXIT_MET;
}

/* The file is read after each slice. */
static void tick_board(void *user) {
    served_t *served = user;
    update_valves(&served->outputs, &served->simulation);
    tick(served);
}

static int serve(wh_node_t *node, const wh_layout_t *layout, const arguments_t *arguments) {
    static served_t served;
    const wh_sim_board_ticks_t ticks = {tick_board, &served};
    int status = WH_EXIT_USAGE;
    if (open_served(&served, node, layout, arguments)) {
        served.simulation.one_sender = arguments->one_sender;
        status = wh_sim_board_is_wanted(&arguments->board)
                     ? wh_sim_board_serve(&arguments->board, &served.simulation, &ticks, arguments->json)
                     : serve_network(&served, node, arguments);
    }
    close_served(&served);
    return status;
}

static bool is_apart(const arguments_t *arguments) {
    const char *option = NULL;
    const char *record = wh_record_arguments_path(&arguments->record, &option);
    const wh_named_file_t named[] = {{"the layout", arguments->layout.path, false},
                                     {"--outputs", arguments->outputs, false},
                                     {option, record, true}};
    return wh_files_are_apart(named, sizeof named / sizeof named[0], arguments->json);
}

static int run(arguments_t *arguments) {
    const wh_layout_t *layout = wh_layout_arguments_load(&arguments->layout);
    if (!layout) {
        return WH_EXIT_USAGE;
    }
    static wh_recording_t record;
    wh_node_t node;
    if (!is_apart(arguments)) {
        return WH_EXIT_USAGE;
    }
    wh_catch_signals();
    wh_record_arguments_apply(&arguments->record, "sim", false, &record);
    const bool is_alone = wh_sim_board_is_wanted(&arguments->board) && !arguments->url;
    const char *url = is_alone ? "memq://" : arguments->url;
    if ((!is_alone && !wh_node_reaches_others(url)) || !wh_recording_open_node(&record, &node, url)) {
        return WH_EXIT_USAGE;
    }
    node.speaker = "sim";
    node.log_time = arguments->log_time;
    const int status = serve(&node, layout, arguments);
    wh_node_close(&node);
    return wh_recording_close(&record) ? status : WH_EXIT_USAGE;
}

int wh_app_sim(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const int status = run(&arguments);
    wh_option_list_free(&arguments.board.allowed);
    wh_layout_arguments_free(&arguments.layout);
    return status;
}
