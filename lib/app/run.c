/* waferhand run SCRIPT */
#include "../link/mcs_process.h"
#include "../link/sim_process.h"
#include "app.h"
#include "run_arguments.h"

typedef struct {
    wh_run_arguments_t run;
    const char *url, *record;
    bool lcm;
} arguments_t;

static const wh_option_t options[] = {
    {"lcm", 0, NULL, "Publish over LCM what motion control and simulator would say to each other",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, lcm)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL "); goes with --lcm", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, url)},
    {"record", 0, "FILE", "Write these messages into an LCM event log; without --lcm no network is needed",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, record)},
    {0}};

static const wh_option_table_t tables[] = {{options, 0, NULL},
                                           {wh_run_options, offsetof(arguments_t, run), NULL},
                                           {wh_run_files_options, offsetof(arguments_t, run.files), NULL},
                                           {0}};

static const wh_command_line_t command_line = {
    .name = "run",
    .synopsis = "SCRIPT",
    .about =
        "Plays a motion script against the simulator and prints what came of it.\v"
        "Exit status: 0 if all expectations were met, 1 if the script's expectations or the cell failed, "
        "2 for wrong usage or a bad input file.",
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script)};

/* ---------------------------------------------------------------------------------------------- broadcast */

/* Motion control and simulator, coupled by calls, while all that would travel between them is published for
 * whoever watches, and recorded. */
typedef struct {
    wh_link_t link; /* first */
    wh_node_t node;
    wh_mcs_process_t control; /* tells the commands; its client is not used */
    wh_sim_process_t simulation;
    wh_link_identity_t identity;
    bool connected;
} broadcast_t;

/* The command goes out as a client would send it, but the simulator is called, so that nothing can be lost
 * between the two. */
static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    broadcast_t *broadcast = (broadcast_t *)link;
    waferhand_command message;
    wh_link_command_to_message(command, &broadcast->identity, true, &message);
    wh_protocol_client_publish(&broadcast->node, &message);
    broadcast->control.identity = broadcast->identity;
    broadcast->control.utime = command->utime;
    broadcast->control.seq = command->seq;
    return wh_sim_process_step(&broadcast->simulation, &message, state);
}

static uint64_t last_hash(wh_link_t *link) {
    return wh_protocol_server_hash(&((broadcast_t *)link)->simulation.server);
}

static int64_t missed_slices(wh_link_t *link) {
    (void)link;
    return 0;
}

static wh_link_t *connect_simulation(void *user, wh_mcs_t *mcs) {
    broadcast_t *broadcast = user;
    if (wh_sim_process_open(&broadcast->simulation, &broadcast->node, mcs->layout, false) != WH_OK) {
        return NULL;
    }
    broadcast->identity.run = wh_protocol_client_draw_run();
    broadcast->identity.layout_hash = broadcast->simulation.server.identity.layout_hash;
    broadcast->connected = true;
    return &broadcast->link;
}

static void watch(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended) {
    wh_mcs_process_t *control = &((broadcast_t *)user)->control;
    wh_mcs_process_partners(control).watch(control, mcs, command, ended);
}

static int run_on(broadcast_t *broadcast, wh_run_arguments_t *arguments) {
    const wh_mcs_partners_t partners = {.connect = connect_simulation, .watch = watch, .user = broadcast};
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
    if ((arguments->lcm && !wh_node_reaches_others(url)) ||
        !wh_node_open(&broadcast.node, url, arguments->record)) {
        return WH_EXIT_USAGE;
    }
    const int status = run_on(&broadcast, &arguments->run);
    wh_node_close(&broadcast.node);
    return status;
}

int wh_app_run(int argc, char **argv) {
    arguments_t arguments = {0};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    const bool published = arguments.lcm || arguments.record;
    const int status = published ? run_published(&arguments) : wh_run_and_print(&arguments.run);
    wh_run_arguments_free(&arguments.run);
    return status;
}
