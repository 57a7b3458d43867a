/* Commands against a cell whose sensors lie, two blades, and a judge that looks ahead. */
#include "support/support.h"

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

/* A link that does what the simulator does and then spoils the sensors. */
static struct {
    wh_link_t link;
    wh_link_t *simulator;
    uint32_t forced_off, forced_on;
    int64_t from, until; /* slices in which it does; until 0: none */
    int64_t slices;
} liar;

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *out) {
    (void)link;
    const wh_status_t status = liar.simulator->exchange(liar.simulator, command, out);
    ++liar.slices;
    if (command->seq >= liar.from && command->seq < liar.until) {
        out->sensors = (out->sensors & ~liar.forced_off) | liar.forced_on;
    }
    return status;
}

static uint64_t hash(wh_link_t *link) {
    (void)link;
    return liar.simulator->hash(liar.simulator);
}

static wh_link_t *connect_liar(void *user, wh_mcs_t *mcs) {
    (void)user;
    liar.simulator = mcs->link;
    liar.link.exchange = exchange;
    liar.link.hash = hash;
    return &liar.link;
}

static int open_dual(void **state) {
    (void)state;
    memset(&liar, 0, sizeof liar);
    const wh_session_options_t options = {.layout = "lua/layouts/dual.lua",
                                          .limits = {.print_to = stderr},
                                          .partners = {.connect = connect_liar}};
    return wh_session_open(&session, &options) ? 0 : -1;
}

static int close_session(void **state) {
    (void)state;
    wh_session_close(&session);
    return 0;
}

/* From now on, for so many slices, the sensors of gripper 0 are on or off. */
static void lie(bool on, int64_t slices) {
    liar.forced_on = on ? 1 : 0;
    liar.forced_off = on ? 0 : 1;
    liar.from = session.mcs.track.slice;
    liar.until = slices == 0 ? INT64_MAX : liar.from + slices;
}

static void tell_the_truth(void) {
    liar.until = 0;
}

static void assert_answer(const char *line, const char *expected) {
    const wh_status_t status = wh_session_execute(&session, line, answer, sizeof answer);
    if (strncmp(answer, expected, strlen(expected)) != 0) {
        fail_msg("%s: answered %s, expected %s", line, answer, expected);
    }
    assert_int_equal(status == WH_OK, strncmp(answer, "OK", 2) == 0);
}

/* ------------------------------------------------------------------------------------------------- vacuum */

/* The blade goes down again before it leaves: the wafer stays in its slot, and the robot is ready for more. */
static void a_vacuum_that_does_not_come(void **state) {
    (void)state;
    lie(false, 0);
    assert_answer("GET A 1", "ERROR 57 VACUUM_TIMEOUT: ");
    tell_the_truth();
    assert_answer("WHERE \"Wafer 1\"", "OK wafer=\"Wafer 1\" holder=none station=A slot=1 dx=0 dy=");
    assert_int_equal(session.complaints, 0);
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\"");
}

static void a_vacuum_that_does_not_come_from_a_chuck(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK");
    assert_answer("PUT P 1", "OK");
    lie(false, 0);
    assert_answer("GET P 1", "ERROR 57 VACUUM_TIMEOUT: ");
    tell_the_truth();
    assert_answer("HOLDER \"Wafer 1\"", "OK holder=PA");
    assert_answer("GET P 1 handover=same_slice", "OK wafer=\"Wafer 1\"");
}

static void a_retry_takes_what_the_first_try_did_not(void **state) {
    (void)state;
    assert_answer("READY A 1", "OK");
    lie(false, 1700);
    assert_answer("GET A 1", "ERROR 57 ");
    lie(false, 1700);
    assert_answer("GET A 1 retries=1", "OK wafer=\"Wafer 1\"");
    assert_int_equal(session.complaints, 0);
}

static void a_sensor_that_is_on_too_early(void **state) {
    (void)state;
    lie(true, 0);
    assert_answer("WAIT 0.1", "OK");
    const int64_t slices = liar.slices;
    assert_answer("GET A 1", "ERROR 58 VACUUM_BEFORE_PICK: ");
    assert_int_equal(liar.slices, slices);
    assert_answer("VALVE FRONT 0", "OK");
    assert_answer("GET A 1", "ERROR 44 WAFER_ON_GRIPPER: ");
}

static void a_wafer_is_lost_on_the_way(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK");
    lie(false, 1);
    liar.from += 900;
    liar.until += 900;
    assert_answer("PUT B 1 gripper=FRONT",
                  "ERROR 60 WAFER_LOST_ON_WAY: the wafer was lost on the way; the sensor of FRONT went "
                  "off on the way into B slot 1");
    assert_int_equal(session.mcs.track.valves[0], WH_VALVE_OPEN);
}

/* Lost on the way in: the arm stands in the station, and nothing else goes in before it is out. */
static void a_wafer_is_lost_in_a_station(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK");
    assert_answer("READY B 1 gripper=FRONT", "OK");
    lie(false, 1);
    liar.from += 300;
    liar.until += 300;
    assert_answer("PUT B 1 gripper=FRONT", "ERROR 60 ");
    assert_answer("PUT B 1 gripper=FRONT", "ERROR 52 STOPPED: ");
    assert_answer("MAP A", "ERROR 52 STOPPED: ");
    assert_answer("RECOVER", "OK");
    assert_answer("PUT B 1 gripper=FRONT", "OK wafer=\"Wafer 1\"");
}

static void a_sensor_that_is_not_asked(void **state) {
    (void)state;
    lie(false, 0);
    assert_answer("GET A 1 vacuum_check=put", "OK wafer=\"Wafer 1\"");
    assert_answer("PUT A 4", "ERROR 43 ");
    assert_answer("PUT A 4 vacuum_check=get", "OK wafer=\"Wafer 1\"");
    tell_the_truth();
    assert_answer("GET A 5 vacuum_check=none", "OK wafer=none");
    assert_answer("PUT A 5 vacuum_check=none", "OK wafer=none");
}

/* --------------------------------------------------------------------------------------------- two blades */

static void swap(void **state) {
    (void)state;
    assert_answer("SWAP A 2", "ERROR 43 ");
    assert_answer("GET A 1", "OK");
    assert_answer("SWAP A 2", "OK wafer=\"Wafer 2\" put=\"Wafer 1\" seconds=");
    assert_answer("HOLDER \"Wafer 2\"", "OK holder=BACK");
    assert_answer("OFFSET \"Wafer 1\" A 2", "OK dx=");
    assert_answer("PUT A 2 gripper=BACK", "ERROR 56 WAFER_ALREADY_THERE: ");
    /* The empty blade finds nothing: the other keeps what it has. */
    assert_answer("SWAP A 4", "ERROR 42 ");
    assert_answer("HOLDER \"Wafer 2\"", "OK holder=BACK");
    assert_answer("SWAP A 2", "OK wafer=\"Wafer 1\" put=\"Wafer 2\"");
    assert_answer("GET B 3", "OK wafer=\"Wafer 3\"");
    assert_answer("SWAP A 2", "ERROR 44 ");
    assert_int_equal(session.complaints, 0);
}

static void map(void **state) {
    (void)state;
    assert_answer("MAP A", "OK codes=11000 seconds=");
    assert_answer("GET A 3", "ERROR 42 WAFER_MISSING: ");
    assert_answer("GET A 1", "OK");
    assert_answer("PUT A 2", "ERROR 56 WAFER_ALREADY_THERE: ");
    assert_answer("PUT A 2 force=maybe", "ERROR 48 ");
    assert_answer("PUT A 3", "OK");
    assert_answer("MAP A map_speed=50", "OK codes=01100 seconds=");
    assert_answer("GET A 1 force=true", "ERROR 42 ");
    assert_answer("MAP P", "OK codes=0 ");
    assert_answer("GET A 3 check_map=true", "OK");
    assert_answer("PUT B 3 gripper=FRONT check_map=true", "ERROR 63 NOT_MAPPED: ");
}

static void parameters_of_one_command(void **state) {
    (void)state;
    assert_answer("READY A 1", "OK seconds=");
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\" seconds=1.5");
    assert_answer("PUT A 1", "OK");
    assert_answer("READY A 1", "OK");
    assert_answer("GET A 1 wait=2", "OK wafer=\"Wafer 1\" seconds=3.5");
    assert_answer("PUT A 1", "OK");
    assert_answer("READY A 1", "OK");
    assert_answer("GET A 1 pickup_acceleration=10", "OK wafer=\"Wafer 1\" seconds=2.");
    assert_answer("PUT A 1 retries=0.5", "ERROR 48 ");
    assert_answer("PUT A 1 pickup_acceleration=-1", "ERROR 48 ");
}

/* -------------------------------------------------------------------------------------------- looking ahead */

static struct {
    size_t asked, refused_line;
    int64_t slice;
} judge;

static bool judge_segment(void *user, const wh_track_t *track, const wh_state_t *state, bool first,
                          char *reason) {
    assert_ptr_equal(user, &judge);
    assert_true(session.mcs.rehearsal.is_on);
    assert_int_equal(track->slice, judge.slice);
    assert_int_equal(state->seq, judge.slice);
    assert_int_equal(first, session.mcs.rehearsal.count == 0);
    ++judge.asked;
    if (track->segment.kind == WH_SEGMENT_LINE && judge.refused_line > 0 && --judge.refused_line == 0) {
        snprintf(reason, WH_REHEARSAL_REASON_BYTES, "the blade would meet the moon");
        return true;
    }
    return false;
}

static void a_collision_ahead(void **state) {
    (void)state;
    session.mcs.rehearsal.look_ahead = judge_segment;
    session.mcs.rehearsal.look_ahead_user = &judge;
    memset(&judge, 0, sizeof judge);
    judge.refused_line = 3;
    assert_answer("GET A 1",
                  "ERROR 61 COLLISION_AHEAD: the motion would collide; on the way out of A slot 1: the "
                  "blade would meet the moon");
    assert_int_equal(session.mcs.track.slice, 0);
    assert_int_equal(liar.slices, 0);
    assert_answer("AXES", "OK theta=0 r=150 z=900 yaw=0 ");
    judge.asked = 0;
    assert_answer("GET A 1", "OK");
    assert_int_equal(judge.asked, 6);
    judge.slice = session.mcs.track.slice;
    judge.refused_line = 1;
    assert_answer("LINE dz=1", "ERROR 61 ");
    assert_answer("LINE dz=1", "OK");
}

#define IN_DUAL(test) cmocka_unit_test_setup_teardown(test, open_dual, close_session)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_DUAL(a_vacuum_that_does_not_come),
        IN_DUAL(a_vacuum_that_does_not_come_from_a_chuck),
        IN_DUAL(a_retry_takes_what_the_first_try_did_not),
        IN_DUAL(a_sensor_that_is_on_too_early),
        IN_DUAL(a_wafer_is_lost_on_the_way),
        IN_DUAL(a_wafer_is_lost_in_a_station),
        IN_DUAL(a_sensor_that_is_not_asked),
        IN_DUAL(swap),
        IN_DUAL(map),
        IN_DUAL(parameters_of_one_command),
        IN_DUAL(a_collision_ahead),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
