/* waferhand mcs [SCRIPT] [--layout FILE] */
#include <stdio.h>

#include "app.h"
#include "connection.h"
#include "mcs_prompt.h"
#include "prompt/input.h"
#include "run_arguments.h"

typedef struct {
    wh_run_arguments_t run;
    wh_mcs_link_options_t link;
    wh_live_arguments_t page;
    const char *layout;
    double timeout_s;     /* 0: for ever */
    uint64_t most_missed; /* NO_LIMIT: any number */
} arguments_t;

#define NO_LIMIT UINT64_MAX

static const wh_option_t options[] = {
    {"layout", 0, "FILE",
     "Take commands from a prompt and from WAFERHAND_REQUEST, in the cell of this layout", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, layout)},
    {"lcm-url", 0, "URL", "Where LCM is (default " WH_NODE_URL ")", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, link.url)},
    {"rate", 0, "FACTOR", "Run free at this factor of real time instead of in lockstep", WH_OPTION_REAL,
     .variable = offsetof(arguments_t, link.client.rate), 1e-3, 1e3},
    {"max-missed", 0, "N", "Fail if the simulator misses more than N slices; goes with --rate",
     WH_OPTION_WHOLE, .variable = offsetof(arguments_t, most_missed), 0, 1e15},
    {"timeout", 0, "S",
     "Wait at most S seconds for the simulator, at the beginning and when it falls silent (default: for "
     "ever)",
     WH_OPTION_REAL, .variable = offsetof(arguments_t, timeout_s), 1e-3, 1e6},
    {"outputs", 0, "FILE", "Write the valves to this file, too, one value per gripper", WH_OPTION_TEXT,
     .variable = offsetof(arguments_t, link.client.outputs)},
    {"log-time", 0, NULL,
     "Put time (UTC) and level before each line of standard error that begins with \"mcs:\"", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, link.log_time)},
    {0}};

static const wh_option_table_t tables[] = {
    {options, 0, NULL, NULL},
    {wh_record_options, offsetof(arguments_t, link.record), NULL, wh_record_arguments_check},
    {wh_run_options, offsetof(arguments_t, run), NULL, wh_run_arguments_check},
    {wh_run_files_options, offsetof(arguments_t, run.files), NULL, NULL},
    {wh_live_options, offsetof(arguments_t, page), NULL, wh_live_check},
    {0}};

/* True if an output is wanted that only a script's run has. */
static bool wants_run(const wh_run_arguments_t *run) {
    return run->json || wh_run_table_wanted(run) || run->segments_path || wh_run_files_wanted(&run->files);
}

static void check_mcs_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (!arguments->run.run.script && !arguments->layout) {
        argp_error(state, "which script, or which --layout?");
    }
    if (arguments->run.run.script && arguments->layout) {
        argp_error(state, "--layout: %s (a script names its layout itself)", arguments->layout);
    }
    if (arguments->most_missed != NO_LIMIT && arguments->link.client.rate <= 0) {
        argp_error(state, "--max-missed: %llu (goes with --rate: in lockstep no slice is missed)",
                   (unsigned long long)arguments->most_missed);
    }
    if (arguments->layout && wants_run(&arguments->run)) {
        argp_error(state,
                   "--json, --gantt, --cycle, --margins, --segments, --report, --gltf, --data and --svg "
                   "go with a script");
    }
}

static const wh_command_line_t command_line = {
    .name = "mcs",
    .synopsis = "SCRIPT\n--layout FILE",
    .about = "Motion control over LCM: plays a script against the simulator, or takes an operator's commands "
             "such as GET A 1 "
             "from standard input and WAFERHAND_REQUEST and answers each in one line. The simulator is "
             "another process at the same URL, waferhand sim LAYOUT, with the same layout; either may start "
             "first.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "script",
    .operand_variable = offsetof(arguments_t, run.run.script),
    .operand_may_lack = true,
    .check = check_mcs_arguments};

/* --------------------------------------------------------------------------------------------- the prompt */

/* A session's run has no expectations that would report it. */
static int judge_missed(const arguments_t *arguments, const wh_session_t *session, const wh_node_t *node,
                        int status) {
    wh_link_t *link = wh_mcs_link(&session->mcs);
    if (arguments->most_missed == NO_LIMIT) {
        return status;
    }
    (void)link->hash(link); /* waits for the last states */
    const int64_t missed = link->missed(link);
    if (missed <= (int64_t)arguments->most_missed) {
        return status;
    }
    wh_node_warn(node, "the simulator missed %lld slices (expected at most %llu: --max-missed)",
                 (long long)missed, (unsigned long long)arguments->most_missed);
    return status == WH_EXIT_MET ? WH_EXIT_FAILED : status;
}

static int run_prompt(const arguments_t *arguments, wh_mcs_link_t *link) {
    static wh_mcs_prompt_t prompt;
    wh_session_options_t wanted = {
        .layout = arguments->layout,
        .limits = arguments->run.run.limits,
        .parameters = arguments->run.run.parameters,
        .parameter_count = arguments->run.run.parameter_count,
        .is_of_hosts = true,
    };
    int status = WH_EXIT_USAGE;
    prompt.link = link;
    prompt.live = arguments->run.live;
    /* Standard output is for answers: what scripts print goes to standard error. */
    wanted.limits.print_to = stderr;
    if (wh_mcs_prompt_open(&prompt, &wanted)) {
        status = judge_missed(arguments, &prompt.session, &link->node, wh_mcs_prompt_run(&prompt));
    } else {
        fprintf(stderr, "%s\n", prompt.session.message);
    }
    link->control.owner = (wh_mcs_process_owner_t){0};
    wh_live_close(arguments->run.live); /* it has the session's layout */
    wh_session_close(&prompt.session);
    return status;
}

/* --------------------------------------------------------------------------------------------- subcommand */

static int run_script(arguments_t *arguments, wh_mcs_link_t *link) {
    wh_script_run_options_t *run = &arguments->run.run;
    link->control.script = run->script;
    arguments->run.recording = arguments->run.record ? &link->record : NULL;
    arguments->run.unwritten = &link->control.client.counters.unwritten;
    arguments->run.disturbance = link->control.client.disturbance;
    run->partners = wh_mcs_process_partners(&link->control);
    run->limits_missed = arguments->most_missed != NO_LIMIT;
    run->most_missed = run->limits_missed ? (int64_t)arguments->most_missed : 0;
    return wh_run_and_print(&arguments->run);
}

/* A script's page, which may hold motion control up. */
typedef struct {
    wh_mcs_link_t *link;
    wh_live_t *live;
} held_t;

/* While it stands still, others hear that motion control is there; a signal ends the pause. */
static void attend_pause(void *user) {
    const held_t *held = user;
    wh_mcs_process_idle(&held->link->control);
    if (wh_stop_requested) {
        wh_live_go_on(held->live);
    }
}

static void show_script(arguments_t *arguments, wh_mcs_link_t *link) {
    static held_t held;
    held = (held_t){link, arguments->run.live};
    link->control.owner.waits = wh_live_rest; /* for a simulator that is silent */
    link->control.owner.user = arguments->run.live;
    wh_live_set_attendant(held.live, attend_pause, &held);
}

/* A page whose slices wait here lets the cell move as fast as the wall clock, until it is told otherwise. */
static wh_live_options_t page_of(const arguments_t *arguments) {
    const bool runs_free = arguments->link.client.rate > 0;
    const bool paces = arguments->page.controls && !runs_free;
    return (wh_live_options_t){
        .speaker = "mcs",
        .title = arguments->layout ? arguments->layout : arguments->run.run.script,
        .controlled = arguments->layout ? WH_LIVE_PROMPT : WH_LIVE_RUN,
        .uncontrolled = runs_free && !arguments->layout
                            ? "motion control runs free, and nothing holds it up (expected no --rate)"
                            : NULL,
        .rate = paces ? 1 : arguments->link.client.rate,
        .paces = paces};
}

/* With a page, if one is wanted, which ends with the run. */
static int run(arguments_t *arguments, wh_mcs_link_t *link) {
    const wh_live_options_t wanted = page_of(arguments);
    if (!wh_live_open(&arguments->run.live, &arguments->page, &wanted)) {
        return WH_EXIT_USAGE;
    }
    if (arguments->layout) {
        return run_prompt(arguments, link);
    }
    if (arguments->run.live) {
        show_script(arguments, link);
    }
    return run_script(arguments, link);
}

int wh_app_mcs(int argc, char **argv) {
    static wh_mcs_link_t link;
    arguments_t arguments = {
        .link = {.client = {.stop = &wh_stop_requested, .interrupted = wh_interrupt_is_due}},
        .most_missed = NO_LIMIT};
    wh_options_parse(&command_line, argc, argv, &arguments);
    wh_run_arguments_take(&arguments.run);
    arguments.link.client.timeout_us = (int64_t)(arguments.timeout_s * 1e6);
    arguments.run.record = wh_record_arguments_path(&arguments.link.record, &arguments.run.record_option);
    arguments.run.outputs = arguments.link.client.outputs;
    int status = WH_EXIT_USAGE;
    if (wh_run_files_are_apart(&arguments.run, arguments.layout) &&
        wh_mcs_link_open(&link, &arguments.link)) {
        status = run(&arguments, &link);
        if (status == WH_EXIT_MET && link.control.client.counters.disturbed > 0) {
            status = WH_EXIT_FAILED;
        }
        if (status == WH_EXIT_FAILED && link.control.ended_with == WH_STATUS_NO_ANSWER) {
            status = WH_EXIT_NO_ANSWER;
        }
        status = wh_mcs_link_close(&link) ? status : WH_EXIT_USAGE;
    }
    wh_run_arguments_free(&arguments.run);
    return status;
}
