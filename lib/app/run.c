/* waferhand run SCRIPT */
#include "../link/sim_process.h"
#include "app.h"
#include "connection.h"
#include "run_arguments.h"
#include "watch.h"

typedef struct {
    wh_run_arguments_t run;
    wh_record_arguments_t record;
    const char *url;
    bool lcm, watch;
} arguments_t;

static const wh_option_t options[] = {
    {"lcm", 0, NULL, "Publish over LCM what motion control and simulator would say to each other",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --lcm", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {"watch", 0, NULL, WH_WATCH_HELP, WH_OPTION_FLAG, .variable = offsetof(arguments_t, watch)},
    {0}};

/* The errors are in the simulator of this process, and in nothing that is published or recorded of a run. */
static void check_errors(const arguments_t *arguments, struct argp_state *state) {
    const char *other = arguments->lcm             ? "--lcm"
                        : arguments->record.slices ? "--record"
                        : arguments->record.all    ? "--record-all"
                                                   : NULL;
    if (arguments->run.errors.count > 0 && other) {
        argp_error(state, WH_RUN_ERRORS_ALONE, other);
    }
}

static void check(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->url && !arguments->lcm) {
        argp_error(state, "--lcm-url: %s (goes with --lcm)", arguments->url);
    }
    check_errors(arguments, state);
    if (arguments->watch && (arguments->lcm || arguments->record.slices || arguments->record.all)) {
        argp_error(state, "--watch goes neither with --lcm nor with a recording");
    }
}

static const wh_option_table_t tables[] = {
    {options, 0, NULL, check},
    {wh_record_options, offsetof(arguments_t, record), NULL, wh_record_arguments_check},
    {wh_run_options, offsetof(arguments_t, run), NULL, wh_run_arguments_check},
    {wh_run_error_options, offsetof(arguments_t, run), NULL, wh_run_errors_check},
    {wh_run_files_options, offsetof(arguments_t, run.files), NULL, NULL},
    {0}};

static const wh_command_line_t command_line = {
    .name = "run",
    .synopsis = "SCRIPT",
    .about = "Plays a motion script against the simulator and prints what came of it.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

/* ---------------------------------------------------------------------------------------------- broadcast */

/* Motion control and simulator, coupled by calls, while all that would travel between them is published for
 * whoever watches, and recorded. */
typedef struct {
    wh_link_t link; /* first */
    wh_node_t node;
    wh_recording_t record;
    bool is_watched;          /* the messages are wanted one by one, not slices in a record alone */
    wh_mcs_process_t control; /* tells the commands; its client is not used */
    wh_sim_process_t simulation;
    wh_link_identity_t identity;
    bool connected;
} broadcast_t;

/* Records command and answer of a slice that fits no block. */
static void record_messages(broadcast_t *broadcast, const waferhand_command *message) {
    const wh_protocol_server_t *server = &broadcast->simulation.server;
    wh_protocol_client_publish(&broadcast->node, message);
    wh_recording_message(&broadcast->record, WH_CHANNEL_STATE, server->encoded, server->encoded_size);
}

/* Steps the command for a record of slices alone: of most slices no message is made. */
static wh_status_t record(broadcast_t *broadcast, const waferhand_command *message, wh_state_t *state) {
    wh_protocol_server_t *server = &broadcast->simulation.server;
    const wh_protocol_server_result_t result = wh_protocol_server_command(server, message, NULL);
    *state = server->state;
    if (result != WH_SERVER_STEPPED && result != WH_SERVER_NEW_RUN) {
        record_messages(broadcast, message);
        state->status = (wh_status_t)server->room.message.status;
        return state->status;
    }
    const wh_recorded_t recorded =
        wh_recording_slice(&broadcast->record, message, server->simulator.physics.told, server->missed,
                           wh_protocol_server_hash(server), server->state.event_count > 0);
    if (recorded != WH_RECORDED) {
        wh_protocol_server_encode(server);
    }
    if (recorded == WH_RECORDED_STATE) {
        wh_recording_state(&broadcast->record, server->encoded, server->encoded_size);
    } else if (recorded == WH_NOT_RECORDED) {
        record_messages(broadcast, message);
    }
    return state->status;
}

/* The command goes out as a client would send it, but the simulator is called, so that nothing can be lost
 * between the two. */
static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    broadcast_t *broadcast = (broadcast_t *)link;
    waferhand_command message;
    wh_link_command_to_message(command, &broadcast->identity, true, &message);
    broadcast->control.identity = broadcast->identity;
    broadcast->control.utime = command->utime;
    broadcast->control.seq = command->seq;
    if (!broadcast->is_watched) {
        return record(broadcast, &message, state);
    }
    wh_protocol_client_publish(&broadcast->node, &message);
    return wh_sim_process_step(&broadcast->simulation, &message, state);
}

static uint64_t last_hash(wh_link_t *link) {
    return wh_protocol_server_hash(&((broadcast_t *)link)->simulation.server);
}

static int64_t missed_slices(wh_link_t *link) {
    (void)link;
    return 0;
}

/* `user` is the broadcast's motion control. */
static wh_link_t *connect_simulation(void *user, wh_mcs_t *mcs) {
    broadcast_t *broadcast = (broadcast_t *)(void *)((char *)user - offsetof(broadcast_t, control));
    if (wh_sim_process_open(&broadcast->simulation, &broadcast->node, mcs->layout, false) != WH_OK) {
        return NULL;
    }
    broadcast->identity.run = wh_protocol_client_draw_run();
    broadcast->identity.layout_hash = broadcast->simulation.server.identity.layout_hash;
    broadcast->simulation.server.encodes_later = !broadcast->is_watched;
    broadcast->connected = true;
    broadcast->control.identity = broadcast->identity;
    wh_mcs_process_catch_up(&broadcast->control, mcs);
    return &broadcast->link;
}

static int run_on(broadcast_t *broadcast, wh_run_arguments_t *arguments) {
    const wh_mcs_partners_t told = wh_mcs_process_partners(&broadcast->control);
    const wh_mcs_partners_t partners = {.connect = connect_simulation,
                                        .watch = told.watch,
                                        .expected = told.expected,
                                        .cycle = told.cycle,
                                        .edge = told.edge,
                                        .centring = told.centring,
                                        .finished = told.finished,
                                        .user = told.user};
    const wh_protocol_client_options_t lockstep = {.rate = 0};
    if (!wh_mcs_process_open(&broadcast->control, &broadcast->node, &lockstep)) {
        return WH_EXIT_USAGE;
    }
    arguments->run.partners = partners;
    const int status = wh_run_and_print(arguments);
    wh_mcs_process_finish(&broadcast->control);
    wh_mcs_process_close(&broadcast->control);
    if (broadcast->connected) {
        wh_sim_process_close(&broadcast->simulation);
    }
    return status;
}

/* Runs with messages: over LCM, or within the process if only a record of them is wanted. */
static int run_published(arguments_t *arguments) {
    static broadcast_t broadcast = {.link = {exchange, last_hash, missed_slices}};
    const char *url = arguments->lcm ? arguments->url : "memq://";
    broadcast.is_watched = arguments->lcm || arguments->record.all;
    wh_record_arguments_apply(&arguments->record, "run", true, &broadcast.record);
    if ((arguments->lcm && !wh_node_reaches_others(url)) ||
        !wh_node_open(&broadcast.node, url, &broadcast.record)) {
        return WH_EXIT_USAGE;
    }
    arguments->run.recording = broadcast.record.options.path ? &broadcast.record : NULL;
    const int status = run_on(&broadcast, &arguments->run);
    wh_node_close(&broadcast.node);
    return wh_recording_close(&broadcast.record) ? status : WH_EXIT_USAGE;
}

static int play(void *user) {
    arguments_t *arguments = user;
    const bool published = arguments->lcm || arguments->run.record;
    if (!wh_run_files_are_apart(&arguments->run, NULL)) {
        return WH_EXIT_USAGE;
    }
    return published ? run_published(arguments) : wh_run_and_print(&arguments->run);
}

int wh_app_run(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.run.record = wh_record_arguments_path(&arguments.record, &arguments.run.record_option);
    const int status = arguments.watch ? wh_run_watch(&arguments.run, play, &arguments) : play(&arguments);
    wh_run_arguments_free(&arguments.run);
    return status;
}
