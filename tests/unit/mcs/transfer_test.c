/* Commands in a cell with lying sensors, two blades, corrections, phases, and a judge that looks ahead. */
#include "support/support.h"

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

/* A link that acts as the simulator does and then spoils the sensors. */
static struct {
    wh_link_t link;
    wh_link_t *simulator;
    uint32_t forced_off, forced_on;
    int64_t from, until; /* the slices in which it does so; until 0: none */
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

/* From now on, for this number of slices, the sensors of gripper 0 are on or off. */
static void lie(bool on, int64_t slices) {
    liar.forced_on = on ? 1 : 0;
    liar.forced_off = on ? 0 : 1;
    liar.from = wh_session_slice(&session);
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

/* The blade moves down again before it leaves: the wafer stays in its slot, and the robot is ready
 * for the next command. */
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

/* The wafer is lost on the way in: the arm stands in the station, and no other arm enters before it
 * is out. */
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
    /* The empty blade finds nothing: the other one keeps its wafer. */
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

static bool judge_segment(void *user, const wh_track_t *track, const wh_ahead_start_t *start, int64_t *slices,
                          char *reason) {
    assert_ptr_equal(user, &judge);
    assert_true(session.mcs.rehearsal.is_on);
    if (!track) { /* the command is over: nothing else moves here */
        return false;
    }
    assert_int_equal(track->slice, judge.slice);
    assert_int_equal(start != NULL, session.mcs.rehearsal.planned.count == 0);
    assert_int_equal(start ? start->state->seq : judge.slice, judge.slice);
    assert_int_equal(start ? start->other_count : 0, 0);
    ++*slices;
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
    assert_int_equal(wh_session_slice(&session), 0);
    assert_int_equal(liar.slices, 0);
    assert_answer("AXES", "OK theta=0 r=150 z=900 yaw=0 ");
    judge.asked = 0;
    assert_answer("GET A 1", "OK");
    assert_int_equal(judge.asked, 6);
    judge.slice = wh_session_slice(&session);
    judge.refused_line = 1;
    assert_answer("LINE dz=1", "ERROR 61 ");
    assert_answer("LINE dz=1", "OK");
}

/* --------------------------------------------------------------------------------------- corrections, phases */

static void assert_offset(const char *line, double dx, double dy) {
    const wh_status_t status = wh_session_execute(&session, line, answer, sizeof answer);
    const char *at_x = strstr(answer, "dx="), *at_y = strstr(answer, "dy=");
    assert_int_equal(status, WH_OK);
    assert_non_null(at_x);
    assert_non_null(at_y);
    assert_near(strtod(at_x + 3, NULL), dx, 1e-9);
    assert_near(strtod(at_y + 3, NULL), dy, 1e-9);
}

/* Wafer 2 lies 3, -2 mm aside. */
static void a_get_with_the_true_offset_centres_the_wafer(void **state) {
    (void)state;
    assert_answer("GET A 2 dx=3 dy=-2", "OK wafer=\"Wafer 2\"");
    assert_answer("PUT A 2 gripper=FRONT", "OK wafer=\"Wafer 2\"");
    assert_offset("OFFSET \"Wafer 2\" A 2", 0, 0);
    assert_answer("GET A 2", "OK");
    assert_answer("PUT A 2 gripper=FRONT dx=1.5 dy=0.25", "OK");
    assert_offset("OFFSET \"Wafer 2\" A 2", 1.5, 0.25);
}

/* In the slot's frame, whose x axis points to the side of the base: B stands turned by 90 degrees. */
static void a_correction_is_in_the_frame_of_the_slot(void **state) {
    (void)state;
    assert_answer("GET B 3 dx=4 dy=1 turn=5", "OK wafer=\"Wafer 3\"");
    assert_answer("PUT B 3 turn=5", "OK");
    assert_offset("OFFSET \"Wafer 3\" B 3", -4, -1);
    assert_answer("GET B 3 turn=-3", "OK");
    assert_answer("PUT B 3 turn=2", "OK");
    assert_answer("MEASURE B/3 \"Wafer 3\"", "OK distance=");
    const char *turn = strstr(answer, "turn_deg=");
    assert_non_null(turn);
    assert_near(strtod(turn + 9, NULL), 5, 1e-9);
}

static void a_correction_out_of_its_limits_moves_nothing(void **state) {
    (void)state;
    assert_answer("GET A 1 dx=5.001",
                  "ERROR 64 CORRECTION_TOO_LARGE: a correction is larger than the layout allows; dx: 5.001 "
                  "(expected from -5 to 5 mm: corrections.x of the layout)");
    assert_answer("GET A 1 turn=-5.1", "ERROR 64 CORRECTION_TOO_LARGE: ");
    assert_answer("GET A 1 dy=nan", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("GET A 1 dy=inf", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("GET A 1 stop=down", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("GET A 1 get_dx=1", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("SWAP A 1 dx=1", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("READY A 1 dx=1", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("GET A 1 dz=2.5 stroke=6 offset=8", "ERROR 48 BAD_ARGUMENT: ");
    assert_int_equal(liar.slices, 0);
    assert_answer("GET A 1", "OK");
    const int64_t slices = liar.slices;
    assert_answer("SWAP A 2 put_dz=2.6", "ERROR 64 CORRECTION_TOO_LARGE: ");
    assert_answer("SWAP A 2 get_turn=-6", "ERROR 64 CORRECTION_TOO_LARGE: ");
    assert_int_equal(liar.slices, slices);
}

static void what_is_held_in_a_phase_moves_no_more(void **state) {
    (void)state;
    static const char *const moving[] = {"GET A 2",       "PUT A 2",    "SWAP A 2", "READY A 1",
                                         "HOME",          "RECOVER",    "MAP A",    "ROTATE P 90",
                                         "VALVE FRONT 0", "MOVE z=900", "LINE dz=1"};
    assert_answer("CONTINUE", "ERROR 66 NOT_IN_PHASE: ");
    assert_answer("GET A 1 stop=extended", "OK wafer=none seconds=0.");
    const int64_t slices = liar.slices;
    for (size_t i = 0; i < sizeof moving / sizeof moving[0]; ++i) {
        assert_answer(moving[i], "ERROR 65 IN_PHASE: ");
    }
    assert_int_equal(liar.slices, slices);
    assert_answer("STATUS", "OK phase=held command=\"GET A 1 stop=extended\" stop=extended ");
    assert_answer("WAIT 0.1", "OK");
    assert_answer("HOLDER \"Wafer 1\"", "OK holder=none");
    assert_answer("CONTINUE", "OK wafer=\"Wafer 1\" seconds=");
    assert_answer("PUT A 1 gripper=FRONT stop=up", "OK wafer=\"Wafer 1\" seconds=");
    assert_answer("STOP", "OK");
    assert_answer("CONTINUE", "ERROR 66 NOT_IN_PHASE: ");
    assert_answer("GET A 2", "ERROR 52 STOPPED: ");
    assert_answer("RECOVER", "OK");
    assert_answer("GET A 1 stop=up", "OK wafer=\"Wafer 1\"");
    assert_answer("CONTINUE", "OK wafer=\"Wafer 1\"");
    assert_answer("SWAP B 3 get_stop=up put_stop=extended", "OK wafer=\"Wafer 3\"");
    assert_answer("CONTINUE", "OK");
    assert_answer("HOLDER \"Wafer 1\"", "OK holder=FRONT");
    assert_answer("CONTINUE", "OK wafer=\"Wafer 3\" put=\"Wafer 1\"");
}

/* CONTINUE notices if the vacuum does not come, and also if a wafer is lost while it is held. If a
 * WAIT between has seen that, nothing moves, and the command is held as before. */
static void what_fails_behind_a_phase_fails_the_continue(void **state) {
    (void)state;
    assert_answer("GET A 1 stop=extended", "OK");
    lie(false, 0);
    assert_answer("CONTINUE", "ERROR 57 VACUUM_TIMEOUT: ");
    tell_the_truth();
    assert_answer("GET A 1 stop=up", "OK");
    lie(false, 0);
    assert_answer("CONTINUE", "ERROR 60 WAFER_LOST_ON_WAY: ");
    tell_the_truth();
    assert_answer("CONTINUE", "ERROR 66 NOT_IN_PHASE: ");
    assert_answer("RECOVER", "OK");
    assert_answer("WAIT 0.01", "OK");
    assert_answer("PUT A 1 stop=extended", "OK");
    lie(false, 0);
    assert_answer("WAIT 0.01", "ERROR 60 WAFER_LOST_ON_WAY: ");
    const int64_t slices = liar.slices;
    assert_answer(
        "CONTINUE",
        "ERROR 60 WAFER_LOST_ON_WAY: the wafer was lost on the way; the sensor of FRONT went off while");
    assert_int_equal(liar.slices, slices);
    tell_the_truth();
    assert_answer("WAIT 0.01", "OK");
    assert_answer("CONTINUE", "OK");
    assert_answer("CONTINUE", "ERROR 66 NOT_IN_PHASE: ");
    assert_int_equal(session.complaints, 0);
}

static uint64_t hash_after(const char *const *lines) {
    for (; *lines; ++lines) {
        assert_answer(*lines, "OK");
    }
    const uint64_t got = liar.link.hash(&liar.link);
    wh_session_close(&session);
    assert_int_equal(open_dual(NULL), 0);
    return got;
}

static void a_command_in_phases_ends_as_a_whole_one(void **state) {
    (void)state;
    static const char *const whole[] = {"GET A 1", "PUT P 1", "GET P 1", "SWAP B 3 get_dx=1", NULL};
    static const char *const phased[] = {"GET A 1 stop=extended",
                                         "CONTINUE",
                                         "PUT P 1 stop=up",
                                         "CONTINUE",
                                         "GET P 1 stop=up",
                                         "CONTINUE",
                                         "SWAP B 3 get_dx=1 get_stop=up put_stop=extended",
                                         "CONTINUE",
                                         "CONTINUE",
                                         NULL};
    assert_true(hash_after(whole) == hash_after(phased));
}

/* ------------------------------------------------------------------------------------------------- aligning */

/* Two blades and an edge sensor. */
static const char *const aligner =
    "return {\n"
    "  robot = { r = { min = 50, max = 700, home = 150 } },\n"
    "  grippers = { { name = 'FRONT', at = { 250, 0, 0 } }, { name = 'PA', on = 'P' },\n"
    "    { name = 'BACK', at = { -250, 0, 10 }, rpy = { 0, 0, 180 } } },\n"
    "  stations = { A = { at = { 700, 0, 900 }, slots = 3, pitch = 10 },\n"
    "    P = { kind = 'prealigner', at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = {} } },\n"
    "  wafers = { { name = 'W1', station = 'A', slot = 1, dx = 1, dy = -2, rpy = { 0, 0, 30 } },\n"
    "    { name = 'W2', station = 'A', slot = 2 } },\n"
    "}\n";

/* W1 is aligned to 90 degrees; this state is saved under the name `aligned`. */
static int open_aligned(void **state) {
    (void)state;
    char path[WH_TEST_PATH];
    FILE *file = fdopen(mkstemp(wh_test_path(path, "aligner")), "w");
    (void)fputs(aligner, file);
    (void)fclose(file);
    const wh_session_options_t options = {.layout = path, .limits = {.print_to = stderr}};
    const bool is_open = wh_session_open(&session, &options);
    (void)remove(path);
    static const char *const lines[] = {"GET A 1", "PUT P 1", "ALIGN P 90", "SAVE aligned"};
    for (size_t i = 0; is_open && i < sizeof lines / sizeof lines[0]; ++i) {
        assert_answer(lines[i], "OK");
    }
    return is_open ? 0 : -1;
}

static const char *last_command(void) {
    return session.record.commands[session.record.command_count - 1].text;
}

/* The lines, with | between them; each is answered with OK. */
static void execute_all(const char *lines) {
    while (*lines) {
        char line[100];
        const size_t length = strcspn(lines, "|");
        (void)snprintf(line, sizeof line, "%.*s", (int)length, lines);
        assert_answer(line, "OK");
        lines += length + (lines[length] == '|' ? 1 : 0);
    }
}

/* A GET corrects by this amount, as its text tells. W1 lay at 1, -2, turned by 30 degrees: 60 more
 * are asked for. */
static void assert_corrected(const char *get, double dx, double dy) {
    char text[60];
    double x = 0, y = 0;
    assert_answer(get, "OK");
    assert_int_equal(sscanf(last_command(), "%59[A-Z 1] dx=%lf dy=%lf", text, &x, &y), 3);
    assert_near(x, dx, 0.005);
    assert_near(y, dy, 0.005);
}

static void a_get_goes_to_where_align_found_the_wafer(void **state) {
    (void)state;
    assert_corrected("GET P 1", 2.232, -0.134);
    assert_answer("PUT A 3 gripper=FRONT", "OK wafer=W1");
    assert_answer("OFFSET W1 A 3", "OK dx=");
    assert_near(strtod(strstr(answer, "dx=") + 3, NULL), 0, 0.005);
    assert_near(strtod(strstr(answer, "dy=") + 3, NULL), 0, 0.005);
    assert_answer("MEASURE A/3 W1", "OK");
    assert_near(strtod(strstr(answer, "turn_deg=") + 9, NULL), 90, 0.01);
}

static void what_align_found_turns_with_the_chuck(void **state) {
    (void)state;
    static const char *const kept[] = {"WAIT 1",
                                       "HOME",
                                       "READY P 1",
                                       "MAP A",
                                       "GET A 2|PUT A 2",
                                       "GET P 1|UNDO",
                                       "VALVE PA 1|UNDO",
                                       "ROTATE P 90|ROTATE P -90",
                                       "EDGE_SCAN P|ROTATE P -0.2"};
    for (size_t i = 0; i < sizeof kept / sizeof kept[0]; ++i) {
        execute_all("RESTORE aligned");
        execute_all(kept[i]);
        assert_corrected("GET P 1", 2.232, -0.134);
    }
    execute_all("RESTORE aligned|ROTATE P 90");
    assert_corrected("GET P 1", 0.134, 2.232);
    execute_all("RESTORE aligned");
    assert_answer("GET P 1 retract=900", "ERROR 21 ");
    assert_corrected("GET P 1", 2.232, -0.134);
}

/* A command that states its own speed. */
static void what_align_found_is_forgotten_with_the_wafer(void **state) {
    (void)state;
    static const char *const gone[] = {"GET P 1|PUT P 1", "GET P 1 correct=false|PUT P 1",
                                       "VALVE PA 1|VALVE PA 0", "GET P 1 stop=extended|STOP|RECOVER"};
    for (size_t i = 0; i < sizeof gone / sizeof gone[0]; ++i) {
        execute_all("RESTORE aligned");
        execute_all(gone[i]);
        assert_answer("GET P 1", "OK");
        assert_string_equal(last_command(), "GET P 1");
    }
    static const char *const own[] = {"GET P 1 dx=0.5", "GET P 1 dy=-0.5", "GET P 1 correct=false"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; ++i) {
        execute_all("RESTORE aligned");
        assert_answer(own[i], "OK");
        assert_string_equal(last_command(), own[i]);
    }
    execute_all("RESTORE aligned");
    assert_answer("ALIGN P 0 correct=false", "OK mark=notch");
    assert_answer("GET P 1", "OK");
    assert_string_equal(last_command(), "GET P 1");
}

static void a_swap_takes_where_align_found_the_wafer(void **state) {
    (void)state;
    double x = 0, y = 0;
    assert_answer("GET A 2", "OK wafer=W2");
    assert_answer("SWAP P 1", "OK wafer=W1 put=W2");
    assert_int_equal(sscanf(last_command(), "SWAP P 1 get_dx=%lf get_dy=%lf", &x, &y), 2);
    assert_near(x, 2.232, 0.005);
    assert_near(y, -0.134, 0.005);
    assert_answer("GET P 1 gripper=FRONT", "OK wafer=W2");
    assert_string_equal(last_command(), "GET P 1");
    execute_all("RESTORE aligned|GET A 2");
    assert_answer("SWAP P 1 get_correct=false", "OK wafer=W1 put=W2");
    assert_string_equal(last_command(), "SWAP P 1 get_correct=false");
}

/* Nothing moves. */
static void an_align_that_cannot_be(void **state) {
    (void)state;
    const int64_t slice = wh_session_slice(&session);
    static const char *const bad[] = {
        "PUT P 1 correct=false", "SWAP P 1 correct=false", "READY P 1 correct=false",
        "ALIGN P 361",           "ALIGN P mode=pins",      "ALIGN P mark=flat",
        "ALIGN P glass=1",       "ALIGN P correct=0",      "ALIGN P stop=up"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        assert_answer(bad[i], "ERROR 48 BAD_ARGUMENT: ");
    }
    assert_answer("ALIGN P 1 2", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("ALIGN", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("EDGE_SCAN A", "ERROR 48 BAD_ARGUMENT: ");
    assert_answer("ALIGN A", "ERROR 49 NOT_A_PREALIGNER: ");
    assert_answer("ALIGN Q", "ERROR 40 NO_SUCH_STATION: ");
    assert_int_equal(wh_session_slice(&session), slice);
    assert_answer("GET P 1 stop=extended", "OK");
    assert_answer("ALIGN P", "ERROR 65 IN_PHASE: ");
    assert_answer("EDGE_SCAN P", "ERROR 65 IN_PHASE: ");
    assert_answer("STOP", "OK");
    assert_answer("ALIGN P",
                  "ERROR 52 STOPPED: a command was stopped before its end; the arm stands in P slot 1");
    assert_answer("RECOVER", "OK");
    assert_answer("ALIGN P", "OK mark=notch ");
}

#define IN_DUAL(test) cmocka_unit_test_setup_teardown(test, open_dual, close_session)

#define ALIGNED(test) cmocka_unit_test_setup_teardown(test, open_aligned, close_session)

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
        IN_DUAL(a_get_with_the_true_offset_centres_the_wafer),
        IN_DUAL(a_correction_is_in_the_frame_of_the_slot),
        IN_DUAL(a_correction_out_of_its_limits_moves_nothing),
        IN_DUAL(what_is_held_in_a_phase_moves_no_more),
        IN_DUAL(what_fails_behind_a_phase_fails_the_continue),
        IN_DUAL(a_command_in_phases_ends_as_a_whole_one),
        ALIGNED(a_get_goes_to_where_align_found_the_wafer),
        ALIGNED(what_align_found_turns_with_the_chuck),
        ALIGNED(what_align_found_is_forgotten_with_the_wafer),
        ALIGNED(a_swap_takes_where_align_found_the_wafer),
        ALIGNED(an_align_that_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
