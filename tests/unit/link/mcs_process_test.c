/* Requests to motion control: which clients wait, which are refused, and STOP, which waits for
 * nobody. Control, simulation and the clients are in one process, on memq. */
#include "support/support.h"

#include <inttypes.h>

#include "link/mcs_process.h"
#include "link/sim_process.h"
#include "mcs/session.h"
#include "reading/layout_read.h"

static wh_node_t node;
static wh_mcs_process_t control;
static wh_sim_process_t simulation;
static wh_session_t session;
static wh_sandbox_t *sandbox; /* the sandbox of the simulator's own layout */
static const wh_layout_t *simulated;
static char answer[WH_SESSION_ANSWER_BYTES];

/* Lines that are requested when the simulator has stepped `at`. */
static struct {
    int64_t at;
    const char *lines[20];
    size_t count;
    int64_t seq;
} plan;

/* The answers, by the requests' numbers; and the events of commands that a listener gets. */
static struct {
    int32_t error[64];
    int count[64];
    int64_t run[64];
    char text[WH_LINK_DATAGRAM]; /* the text of the last one */
    int begins, ends, overs;
    int answers_at_end; /* the answers when the run was over */
} heard;

/* The last proximity values that were published. */
static waferhand_proximity proximity;

/* The positions to which the command of each slice moves the axes. */
static double sent[10000][WH_ROBOT_AXES];

static void publish(waferhand_request message, const char *line) {
    uint8_t encoded[1200];
    char text[1100];
    snprintf(text, sizeof text, "%s", line);
    message.command_line = text;
    const int size = waferhand_request_encode(encoded, 0, (int)sizeof encoded, &message);
    assert_true(size > 0);
    assert_true(wh_node_publish(&node, WH_CHANNEL_REQUEST, encoded, (size_t)size));
}

static void publish_request(int64_t seq, const char *line) {
    const waferhand_request message = {.seq = seq};
    publish(message, line);
}

/* Motion control's own link, and the requests before the slice in which they are due. */
static wh_link_t asking;

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    (void)link;
    assert_in_range(command->seq, 1, 9999);
    memcpy(sent[command->seq], command->axes, sizeof sent[0]);
    for (size_t i = 0; command->seq >= plan.at && i < plan.count; ++i) {
        publish_request(++plan.seq, plan.lines[i]);
    }
    plan.count = command->seq >= plan.at ? 0 : plan.count;
    return control.client.link.exchange(&control.client.link, command, state);
}

static void assert_string_begins(const char *text, const char *begin) {
    if (strncmp(text, begin, strlen(begin)) != 0) {
        fail_msg("\"%s\" does not begin with \"%s\"", text, begin);
    }
}

static void assert_answer_is_spelt_as_all_are(const waferhand_mcs *message) {
    char begin[100];
    snprintf(begin, sizeof begin, "ERROR %d %s: ", message->error,
             wh_status_name((wh_status_t)message->error));
    if (message->phase == WH_LINK_PHASE_FAILED) {
        assert_string_begins(message->text, begin);
    }
}

static void on_mcs(void *user, const void *data, size_t size) {
    waferhand_mcs message;
    (void)user;
    assert_true(waferhand_mcs_decode(data, 0, (int)size, &message) > 0);
    const bool ends = message.phase == WH_LINK_PHASE_DONE || message.phase == WH_LINK_PHASE_FAILED;
    heard.begins += message.phase == WH_LINK_PHASE_BEGINS ? 1 : 0;
    heard.ends += ends && message.request == 0 ? 1 : 0;
    if (message.phase == WH_LINK_PHASE_OVER) {
        ++heard.overs;
        for (size_t i = 0; i < 64; ++i) {
            heard.answers_at_end += heard.count[i];
        }
        assert_int_equal(message.request, 0);
        assert_string_begins(message.text, "ended; commands ");
    }
    if (ends && message.request > 0 && message.request < 64) {
        heard.error[message.request] = message.error;
        heard.run[message.request] = message.run;
        ++heard.count[message.request];
        snprintf(heard.text, sizeof heard.text, "%s", message.text);
        assert_answer_is_spelt_as_all_are(&message);
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

static void on_proximity(void *user, const void *data, size_t size) {
    (void)user;
    assert_true(waferhand_proximity_decode(data, 0, (int)size, &proximity) > 0);
}

static wh_link_t *connect_all(void *user, wh_mcs_t *mcs) {
    /* After a RESET the same simulator goes on. */
    if (!control.connected) {
        assert_int_equal(wh_sim_process_open(&simulation, &node, simulated, true), WH_OK);
    }
    assert_ptr_equal(wh_mcs_process_partners(user).connect(user, mcs), &control.client.link);
    asking.exchange = exchange;
    return &asking;
}

static int open_all(void **state) {
    (void)state;
    const wh_protocol_client_options_t options = {.rate = 0};
    memset(&plan, 0, sizeof plan);
    memset(&heard, 0, sizeof heard);
    memset(&proximity, 0, sizeof proximity);
    sandbox = wh_sandbox_new(NULL);
    simulated = wh_layout_load(sandbox, "lua/layouts/paper.lua", NULL);
    assert_non_null(simulated);
    assert_true(wh_node_open(&node, "memq://", NULL));
    assert_true(wh_mcs_process_open(&control, &node, &options));
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_MCS, on_mcs, NULL));
    assert_true(wh_node_subscribe(&node, WH_CHANNEL_PROXIMITY, on_proximity, NULL));
    wh_session_options_t wanted = {.layout = "lua/layouts/paper.lua", .limits = {.print_to = stderr}};
    wanted.partners = wh_mcs_process_partners(&control);
    wanted.partners.connect = connect_all;
    return wh_session_open(&session, &wanted) ? 0 : -1;
}

static int close_all(void **state) {
    (void)state;
    wh_session_close(&session);
    wh_mcs_process_close(&control);
    wh_sim_process_close(&simulation);
    wh_node_close(&node);
    wh_sandbox_free(sandbox);
    return 0;
}

static wh_status_t execute(const char *line) {
    return wh_session_execute(&session, line, answer, sizeof answer);
}

/* The state of the program between the prompt's lines. */
static void execute_requests(void) {
    char line[WH_LINK_LINE];
    (void)wh_node_drain(&node, 1000);
    while (wh_mcs_process_next_request(&control, line)) {
        const wh_status_t status = execute(line);
        wh_mcs_process_answer(&control, status, answer);
    }
    (void)wh_node_drain(&node, 1000);
}

static void assert_heard(int64_t seq, wh_status_t error) {
    assert_int_equal(heard.count[seq], 1);
    assert_int_equal(heard.error[seq], error);
}

/* The command of which the simulator has last heard that it begins or goes on. */
static char line_begun[WH_LINK_LINE];

static void hear_begins(void *user, const waferhand_mcs *message) {
    (void)user;
    if (message->phase == WH_LINK_PHASE_BEGINS || message->phase == WH_LINK_PHASE_GOES_ON) {
        snprintf(line_begun, sizeof line_begun, "%s", message->command);
    }
}

static void the_simulator_hears_of_commands_that_begin(void **state) {
    (void)state;
    line_begun[0] = '\0';
    simulation.heard = hear_begins;
    assert_int_equal(execute("GET A 1"), WH_OK);
    (void)wh_node_drain(&node, 1000);
    assert_string_equal(line_begun, "GET A 1"); /* though it began before the simulator knew the run */
    assert_int_equal(execute("PUT B 2"), WH_OK);
    (void)wh_node_drain(&node, 1000);
    assert_string_equal(line_begun, "PUT B 2");

    uint8_t encoded[200];
    char line[] = "GET Z 1", nothing[] = "";
    const waferhand_mcs other = {
        .run = control.identity.run ^ 1, .phase = WH_LINK_PHASE_BEGINS, .command = line, .text = nothing};
    const int size = waferhand_mcs_encode(encoded, 0, (int)sizeof encoded, &other);
    assert_true(wh_node_publish(&node, WH_CHANNEL_MCS, encoded, (size_t)size));
    (void)wh_node_drain(&node, 1000);
    assert_string_equal(line_begun, "PUT B 2"); /* another motion control's */
}

static void requests_wait_for_their_turn(void **state) {
    (void)state;
    plan.at = 500;
    plan.count = 2;
    plan.lines[0] = "PUT B 2";
    plan.lines[1] = "GET B 2";
    assert_int_equal(execute("GET A 1"), WH_OK);
    execute_requests();
    assert_heard(1, WH_OK);
    assert_heard(2, WH_OK);
}

static void a_number_that_comes_again_is_answered_again_and_not_executed(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    execute_requests();
    publish_request(1, "GET A 1");
    execute_requests();
    assert_int_equal(heard.count[1], 2);
    assert_int_equal(heard.error[1], WH_OK);
}

static void a_number_with_another_line_is_refused_and_the_first_line_named(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    execute_requests();
    publish_request(1, "PUT B 2");
    execute_requests();
    assert_int_equal(heard.error[1], WH_STATUS_NUMBER_TAKEN);
    char expected[200];
    snprintf(expected, sizeof expected,
             "ERROR 84 NUMBER_TAKEN: the request's number was another request's; 1 was \"GET A 1\" in run "
             "%016llx (expected a number of its own for each line and run)",
             (unsigned long long)control.client.identity.run);
    assert_string_equal(heard.text, expected);
    publish_request(1, "GET A 1");
    execute_requests();
    assert_int_equal(heard.error[1], WH_OK);
    publish_request(2, "HOLDER \"Wafer 1\"");
    execute_requests();
    assert_string_equal(heard.text, "OK holder=EE");
}

/* While it is executed, and while it waits. */
static void a_number_is_taken_before_its_answer(void **state) {
    (void)state;
    plan.at = 500;
    plan.count = 1;
    plan.lines[0] = "PUT B 2";
    plan.seq = 4;
    publish_request(5, "GET A 1");
    execute_requests();
    assert_int_equal(heard.count[5], 2);
    assert_int_equal(heard.error[5], WH_OK);
    publish_request(6, "AXES");
    publish_request(6, "PUT B 2");
    execute_requests();
    assert_int_equal(heard.count[6], 2);
    assert_int_equal(heard.error[6], WH_OK);
}

/* Refused, and the answer names the run or the layout (a number) that is active here. */
static void assert_meant_for_another(waferhand_request request, const char *error, const char *what,
                                     uint64_t here) {
    char expected[200];
    publish(request, "GET A 1");
    execute_requests();
    snprintf(expected, sizeof expected,
             "ERROR %s: the request is for %s 0000000000003039 (expected this one, %016" PRIx64
             ", or 0 for any)",
             error, what, here);
    assert_string_equal(heard.text, expected);
}

static void a_request_for_another_run_or_layout_or_too_long_is_told_so(void **state) {
    (void)state;
    static char line[1050];
    const waferhand_request run = {.seq = 1, .run = 12345};
    const waferhand_request layout = {.seq = 2, .layout_hash = 12345};
    memset(line, 'A', sizeof line - 1);
    assert_meant_for_another(run, "80 UNKNOWN_RUN", "run", (uint64_t)control.client.identity.run);
    assert_meant_for_another(layout, "81 OTHER_LAYOUT", "layout", control.client.identity.layout_hash);
    publish_request(3, line);
    execute_requests();
    assert_heard(1, WH_STATUS_UNKNOWN_RUN);
    assert_heard(2, WH_STATUS_OTHER_LAYOUT);
    assert_heard(3, WH_STATUS_BAD_ARGUMENT);
    assert_string_equal(heard.text, "ERROR 48 BAD_ARGUMENT: the line is longer than 1000 bytes");
}

static void one_too_many_is_turned_away(void **state) {
    (void)state;
    plan.at = 500;
    plan.count = WH_CONTROL_REQUESTS + 1;
    for (size_t i = 0; i < plan.count; ++i) {
        plan.lines[i] = "AXES";
    }
    assert_int_equal(execute("GET A 1"), WH_OK);
    execute_requests();
    assert_heard(WH_CONTROL_REQUESTS, WH_OK);
    assert_heard(WH_CONTROL_REQUESTS + 1, WH_STATUS_BUSY);
}

/* It ends the running command and the waiting ones; then the arm must be recovered, by any client. */
static void stop_goes_past_the_queue(void **state) {
    (void)state;
    plan.at = 700;
    plan.count = 3;
    plan.lines[0] = "GET A 2";
    plan.lines[1] = "MOVE z=1000";
    plan.lines[2] = " stop ";
    assert_int_equal(execute("GET A 1"), WH_STATUS_STOPPED);
    assert_in_range(wh_session_slice(&session), 700, 710);
    execute_requests();
    assert_heard(1, WH_STATUS_STOPPED);
    assert_heard(2, WH_STATUS_STOPPED);
    assert_heard(3, WH_OK);
    assert_int_equal(control.running_count, 0);
    assert_int_equal(execute("GET A 1"), WH_STATUS_STOPPED);
    assert_int_equal(execute("RECOVER"), WH_OK);
    assert_int_equal(execute("GET A 1"), WH_OK);
}

/* It ends the command that has the mechanism, and not the waiting ones. */
static void stop_of_a_mechanism_is_of_that_alone(void **state) {
    (void)state;
    plan.at = 700;
    plan.count = 4;
    plan.lines[0] = "STOP P";
    plan.lines[1] = "stop nobody";
    plan.lines[2] = "MOVE z=1000";
    plan.lines[3] = "stop  \"PA\" ";
    assert_int_equal(execute("GET A 1"), WH_OK);
    execute_requests();
    assert_heard(1, WH_OK);
    assert_heard(2, WH_STATUS_BAD_ARGUMENT);
    assert_heard(3, WH_OK);
    assert_heard(4, WH_OK);
}

static void stop_of_the_robot_ends_its_command(void **state) {
    (void)state;
    plan.at = 700;
    plan.count = 1;
    plan.lines[0] = "STOP Robot";
    assert_int_equal(execute("GET A 1"), WH_STATUS_STOPPED);
    assert_in_range(wh_session_slice(&session), 700, 710);
}

/* All came together: the command has not begun when the STOP is read. */
static void stop_is_no_later_than_what_waits(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    publish_request(2, "MOVE z=1000");
    publish_request(3, "STOP");
    execute_requests();
    assert_heard(1, WH_STATUS_STOPPED);
    assert_heard(2, WH_STATUS_STOPPED);
    assert_heard(3, WH_OK);
    assert_int_equal(wh_session_slice(&session), 0);
    publish_request(4, "GET A 1");
    execute_requests();
    assert_heard(4, WH_OK); /* nothing was cut short */
}

static void stop_of_nothing(void **state) {
    (void)state;
    publish_request(7, "STOP");
    execute_requests();
    assert_heard(7, WH_OK);
    plan.at = 700;
    plan.count = 1;
    plan.lines[0] = "STOP NOW";
    assert_int_equal(execute("GET A 1"), WH_OK);
    execute_requests();
    assert_heard(1, WH_STATUS_BAD_ARGUMENT);
}

/* ------------------------------------------------------------------------------- STATUS, VERSION, RESET, scripts
 */

static void status_and_version_are_answered_while_a_command_runs(void **state) {
    (void)state;
    plan.at = 1500;
    plan.count = 2;
    plan.lines[0] = "VERSION";
    plan.lines[1] = "status";
    assert_int_equal(execute("GET A 1"), WH_OK);
    assert_heard(1, WH_OK);
    assert_heard(2, WH_OK);
    assert_non_null(strstr(heard.text, "OK phase=running command=\"GET A 1\" seq="));
    assert_non_null(strstr(heard.text, " EE.holds=\"Wafer 1\" PA.holds=none error=0"));
    publish_request(3, "VERSION");
    execute_requests();
    assert_string_equal(heard.text, "OK version=" WH_VERSION);
}

/* Its answer describes the moment, and does not remove any other answer. */
static void status_is_answered_anew_each_time(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    execute_requests();
    for (int i = 0; i < 2 * WH_CONTROL_ANSWERED; ++i) {
        publish_request(2, "STATUS");
        execute_requests();
    }
    assert_int_equal(heard.count[2], 2 * WH_CONTROL_ANSWERED);
    assert_non_null(strstr(heard.text, "phase=idle seq=1965 time=1.965 "));
    publish_request(1, "GET A 1");
    execute_requests();
    assert_int_equal(heard.count[1], 2);
    assert_int_equal(heard.error[1], WH_OK);
    assert_int_equal(execute("GET A 2"), WH_STATUS_WAFER_ON_GRIPPER);
    publish_request(2, "STATUS");
    execute_requests();
    assert_non_null(strstr(heard.text, " error=44 error_name=WAFER_ON_GRIPPER error_command=\"GET A 2\""));
}

static void reset_begins_another_run_for_both(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    publish_request(2, " reset ");
    publish_request(3, "HOLDER \"Wafer 1\"");
    (void)wh_node_drain(&node, 1000);
    const int64_t run = control.client.identity.run;
    execute_requests();
    assert_heard(1, WH_OK);
    assert_heard(2, WH_OK);
    assert_string_equal(heard.text, "OK holder=none");
    assert_true(control.client.identity.run != run);
    assert_int_equal(execute("GET A 1"), WH_OK);
    assert_true(simulation.server.identity.run == control.client.identity.run);
    assert_int_equal(simulation.server.seq, 1965);
    publish_request(2, "RESET");
    execute_requests();
    assert_int_equal(heard.error[2], WH_STATUS_NUMBER_TAKEN);
}

static void publish_for(int64_t run, int64_t seq, const char *line) {
    const waferhand_request message = {.seq = seq, .run = run};
    publish(message, line);
}

static void what_waits_for_a_run_is_not_executed_in_the_next_one(void **state) {
    (void)state;
    const int64_t run = control.client.identity.run;
    publish_for(run, 1, "WAIT 0.1");
    publish_for(0, 2, "RESET");
    publish_for(run, 3, "MOVE theta=4");
    publish_for(run, 4, "GET A 2");
    publish_for(0, 5, "WAIT 0.1");
    execute_requests();
    assert_heard(1, WH_OK);
    assert_heard(2, WH_OK);
    assert_heard(3, WH_STATUS_UNKNOWN_RUN);
    assert_heard(4, WH_STATUS_UNKNOWN_RUN);
    assert_heard(5, WH_OK);
    assert_int_equal(wh_session_slice(&session), 100);
    assert_true(session.mcs.track.axes[WH_AXIS_THETA] == 0);
    /* It was not executed, so it may be executed in the current run. */
    publish_for(control.client.identity.run, 3, "MOVE theta=4");
    execute_requests();
    assert_int_equal(heard.count[3], 2);
    assert_int_equal(heard.error[3], WH_OK);
}

static void what_was_answered_before_a_reset_is_answered_again_after_it(void **state) {
    (void)state;
    const int64_t run = control.client.identity.run;
    publish_for(run, 1, "GET A 1");
    publish_for(0, 2, "PUT B 2");
    publish_for(run, 3, "RESET");
    execute_requests();
    const int64_t next = control.client.identity.run;
    assert_true(next != run);
    publish_for(run, 1, "GET A 1");
    publish_for(0, 1, "GET A 1");
    publish_for(run, 2, "PUT B 2"); /* it was for any run, and executed in this one */
    publish_for(run, 3, "RESET");
    publish_for(next, 3, "RESET");
    execute_requests();
    assert_int_equal(heard.count[1], 3);
    assert_int_equal(heard.count[2], 2);
    assert_int_equal(heard.count[3], 3);
    for (int seq = 1; seq <= 3; ++seq) {
        assert_int_equal(heard.error[seq], WH_OK);
        assert_true(heard.run[seq] == (seq < 3 ? run : next)); /* with the run in which it was answered */
    }
    assert_true(control.client.identity.run == next);
    assert_int_equal(wh_session_slice(&session), 0);
    /* Treated as if it had been executed in the current run: refused. */
    publish_for(next, 1, "GET A 1");
    execute_requests();
    assert_int_equal(heard.error[1], WH_STATUS_NUMBER_TAKEN);
    assert_int_equal(wh_session_slice(&session), 0);
}

/* A client is answered by number, perhaps again and again; commands begin and end without a number. */
static void a_listener_can_count_commands(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    publish_request(2, "AXES");
    publish_request(3, "GET Q 1");
    publish_request(4, "PUT B 2");
    execute_requests();
    publish_request(1, "GET A 1");
    publish_request(5, "STATUS");
    assert_int_equal(execute("WAIT 0.1"), WH_OK);
    execute_requests();
    assert_int_equal(heard.begins, 4);
    assert_int_equal(heard.ends, 4);
    assert_int_equal(heard.count[1], 2);
    assert_int_equal(control.outcome.commands, 4);
    publish_request(6, "RESET");
    execute_requests();
    assert_int_equal(heard.overs, 1);
    assert_int_equal(heard.begins, heard.ends);
}

/* The value behind a name in the last text; NaN if it is not there. */
static double told(const char *name) {
    const char *at = strstr(heard.text, name);
    return at ? strtod(at + strlen(name), NULL) : (double)NAN;
}

/* The number of slices in a GET for which values were asked at this rate. */
static void assert_status_tells_one_slice(double rate, int64_t first_seq, int64_t step) {
    int64_t seq = first_seq;
    control.client.options.rate = rate;
    control.options.rate = rate;
    for (int64_t at = 1; at < 1965; at += at < 4 ? 1 : step) {
        publish_request(++seq, "RESET");
        execute_requests();
        assert_heard(seq, WH_OK);
        plan.at = at;
        plan.seq = seq++;
        plan.count = 1;
        plan.lines[0] = "STATUS";
        memcpy(sent[0], session.mcs.track.axes, sizeof sent[0]);
        assert_int_equal(execute("GET A 1"), WH_OK);
        assert_heard(seq, WH_OK);
        const size_t slice = (size_t)told(" seq=");
        assert_true(rate > 0 ? slice < (size_t)at : slice == (size_t)at - 1);
        assert_true(told(" time=") == (double)slice / 1000);
        assert_true(told(" r=") == sent[slice][WH_AXIS_R]);
        assert_true(told(" z=") == sent[slice][WH_AXIS_Z]);
    }
}

static void status_tells_one_slice_while_a_command_runs(void **state) {
    (void)state;
    assert_status_tells_one_slice(0, 0, 117);
    if (WH_TEST_SHARE == 1) {
        assert_status_tells_one_slice(100, 45, 480);
    }
}

/* The axes were commanded to move, but no state has shown them. */
static void status_tells_no_slice_that_no_state_came_for(void **state) {
    (void)state;
    simulation.server.identity.layout_hash ^= 1;
    assert_int_equal(execute("MOVE r=400"), WH_STATUS_OTHER_LAYOUT);
    publish_request(1, "STATUS");
    execute_requests();
    assert_true(told(" seq=") == 0 && told(" time=") == 0 && told(" r=") == 300);
    simulation.server.identity.layout_hash ^= 1;
}

static void a_datagram_that_is_no_request_is_answered_if_it_has_a_number(void **state) {
    (void)state;
    uint8_t encoded[200];
    char text[] = "GET A 1";
    const waferhand_request message = {.seq = 9, .command_line = text};
    const size_t size = (size_t)waferhand_request_encode(encoded, 0, (int)sizeof encoded, &message);
    encoded[size - 4] = '\0'; /* within the line */
    assert_true(wh_node_publish(&node, WH_CHANNEL_REQUEST, encoded, size));
    execute_requests();
    assert_heard(9, WH_STATUS_BAD_ARGUMENT);
    assert_string_begins(heard.text, "ERROR 48 BAD_ARGUMENT: a datagram of 52 bytes is no whole request (");
    assert_true(wh_node_publish(&node, WH_CHANNEL_REQUEST, encoded, 40));
    execute_requests();
    assert_int_equal(heard.count[9], 2);
    assert_true(wh_node_publish(&node, WH_CHANNEL_REQUEST, encoded, 39)); /* too short */
    encoded[0] ^= 1;                                                      /* another message */
    assert_true(wh_node_publish(&node, WH_CHANNEL_REQUEST, encoded, size));
    execute_requests();
    assert_int_equal(heard.count[9], 2);
    assert_int_equal(control.requests.garbage, 4);
    publish_request(9, "GET A 1");
    execute_requests();
    assert_int_equal(heard.error[9], WH_OK);
}

static int warnings;

static void count_warnings(void *user, const char *line) {
    (void)user;
    warnings += strstr(line, "two motion controls are at this URL") ? 1 : 0;
}

/* Each has a socket of its own. Its own messages come back to it. */
static void another_motion_control_is_noticed_and_one_before_is_not(void **state) {
    (void)state;
    uint8_t encoded[200];
    char nothing[] = "";
    const waferhand_mcs other = {.run = 12345, .command = nothing, .text = nothing};
    const size_t size = (size_t)waferhand_mcs_encode(encoded, 0, (int)sizeof encoded, &other);
    const uint64_t senders[] = {7, 7, 8, 8, 8, 7, 8};
    warnings = 0;
    node.speaker = "mcs";
    node.listener = count_warnings;
    for (size_t i = 0; i < sizeof senders / sizeof senders[0]; ++i) {
        assert_int_equal(warnings, i > 5 ? 1 : 0);
        assert_true(wh_node_publish(&node, WH_CHANNEL_MCS, encoded, size));
        node.sender = senders[i];
        (void)wh_node_drain(&node, 1000);
    }
    assert_int_equal(warnings, 1);
}

static void the_proximity_values_of_the_last_slice_are_told_at_rest(void **state) {
    (void)state;
    static const char *const lines[] = {"GET A 1", "MOVE z=950", "MOVE theta=30", "WAIT 0.003"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_int_equal(execute(lines[i]), WH_OK);
        simulation.last_proximity_us -= WH_SIMULATION_PROXIMITY_US; /* so much later */
        wh_sim_process_tick(&simulation);
        (void)wh_node_drain(&node, 1000);
        assert_int_equal(proximity.seq, wh_session_slice(&session));
        const int64_t told_us = simulation.last_proximity_us;
        wh_sim_process_tick(&simulation);
        assert_true(simulation.last_proximity_us == told_us); /* once */
    }
}

static void a_script_takes_no_requests_but_stop(void **state) {
    (void)state;
    control.script = "some/script.lua";
    plan.at = 500;
    plan.count = 2;
    plan.lines[0] = "GET A 2";
    plan.lines[1] = "STATUS";
    assert_int_equal(execute("GET A 1"), WH_OK);
    assert_heard(1, WH_STATUS_BUSY);
    assert_heard(2, WH_OK);
    publish_request(3, "RESET");
    (void)wh_node_drain(&node, 1000);
    assert_heard(3, WH_STATUS_BUSY);
    assert_string_equal(
        heard.text, "ERROR 54 BUSY: RESET puts back a cell and a prompt; the script some/script.lua runs, "
                    "and where it and its flow are cannot be put back (expected STATUS, VERSION, STOP, "
                    "or HOLD and CONTINUE in a flow)");
    publish_request(31, "save HERE");
    (void)wh_node_drain(&node, 1000);
    assert_heard(31, WH_STATUS_BUSY);
    assert_non_null(strstr(heard.text, "SAVE puts back"));
    publish_request(32, "SAVED");
    (void)wh_node_drain(&node, 1000);
    assert_string_equal(heard.text,
                        "ERROR 54 BUSY: another command is being executed; the script some/script.lua runs "
                        "(expected STATUS, VERSION, STOP, or HOLD and CONTINUE in a flow)");
    publish_request(33, "HOLD VAC");
    (void)wh_node_drain(&node, 1000);
    assert_heard(33, WH_STATUS_NOT_IN_PHASE);
    publish_request(34, "continue");
    (void)wh_node_drain(&node, 1000);
    assert_heard(34, WH_STATUS_NOT_IN_PHASE);
    assert_non_null(strstr(heard.text, "no flow carries wafers now"));
    /* Between two commands: the next one does not begin to move. */
    publish_request(4, "STOP");
    (void)wh_node_drain(&node, 1000);
    assert_heard(4, WH_OK);
    const int64_t slice = wh_session_slice(&session);
    assert_int_equal(execute("MOVE z=1000"), WH_STATUS_STOPPED);
    assert_non_null(strstr(answer, "; by a request"));
    assert_int_equal(wh_session_slice(&session), slice);
    assert_int_equal(execute("MOVE z=1000"), WH_OK);
}

static void an_answer_is_whole_or_tells_that_it_was_cut(void **state) {
    (void)state;
    static char text[80001];
    char line[WH_LINK_LINE];
    memset(text, 'x', 50000);
    publish_request(1, "WHERE");
    publish_request(2, "WHERE");
    (void)wh_node_drain(&node, 1000);
    assert_true(wh_mcs_process_next_request(&control, line));
    wh_mcs_process_answer(&control, WH_OK, text);
    (void)wh_node_drain(&node, 1000);
    assert_string_equal(heard.text, text);
    memset(text, 'x', sizeof text - 1);
    assert_true(wh_mcs_process_next_request(&control, line));
    wh_mcs_process_answer(&control, WH_OK, text);
    (void)wh_node_drain(&node, 1000);
    assert_heard(2, WH_OK);
    const size_t kept = strspn(heard.text, "x");
    char expected[100];
    snprintf(expected, sizeof expected, "... (cut: the first %zu bytes of 80000)", kept);
    assert_string_equal(heard.text + kept, expected);
    assert_in_range(kept, 64000, 65499);
}

static void requests_that_wait_when_all_ends_are_told_so(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    (void)wh_node_drain(&node, 1000);
    wh_mcs_process_finish(&control);
    (void)wh_node_drain(&node, 1000);
    assert_heard(1, WH_STATUS_STOPPED);
    assert_string_equal(heard.text,
                        "ERROR 52 STOPPED: the command was stopped before its end; it waited and was not "
                        "begun");
}

/* The run's layout may be gone by then, so nothing of a state may be compared with it. */
static void a_second_answer_that_comes_when_all_ends_is_not_taken(void **state) {
    (void)state;
    assert_int_equal(execute("GET A 1"), WH_OK);
    const wh_protocol_client_counters_t before = control.client.counters;
    wh_protocol_client_publish(&node, &control.client.command);
    wh_mcs_process_finish(&control);
    assert_null(control.client.layout);
    assert_int_equal(control.client.counters.unasked, before.unasked + 1);
    assert_int_equal(control.client.counters.answers, before.answers);
}

/* A script may compute for a long time after its last command, and receives nothing in the meantime. */
static void what_came_after_the_last_command_is_answered_at_the_end(void **state) {
    (void)state;
    const waferhand_request elsewhere = {.seq = 3, .run = 4711};
    control.script = "some/script.lua";
    assert_int_equal(execute("GET A 1"), WH_OK);
    publish_request(1, "STATUS");
    publish_request(2, "GET A 2");
    publish(elsewhere, "VERSION");
    publish_request(4, "STOP");
    wh_mcs_process_finish(&control);
    (void)wh_node_drain(&node, 1000);
    assert_heard(1, WH_OK);
    assert_heard(2, WH_STATUS_BUSY);
    assert_heard(3, WH_STATUS_UNKNOWN_RUN);
    assert_heard(4, WH_OK);
    assert_int_equal(heard.overs, 1);
    assert_int_equal(heard.answers_at_end, 4);
}

/* A signal ends these: the waiting request, and one that has arrived but has not been read yet. */
static void requests_that_wait_are_stopped_with_those_that_have_come(void **state) {
    (void)state;
    publish_request(1, "GET A 1");
    (void)wh_node_drain(&node, 1000);
    publish_request(2, "GET A 2");
    wh_mcs_process_stop_waiting(&control);
    execute_requests();
    assert_heard(1, WH_STATUS_STOPPED);
    assert_heard(2, WH_STATUS_STOPPED);
    assert_int_equal(wh_session_slice(&session), 0);
}

/* It has received nothing about a command since it began, but motion control is there. */
static void a_simulator_that_was_given_its_state_back_does_not_call_motion_control_silent(void **state) {
    (void)state;
    assert_int_equal(execute("WAIT 0.1"), WH_OK);
    simulation.server.identity.run = 12345;
    simulation.server.seq = 0;
    simulation.last_command_us = 0;
    control.last_beat_us = 0;
    wh_mcs_process_idle(&control);
    for (int i = 0; i < 10 && simulation.server.counters.restored == 0; ++i) {
        wh_protocol_client_heartbeat(&control.client);
        (void)wh_node_drain(&node, 1000);
        if (simulation.server.counters.restored == 1) {
            wh_sim_process_tick(&simulation);
        }
    }
    assert_int_equal(simulation.server.counters.restored, 1);
    assert_int_equal(simulation.counters.silences, 0);
}

#define IN_PAPER(test) cmocka_unit_test_setup_teardown(test, open_all, close_all)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_PAPER(the_simulator_hears_of_commands_that_begin),
        IN_PAPER(requests_wait_for_their_turn),
        IN_PAPER(a_number_that_comes_again_is_answered_again_and_not_executed),
        IN_PAPER(a_number_with_another_line_is_refused_and_the_first_line_named),
        IN_PAPER(a_number_is_taken_before_its_answer),
        IN_PAPER(a_request_for_another_run_or_layout_or_too_long_is_told_so),
        IN_PAPER(one_too_many_is_turned_away),
        IN_PAPER(stop_goes_past_the_queue),
        IN_PAPER(stop_of_a_mechanism_is_of_that_alone),
        IN_PAPER(stop_of_the_robot_ends_its_command),
        IN_PAPER(stop_is_no_later_than_what_waits),
        IN_PAPER(stop_of_nothing),
        IN_PAPER(what_waits_for_a_run_is_not_executed_in_the_next_one),
        IN_PAPER(what_was_answered_before_a_reset_is_answered_again_after_it),
        IN_PAPER(a_listener_can_count_commands),
        IN_PAPER(status_tells_one_slice_while_a_command_runs),
        IN_PAPER(status_tells_no_slice_that_no_state_came_for),
        IN_PAPER(a_datagram_that_is_no_request_is_answered_if_it_has_a_number),
        IN_PAPER(another_motion_control_is_noticed_and_one_before_is_not),
        IN_PAPER(the_proximity_values_of_the_last_slice_are_told_at_rest),
        IN_PAPER(requests_that_wait_are_stopped_with_those_that_have_come),
        IN_PAPER(status_and_version_are_answered_while_a_command_runs),
        IN_PAPER(status_is_answered_anew_each_time),
        IN_PAPER(reset_begins_another_run_for_both),
        IN_PAPER(a_script_takes_no_requests_but_stop),
        IN_PAPER(an_answer_is_whole_or_tells_that_it_was_cut),
        IN_PAPER(requests_that_wait_when_all_ends_are_told_so),
        IN_PAPER(a_second_answer_that_comes_when_all_ends_is_not_taken),
        IN_PAPER(what_came_after_the_last_command_is_answered_at_the_end),
        IN_PAPER(a_simulator_that_was_given_its_state_back_does_not_call_motion_control_silent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
