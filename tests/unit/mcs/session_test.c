/* An operator's lines and their answers, in the paper's cell. */
#include "support/support.h"

#include <ctype.h>

#include "mcs/session.h"

static wh_session_t session;
static char answer[WH_SESSION_ANSWER_BYTES];

static int open_paper(void **state) {
    (void)state;
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua", .limits = {.print_to = stderr}};
    return wh_session_open(&session, &options) ? 0 : -1;
}

static int close_session(void **state) {
    (void)state;
    wh_session_close(&session);
    return 0;
}

static wh_status_t execute(const char *line) {
    return wh_session_execute(&session, line, answer, sizeof answer);
}

/* The answer begins with `expected`, and is one printable line. */
static void assert_answer(const char *line, const char *expected) {
    const wh_status_t status = execute(line);
    if (strncmp(answer, expected, strlen(expected)) != 0) {
        fail_msg("%s: answered %s, expected %s", line, answer, expected);
    }
    const bool is_error = strncmp(answer, "ERROR ", 6) == 0;
    assert_int_equal(status, is_error ? strtol(answer + 6, NULL, 10) : 0);
    for (const char *at = answer; *at; ++at) {
        assert_false(iscntrl((unsigned char)*at));
    }
}

typedef struct {
    const char *line, *answer;
} exchange_t;

static void assert_dialogue(const exchange_t *dialogue, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        assert_answer(dialogue[i].line, dialogue[i].answer);
    }
}

#define ASSERT_DIALOGUE(dialogue) assert_dialogue(dialogue, sizeof(dialogue) / sizeof(dialogue)[0])

/* ------------------------------------------------------------------------------------------------- commands
 */

static void every_command(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"HOLDER \"Wafer 1\"", "OK holder=none"},
        {"GET A 1", "OK wafer=\"Wafer 1\" seconds=1.965"},
        {"HOLDER \"Wafer 1\"", "OK holder=EE"},
        {"PUT B 2", "OK wafer=\"Wafer 1\" seconds="},
        {"OFFSET \"Wafer 1\" B 2", "OK dx=0 dy="},
        {"GET B 1", "OK wafer=\"Wafer 2\""},
        {"PUT P 1 handover=same_slice", "OK wafer=\"Wafer 2\""},
        {"PROXIMITY \"Wafer 2\" PA", "OK ready=true n1_proj_n2=1 dr_proj_z=0.24"},
        {"PROXIMITY \"Wafer 2\" EE", "OK ready=false"},
        {"ROTATE P 90", "OK seconds=0.6"},
        {"MEASURE P PA", "OK distance=0 dx=0 dy=0 dz=0 angle_deg=0 turn_deg=90"},
        {"DISTANCE a/1 A/25", "OK distance=240"},
        {"ANGLE \"Wafer 1\" base", "OK angle_deg=1.5"},
        {"VALVE EE 0", "OK seconds=0.001"},
        {"VALVE EE 1", "OK seconds=0.001"},
        {"MOVE theta=10 r=400", "OK seconds="},
        {"LINE dz=5 speed=20", "OK seconds="},
        {"WAIT 0.5", "OK seconds=0.5"},
        {"WHERE \"Wafer 2\"", "OK wafer=\"Wafer 2\" holder=PA station=P slot=1 dx="},
        {"STATIONS", "OK station=A slots=25; station=B slots=25; station=P slots=1 chuck=PA"},
        {"HELP", "OK ALARM ALIGN ANGLE AWAIT AXES CALIBRATE CARRIER CLEAR CLOSE CONTINUE CONTROLLER DISTANCE "
                 "EDGE_SCAN FAULT FLIP GET HELP"},
        {"HELP WAIT", "OK WAIT SECONDS: stands still"},
        {"FLIP EE", "ERROR 48 BAD_ARGUMENT: a command's argument is"},
    };
    ASSERT_DIALOGUE(dialogue);
    assert_answer("AXES", "OK theta=");
    assert_non_null(strstr(answer, " PA=90"));
    assert_answer("WHERE", "OK wafer=\"Wafer 1\"");
    assert_non_null(strstr(answer, "; wafer=\"Wafer 2\""));
    assert_int_equal(session.complaints, 0);
}

/* The last error stays, however many commands succeeded afterwards: more than the record keeps. */
static void an_old_error_is_not_forgotten(void **state) {
    (void)state;
    assert_answer("GET B 5", "ERROR 42 WAFER_MISSING: ");
    assert_answer("GET A 26", "ERROR 41 NO_SUCH_SLOT: ");
    for (int i = 0; i < 2500; ++i) {
        assert_answer("VALVE EE 1", "OK seconds=0.001");
    }
    assert_answer("STATUS", "OK phase=idle ");
    assert_non_null(strstr(answer, " error=41 error_name=NO_SUCH_SLOT error_command=\"GET A 26\""));
    assert_in_range(session.record.command_count, 1, 1001);
}

static void case_and_spelling(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"get a 1", "OK wafer=\"Wafer 1\""},
        {"  PuT    b   2   ", "OK wafer=\"Wafer 1\""},
        {"holder \"wafer 1\"", "OK holder=none"},
        {"OFFSET \"Wafer 1\" \"B\" 2", "OK dx=0"},
        {"MOVE THETA=10", "OK seconds="},
        {"GET b 1.0 GRIPPER=ee", "OK wafer=\"Wafer 2\""},
        {"PUT B 1 stroke=8 offset=4e0 release=-.25", "OK wafer=\"Wafer 2\""},
        {"WAIT +1.5E-1", "OK seconds=0.15"},
        {"WAIT .5", "OK seconds=0.5"},
    };
    ASSERT_DIALOGUE(dialogue);
}

static void commands_are_recorded(void **state) {
    (void)state;
    execute("GET A 1");
    execute("get a 2");
    execute("FLY");
    execute("WHERE");
    assert_int_equal(session.record.command_count, 2);
    assert_string_equal(session.record.commands[0].text, "GET A 1");
    assert_near(session.record.commands[0].end_s, 1.965, 1e-9);
    assert_string_equal(session.record.commands[1].text, "GET A 2");
    assert_int_equal(session.record.commands[1].error, WH_STATUS_WAFER_ON_GRIPPER);
}

/* -------------------------------------------------------------------------------------------------- errors
 */

static void errors_have_their_numbers(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"FAULT leak value=0.3 after=-1", "ERROR 48 BAD_ARGUMENT: a command's argument is out of range or of "
                                          "the wrong kind; fault: after: -1 "},
        {"FAULT leak value=0.3 lasting=-1", "ERROR 48 BAD_ARGUMENT: a command's argument is out of range or "
                                            "of the wrong kind; fault: lasting: -1 "},
        {"FLY", "ERROR 47 NO_SUCH_COMMAND: "},
        {"", "ERROR 47 "},
        {"   ", "ERROR 47 "},
        {"\"GET\" A 1", "ERROR 47 "},
        {"GET=A 1", "ERROR 47 "},
        {"REHEARSE A 1", "ERROR 47 "},
        {"QUIT", "ERROR 47 "},
        {"HELP FLY", "ERROR 47 "},
        {"GET Q 1", "ERROR 40 NO_SUCH_STATION: no such station; \"Q\" (expected A, B, P)"},
        {"GET A 26", "ERROR 41 NO_SUCH_SLOT: "},
        {"GET A 0", "ERROR 41 "},
        {"GET A 1.5", "ERROR 41 "},
        {"GET A 3", "ERROR 42 WAFER_MISSING: "},
        {"PUT A 3", "ERROR 43 NO_WAFER_ON_GRIPPER: "},
        {"VALVE XX 0", "ERROR 45 NO_SUCH_GRIPPER: "},
        {"GET A 1 gripper=XX", "ERROR 45 "},
        {"GET A 1 gripper=PA", "ERROR 45 "},
        {"HOLDER \"Wafer 9\"", "ERROR 46 NO_SUCH_WAFER: "},
        {"MEASURE A/26 base", "ERROR 41 NO_SUCH_SLOT: "},
        {"DISTANCE A nowhere", "ERROR 48 BAD_ARGUMENT: "},
        {"VALVE EE 2", "ERROR 4 BAD_VALVE: "},
        {"MOVE z=2000", "ERROR 22 LIMIT_EXCEEDED: "},
        {"LINE dx=2000", "ERROR 21 OUT_OF_REACH: "},
        {"ROTATE A 90", "ERROR 49 NOT_A_PREALIGNER: "},
        {"WAIT -1", "ERROR 48 "},
        {"GET A 1", "OK "},
        {"GET A 2", "ERROR 44 WAFER_ON_GRIPPER: "},
    };
    ASSERT_DIALOGUE(dialogue);
}

static void bad_arguments(void **state) {
    (void)state;
    static const char *const lines[] = {
        "GET",
        "GET A",
        "GET A 1 1",
        "GET A one",
        "GET A 0x1",
        "GET A \"1\"",
        "GET A 1e",
        "WAIT inf",
        "WAIT nan",
        "WAIT 1e999",
        "WAIT --1",
        "WAIT 1,5",
        "WAIT ",
        "WAIT 1 2",
        "GET A 1 speed=3",
        "GET A 1 stroke=3 stroke=3",
        "GET A 1 STROKE=3 stroke=3",
        "GET A 1 stroke=",
        "GET A 1 stroke=x",
        "GET A 1 stroke=0",
        "PUT P 1 handover=maybe",
        "MOVE",
        "MOVE q=1",
        "MOVE 10",
        "LINE",
        "LINE dx=1 dx=1",
        "ROTATE P 1e400",
        "GET \"A 1",
        "GET A\"B\" 1",
        "GET \"A\"B 1",
        "GET \"A\\n\" 1",
        "AXES now",
        "AXES x=1",
        "HELP GET PUT",
        "HOLDER Wafer 1",
        "VALVE EE",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_answer(lines[i], "ERROR 48 BAD_ARGUMENT: ");
    }
    assert_int_equal(wh_session_slice(&session), 0);
}

/* A word of this kind that is right, and one that is wrong. Numbers are wrong in many ways. */
typedef struct {
    const char *kind, *right, *wrong[6];
} kind_t;

static const kind_t *find_kind(const char *name, size_t length) {
    static const kind_t number = {"NUMBER", "1", {"x", "inf", "nan", "0x1", "1e999", "\"1\""}};
    static const kind_t kinds[] = {{"STATION", "P", {"Q", "5"}},
                                   {"SLOT", "1", {"0", "2", "1.5", "one", "-1", "nan"}},
                                   {"GRIPPER", "EE", {"Q", "5"}},
                                   {"WAFER", "\"Wafer 1\"", {"Q", "5"}},
                                   {"FRAME", "base", {"Q", "P/2"}},
                                   {"FAULT", "leak", {"leek", "5"}},
                                   {"COMMAND", "GET", {"GTE", "5"}},
                                   {"HANDOVER", "new_first", {"new", "5"}},
                                   {"VACUUM_CHECK", "both", {"never", "5"}},
                                   {"SWITCH", "true", {"yes", "1"}},
                                   {"NAME", "n", {NULL}},
                                   {"PATTERN", "look", {"Q", "5"}},
                                   {"SAVE", "n", {"Q", "5"}},
                                   {"LEVEL", "1", {"2", "-1", "0.5", "x", "inf"}},
                                   {"SIDE", "vacuum", {"air", "5"}},
                                   {"PORT_STATE", "open", {"air", "5"}},
                                   {"CARRIER", "C1", {"Q", "5"}},
                                   {"SLOTS", "1", {"x", "1.5", "-1", "inf"}},
                                   {"CHANGES", "1:crossed", {"x", "1", "crossed:1"}},
                                   {"UP_OR_DOWN", "up", {"left", "5", "inf"}},
                                   {"SECONDS", "1", {"-1", "2000000", "x", "inf", "nan"}}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        if (strlen(kinds[i].kind) == length && strncmp(kinds[i].kind, name, length) == 0) {
            return &kinds[i];
        }
    }
    return &number;
}

static void add(char line[400], const char *name, int length, const char *value) {
    const size_t used = strlen(line);
    snprintf(line + used, 400 - used, "%s%.*s%s", used > 0 ? " " : "", length, name, value);
}

/* A word of the usage "GET STATION SLOT [stroke=NUMBER]" as an operator can type it. `attempt` -1:
 * a right value, otherwise the wrong value of this number, which is returned. */
static const char *add_word(char line[400], const char *word, int attempt) {
    const bool is_option = word[0] == '[' && strchr(word, '=');
    const size_t name = is_option ? strcspn(word, "=") : 0;
    const char *kind = word + name + (word[0] == '[' ? 1 : 0);
    const kind_t *found = find_kind(kind, strcspn(kind, "]"));
    const char *value = attempt < 0 ? found->right : found->wrong[attempt];
    if (value && (!is_option || attempt >= 0)) {
        add(line, word + 1, (int)name, value);
    }
    return attempt < 0 ? NULL : value;
}

/* All arguments with right values, except the one at `place`. False if that has no such attempt. */
static bool try_wrong(const char *usage, int place, int attempt) {
    char text[1000], line[400] = "";
    const char *wrong = NULL;
    snprintf(text, sizeof text, "%s", usage);
    char *save = NULL, *word = strtok_r(text, " ", &save);
    add(line, "", 0, word);
    for (int at = 0; (word = strtok_r(NULL, " ", &save)) != NULL; ++at) {
        if (strncmp(word, "...", 3) != 0) {
            const char *value = add_word(line, word, at == place ? attempt : -1);
            wrong = value ? value : wrong;
        }
    }
    if (wrong) {
        const char *shown = strchr(wrong, '/') ? strchr(wrong, '/') + 1 : wrong;
        assert_answer(line, "ERROR ");
        if (!strstr(answer, shown) || !(strstr(answer, "expected") || strstr(answer, "HELP lists them"))) {
            fail_msg("%s: answered %s", line, answer);
        }
    }
    return wrong != NULL;
}

static size_t try_place(const char *usage, int place) {
    int attempt = 0;
    while (attempt < 6 && try_wrong(usage, place, attempt)) {
        ++attempt;
    }
    return (size_t)attempt;
}

/* The commands and their options are those of HELP. */
static void a_wrong_word_of_any_command_is_named_with_what_was_expected(void **state) {
    (void)state;
    char commands[1000];
    size_t tried = 0;
    assert_answer("HELP", "OK ");
    snprintf(commands, sizeof commands, "%.*s", (int)strcspn(answer, ";"), answer);
    for (char *save = NULL, *name = strtok_r(commands + 3, " ", &save); name;
         name = strtok_r(NULL, " ", &save)) {
        char line[60], usage[1000];
        snprintf(line, sizeof line, "HELP %s", name);
        assert_answer(line, "OK ");
        snprintf(usage, sizeof usage, "%.*s", (int)strcspn(answer + 3, ":"), answer + 3);
        for (int place = 0; place < 30; ++place) { /* no command has so many words */
            tried += try_place(usage, place);
        }
    }
    assert_in_range(tried, 500, 5000);
    assert_int_equal(wh_session_slice(&session), 0);
}

static void control_characters(void **state) {
    (void)state;
    static const char *const lines[] = {
        "GET\tA 1",   "GET A 1\r",        "GET A 1\nGET A 2", "GET \033[2J 1",  "\001",
        "GET \177 1", "GET \302\2332J 1", "GET \xFF 1",       "GET \xC0\xAF 1", "GET \xED\xA0\x80 1"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_answer(lines[i], "ERROR 48 BAD_ARGUMENT: ");
        assert_null(strchr(answer, '\x9B'));
    }
    assert_answer("GET \xC3\xA4 1", "ERROR 40 NO_SUCH_STATION: no such station; \"\xC3\xA4\" (expected");
}

static void line_length(void **state) {
    (void)state;
    static char line[3000];
    memset(line, ' ', sizeof line);
    memcpy(line, "WAIT 1", 6);
    line[WH_SESSION_LINE_BYTES] = '\0';
    assert_answer(line, "OK seconds=1");
    line[WH_SESSION_LINE_BYTES] = ' ';
    line[WH_SESSION_LINE_BYTES + 1] = '\0';
    assert_answer(
        line, "ERROR 48 BAD_ARGUMENT: a command's argument is out of range or of the wrong kind; the line is "
              "longer than 1000 bytes");
    memset(line, '"', sizeof line - 1);
    line[sizeof line - 1] = '\0';
    assert_answer(line, "ERROR 48 ");
}

/* No typed text runs as Lua, and none changes the meaning of a later line. */
static void injections(void **state) {
    (void)state;
    static const char *const lines[] = {
        "os.exit(3)",
        "get(\"A\", 1)",
        "GET A 1); error(\"x\") --",
        "GET A 1 stroke=6;get=nil",
        "GET A\") error(\"x 1",
        "GET \"A\\\") error(\\\"x\" 1",
        "GET A [[1]]",
        "GET A 1 __index=1",
        "GET __index 1",
        "GET A 1 gripper=%s%s%n%d",
        "HELP __index",
        "HELP %s%99999d",
        "%s%s%s%n",
        "__index A 1",
        "HOLDER \"%d %s\"",
        "MOVE __metatable=1",
        "GET ../../etc/passwd 1",
        "GET $(reboot) `reboot`",
        "cell \"lua/layouts/paper.lua\"",
        "LOAD \"return 1\"",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        assert_answer(lines[i], "ERROR 4");
    }
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\" seconds=1.965");
}

static void random_lines_leave_it_usable(void **state) {
    (void)state;
    static const char pieces[][12] = {
        "GET", "PUT",     "WHERE", "HELP", "MOVE", " ", " ",  "\"",       "\\",       "=",  "A", "1", "-",
        "e",   "stroke=", "\x80",  "\x1b", "%s",   "'", "[[", "\xC3\xA4", "gripper=", "0x", "{", "--"};
    wh_test_seed();
    for (int i = 0; i < 3000 / WH_TEST_SHARE; ++i) {
        char line[200] = "";
        wh_candidates_t candidates;
        for (uint32_t n = wh_test_below(14); n > 0; --n) {
            strcat(line, pieces[wh_test_below(sizeof pieces / sizeof pieces[0])]);
        }
        wh_session_complete(&session, line, &candidates);
        assert_true(candidates.start <= strlen(line));
        assert_answer(line, execute(line) == WH_OK ? "OK" : "ERROR ");
    }
    assert_int_equal(lua_gettop(wh_sandbox_state(session.sandbox)), 0);
}

/* --------------------------------------------------------------------------------------- stops and budgets
 */

/* A link that acts as the simulator does and, in a chosen slice, does something else. */
static struct {
    wh_link_t link;
    wh_link_t *simulator;
    int64_t slices, stop_at;
    bool gives_up;
    wh_status_t nested;
} between;

static wh_status_t exchange(wh_link_t *link, const wh_command_t *command, wh_state_t *out) {
    (void)link;
    if (++between.slices == between.stop_at) {
        char text[100];
        between.nested = wh_session_execute(&session, "AXES", text, sizeof text);
        wh_session_stop(&session);
        if (between.gives_up) {
            return WH_STATUS_BUSY; /* the status of a link that was waiting for an answer */
        }
    }
    return between.simulator->exchange(between.simulator, command, out);
}

static uint64_t hash(wh_link_t *link) {
    (void)link;
    return between.simulator->hash(between.simulator);
}

static wh_link_t *connect_between(void *user, wh_mcs_t *mcs) {
    assert_ptr_equal(user, &between);
    assert_int_equal(mcs->track.slice, 0);
    between.simulator = mcs->link;
    between.link.exchange = exchange;
    between.link.hash = hash;
    return &between.link;
}

static wh_link_t *connect_nowhere(void *user, wh_mcs_t *mcs) {
    (void)user;
    (void)mcs;
    return NULL;
}

static int open_between(void **state) {
    (void)state;
    memset(&between, 0, sizeof between);
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua",
                                          .partners = {.connect = connect_between, .user = &between}};
    return wh_session_open(&session, &options) ? 0 : -1;
}

static void another_link(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\" seconds=1.965");
    assert_int_equal(between.slices, 1965);
}

static void stop(void **state) {
    (void)state;
    between.stop_at = 700;
    assert_answer("GET A 1", "ERROR 52 STOPPED: ");
    assert_int_equal(between.slices, 700);
    assert_int_equal(between.nested, WH_STATUS_BUSY);
    assert_int_equal(session.record.commands[0].error, WH_STATUS_STOPPED);
    assert_near(session.record.commands[0].end_s, 0.7, 1e-9);
    wh_session_stop(&session);
    assert_answer(
        "GET A 1",
        "ERROR 52 STOPPED: a command was stopped before its end; the arm stands in A slot 1 since GET A "
        "1: RECOVER");
    assert_answer("RECOVER", "OK seconds=");
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\"");
    assert_answer("PUT B 2", "OK wafer=\"Wafer 1\"");
}

static void stop_of_a_link_that_waits(void **state) {
    (void)state;
    between.stop_at = 700;
    between.gives_up = true;
    assert_answer("GET A 1", "ERROR 52 STOPPED: ");
    assert_answer("HOME", "OK seconds=");
    assert_answer("GET A 1", "OK wafer=\"Wafer 1\"");
}

static void budget_is_for_each_command(void **state) {
    (void)state;
    const wh_session_options_t options = {.layout = "lua/layouts/paper.lua",
                                          .limits = {.instructions = 1000000}};
    assert_true(wh_session_open(&session, &options));
    for (int i = 0; i < 30; ++i) {
        assert_answer("WAIT 40", "OK seconds=40");
    }
    assert_answer("WAIT 100", "ERROR 53 OUT_OF_BUDGET: ");
    assert_answer("WAIT 40", "OK seconds=40");
    assert_int_equal(session.mcs.recorder.running, WH_NONE);
}

/* ------------------------------------------------------------------------------- answers, reports, opening
 */

static void complaints_are_told(void **state) {
    (void)state;
    assert_answer("GET A 1", "OK ");
    assert_answer("VALVE EE 1", "OK seconds=0.001; released_unsupported \"Wafer 1\", ");
    assert_int_equal(session.complaints, 1);
    assert_answer("WAIT 1", "OK seconds=1");
    assert_int_equal(session.complaints, 1);
}

static void answers_are_cut_between_characters(void **state) {
    (void)state;
    char text[64];
    for (size_t size = 8; size < sizeof text; ++size) {
        memset(text, '#', sizeof text);
        wh_session_execute(&session, "GET \xC3\xA4\xC3\xA4\xC3\xA4\xC3\xA4 1", text, size);
        assert_int_equal(strlen(text), size - 1 - (strlen(text) < size - 1 ? 1 : 0));
        assert_string_equal(text + strlen(text) - 3, "...");
    }
}

static int reports;

static void count_report(void *user, const char *line, wh_status_t status, const char *text) {
    assert_ptr_equal(user, &reports);
    assert_string_equal(line, "GET A 3");
    assert_int_equal(status, text ? WH_STATUS_WAFER_MISSING : WH_OK);
    ++reports;
}

static void a_line_is_reported(void **state) {
    (void)state;
    const wh_session_options_t options = {
        .layout = "lua/layouts/paper.lua", .report = count_report, .report_user = &reports};
    assert_true(wh_session_open(&session, &options));
    execute("GET A 3");
    assert_int_equal(reports, 2);
}

static void assert_refused(const wh_session_options_t *options, const char *reason) {
    assert_false(wh_session_open(&session, options));
    assert_non_null(strstr(session.message, reason));
    wh_session_close(&session);
}

static void what_cannot_be_opened(void **state) {
    (void)state;
    static const char *const bad[] = {"no equals sign"};
    const wh_session_options_t missing = {.layout = "tests/end_to_end/data/missing.lua"};
    const wh_session_options_t script = {.layout = "lua/examples/01_transfer.lua"};
    const wh_session_options_t parameter = {
        .layout = "lua/layouts/paper.lua", .parameters = bad, .parameter_count = 1};
    const wh_session_options_t unconnected = {.layout = "lua/layouts/paper.lua",
                                              .partners = {.connect = connect_nowhere}};
    assert_refused(&missing, "tests/end_to_end/data/missing.lua: ");
    assert_refused(&script, "lua/examples/01_transfer.lua:");
    assert_refused(&parameter, "no equals sign");
    assert_refused(&unconnected, "lua/layouts/paper.lua: no link to the simulator");
}

/* ---------------------------------------------------------------------------------------------- completing
 */

static void assert_candidates(const char *before, size_t start, const char *expected) {
    wh_candidates_t candidates;
    char text[1000] = "";
    wh_session_complete(&session, before, &candidates);
    for (size_t i = 0; i < candidates.count; ++i) {
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s|", candidates.texts[i]);
    }
    assert_string_equal(text, expected);
    assert_int_equal(candidates.start, start);
}

static void completion(void **state) {
    (void)state;
    assert_candidates("GE", 0, "GET|");
    assert_candidates("  h", 2, "HELP|HOLDER|HOME|");
    assert_candidates("GET ", 4, "A|B|P|");
    assert_candidates("get b", 4, "B|");
    assert_candidates("GET A ", 6, "");
    assert_candidates("GET A 1 g", 8, "gripper=|");
    assert_candidates("GET A 1 gripper=", 8, "gripper=EE|gripper=PA|");
    assert_candidates("PUT P 1 stroke=3 handover=s", 17, "handover=same_slice|");
    assert_candidates("MOVE ", 5,
                      "acceleration=|elbow=|flip=|forearm=|r=|r2=|rail=|speed=|theta=|tilt_x=|tilt_y=|x=|y=|"
                      "yaw=|yaw2=|z=|");
    assert_candidates("HOLDER W", 7, "\"Wafer 1\"|\"Wafer 2\"|");
    assert_candidates("HOLDER \"Wafer 1", 7, "\"Wafer 1\"|");
    assert_candidates("OFFSET \"Wafer 1\" ", 17, "A|B|P|");
    assert_candidates("WHERE \"Wafer 1\" \"w", 16, "\"Wafer 1\"|\"Wafer 2\"|");
    assert_candidates("MEASURE b/2", 8, "B/2|B/20|B/21|B/22|B/23|B/24|B/25|");
    assert_candidates("MEASURE EE ba", 11, "base|");
    assert_candidates("HELP wa", 5, "WAIT|WAIT_FOR|");
    assert_candidates("FLY ", 4, "");
    assert_candidates("GET \"A\"B ", 9, "");
    assert_candidates("AXES ", 5, "");
    assert_candidates("GET \xFF", 4, "");
}

/* A layout's Lua may change the libraries in any way: that spoils the answers, and nothing else. */
static void a_layout_that_spoils_the_strings(void **state) {
    (void)state;
    static wh_session_t spoilt;
    char path[WH_TEST_PATH];
    const wh_session_options_t options = {.layout = path,
                                          .limits = {.instructions = 20000000, .print_to = stderr}};
    FILE *layout = fdopen(mkstemp(wh_test_path(path, "odd_strings")), "w");
    assert_non_null(layout);
    fputs("local odd = {}\n"
          "setmetatable(odd, { __concat = function() return odd end })\n"
          "string.gsub = function() return odd end\n"
          "string.find = function() return 5 end\n"
          "return { grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 } } } }\n",
          layout);
    assert_int_equal(fclose(layout), 0);
    wh_candidates_t candidates;
    assert_true(wh_session_open(&spoilt, &options));
    assert_int_equal(wh_session_execute(&spoilt, "FOO", answer, sizeof answer), WH_STATUS_BAD_ARGUMENT);
    assert_int_equal(strncmp(answer, "ERROR 48 BAD_ARGUMENT", 21), 0);
    wh_session_complete(&spoilt, "GE", &candidates);
    assert_true(candidates.start <= 2);
    for (size_t i = 0; i < candidates.count; ++i) {
        assert_non_null(candidates.texts[i]);
    }
    wh_session_close(&spoilt);
    assert_int_equal(unlink(path), 0);
}

/* ------------------------------------------------------------------------------------- STATUS, VERSION, RESET
 */

static void status_tells_where_all_is(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"STATUS",
         "OK phase=idle seq=0 time=0 theta=0 r=300 z=900 yaw=0 EE.holds=none PA.holds=none error=0"},
        {"GET A 1", "OK "},
        {"status", "OK phase=idle seq=1965 time=1.965 theta=0 r=400 z=903 yaw=0 EE.holds=\"Wafer 1\" "
                   "PA.holds=none error=0"},
        {"PUT Q 1", "ERROR 40"},
        {"MOVE theta=10", "OK "},
        {"STATUS NOW", "ERROR 48"},
        {"VERSION", "OK version=" WH_VERSION},
    };
    ASSERT_DIALOGUE(dialogue);
    assert_answer("STATUS", "OK phase=idle seq=");
    assert_non_null(strstr(answer, " theta=10 r=400 "));
    assert_non_null(strstr(answer, " error=40 error_name=NO_SUCH_STATION error_command=\"PUT Q 1\""));
}

/* Wafers, arm, slot book, time and errors are those of the beginning; the cell's complaint is not
 * forgotten. */
static void reset_is_a_new_beginning(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"GET A 1", "OK "},
        {"VALVE EE 1", "OK seconds=0.001; released_unsupported"},
        {"PUT A 5", "ERROR 43"},
        {"RESET", "OK"},
        {"STATUS",
         "OK phase=idle seq=0 time=0 theta=0 r=300 z=900 yaw=0 EE.holds=none PA.holds=none error=0"},
        {"GET A 1", "OK wafer=\"Wafer 1\" seconds=1.965"},
        {" reset ", "OK"},
        {"GET A 1", "OK wafer=\"Wafer 1\" seconds=1.965"},
        {"RESET NOW", "ERROR 48"},
        {"PUT B 2", "OK wafer=\"Wafer 1\" seconds=2.337"},
    };
    ASSERT_DIALOGUE(dialogue);
    assert_int_equal(session.complaints, 1);
}

static void write_layout(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void a_reset_to_a_layout_that_is_refused_changes_nothing(void **state) {
    (void)state;
    static const char path[] = "build/session_test_layout.lua";
    static const char good[] =
        "return { grippers = { { name = 'EE', on = 'robot' } }, stations = { A = { at = { 700, 0, 900 }, "
        "slots = 5, pitch = 10 } }, wafers = { { name = 'W', station = 'A', slot = %d } } }";
    const wh_session_options_t options = {.layout = path, .limits = {.print_to = stderr}};
    char text[400];
    snprintf(text, sizeof text, good, 1);
    write_layout(path, text);
    assert_true(wh_session_open(&session, &options));
    assert_answer("GET A 1", "OK wafer=W");
    write_layout(path, "return { stations = 5 }");
    assert_answer("RESET",
                  "ERROR 48 BAD_ARGUMENT: a command's argument is out of range or of the wrong kind; "
                  "build/session_test_layout.lua: stations: 5");
    assert_answer("STATUS", "OK phase=idle seq=");
    assert_non_null(strstr(answer, " EE.holds=W error=48 error_name=BAD_ARGUMENT error_command=RESET"));
    assert_answer("HOLDER W", "OK holder=EE");
    assert_answer("PUT A 2", "OK wafer=W");
    snprintf(text, sizeof text, good, 4);
    write_layout(path, text);
    assert_answer("RESET", "OK");
    assert_answer("STATUS", "OK phase=idle seq=0 ");
    assert_non_null(strstr(answer, " error=0"));
    assert_answer("GET A 4", "OK wafer=W");
    wh_session_close(&session);
    (void)remove(path);
}

static wh_link_t *count_connection(void *user, wh_mcs_t *mcs) {
    ++*(int *)user;
    return &mcs->local.simulator.link;
}

/* A connected client has left the run by then, so nothing may be refused after that. */
static void a_reset_that_leaves_a_parameter_unread_connects_to_nothing(void **state) {
    (void)state;
    static const char path[] = "build/session_test_parameter.lua";
    static const char layout[] =
        "return { grippers = { { name = 'EE', on = 'robot' } }, stations = { A = { at = { 700, 0, 900 }, "
        "slots = %s, pitch = 10 } } }";
    const char *const parameters[] = {"slots=5"};
    int connections = 0;
    const wh_session_options_t options = {.layout = path,
                                          .limits = {.print_to = stderr},
                                          .parameters = parameters,
                                          .parameter_count = 1,
                                          .partners = {.connect = count_connection, .user = &connections}};
    char text[400];
    snprintf(text, sizeof text, layout, "params.slots");
    write_layout(path, text);
    assert_true(wh_session_open(&session, &options));
    assert_int_equal(connections, 1);
    snprintf(text, sizeof text, layout, "5");
    write_layout(path, text);
    assert_answer("RESET", "ERROR 48 BAD_ARGUMENT: ");
    assert_non_null(
        strstr(answer, "build/session_test_parameter.lua: --set slots: nobody read params.slots"));
    assert_int_equal(connections, 1);
    assert_answer("WAIT 0.5", "OK seconds=0.5");
    wh_session_close(&session);
    (void)remove(path);
}

/* ------------------------------------------------------------------------- SAVE, RESTORE, UNDO
 */

static uint64_t hash_now(void) {
    return wh_session_hash(&session);
}

static void what_was_saved_goes_on_with_the_same_bits(void **state) {
    (void)state;
    static const char *const lines[] = {"FAULT slow_vacuum gripper=PA value=0.01",
                                        "GET A 1 stop=up",
                                        "CONTINUE",
                                        "PUT B 2",
                                        "GET B 1",
                                        "PUT P 1",
                                        "ROTATE P 30",
                                        "VALVE EE 0",
                                        "MOVE theta=20"};
    const size_t count = sizeof lines / sizeof lines[0];
    uint64_t hashes[sizeof lines / sizeof lines[0] + 1];
    char name[40];
    for (size_t i = 0; i <= count; ++i) {
        (void)snprintf(name, sizeof name, "SAVE s%zu", i);
        assert_answer(name, "OK time=");
        hashes[i] = hash_now();
        if (i < count) {
            assert_answer(lines[i], "OK");
        }
    }
    for (size_t from = count + 1; from-- > 0;) {
        (void)snprintf(name, sizeof name, "RESTORE s%zu", from);
        assert_answer(name, "OK time=");
        for (size_t i = from; i < count; ++i) {
            assert_int_equal(hash_now(), hashes[i]);
            assert_answer(lines[i], "OK");
        }
        assert_int_equal(hash_now(), hashes[count]);
    }
}

static void what_was_done_is_taken_back(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"UNDO", "ERROR 68 NOTHING_TO_UNDO: "},
        {"RESTORE a", "ERROR 67 NO_SUCH_SAVE: no state was saved under this name; \"a\" (expected a saved "
                      "name; there is none)"},
        {"SAVE \"to begin\"", "OK time=0"},
        {"GET A 1", "OK"},
        {"GET A 2", "ERROR 44 "}, /* refused: it changed nothing */
        {"HOLDER \"Wafer 1\"", "OK holder=EE"},
        {"PUT B 2", "OK"},
        {"PUT B 2", "ERROR 43 "},
        {"UNDO", "OK undone=\"PUT B 2\" left=1 time=1.965"},
        {"HOLDER \"Wafer 1\"", "OK holder=EE"},
        {"PUT B 2", "OK"}, /* the slot book has forgotten the first one, too */
        {"restore \"To Begin\"", "OK time=0"},
        {"STATUS", "OK phase=idle seq=0 time=0 theta=0 r=300 z=900 yaw=0 EE.holds=none PA.holds=none"},
        {"UNDO", "OK undone=\"restore \\\"To Begin\\\"\" left=2 time=4.302"},
        {"UNDO", "OK undone=\"PUT B 2\" left=1 time=1.965"},
        {"UNDO", "OK undone=\"GET A 1\" left=0 time=0"},
        {"UNDO", "ERROR 68 "},
        {"RESTORE b", "ERROR 67 NO_SUCH_SAVE: no state was saved under this name; \"b\" (expected to begin)"},
        {"GET A 1 stop=extended", "OK wafer=none seconds=1 stop=extended"},
        {"STOP", "OK"},
        {"GET A 1", "ERROR 52 STOPPED"},
        {"UNDO", "OK undone=STOP left=1 time=1"},
        {"STATUS", "OK phase=held command=\"GET A 1 stop=extended\" stop=extended"},
        {"CONTINUE", "OK wafer=\"Wafer 1\" seconds=0.965"},
        {"UNDO", "OK undone=CONTINUE left=1 time=1"},
        {"CONTINUE", "OK wafer=\"Wafer 1\" seconds=0.965"},
        {"FAULT leak gripper=EE value=0.2", "OK fault=1"},
        {"UNDO", "OK undone=\"FAULT leak gripper=EE value=0.2\" left=2 time=1.965"},
        {"CLEAR 1", "ERROR 48 "},
        {"SAVE", "ERROR 48 "},
        {"UNDO 2", "ERROR 48 "},
        {"RESET", "OK"},
        {"UNDO", "ERROR 68 "},
        {"RESTORE \"to begin\"", "ERROR 67 "},
    };
    ASSERT_DIALOGUE(dialogue);
}

static void so_many_are_taken_back_and_no_more(void **state) {
    (void)state;
    char expected[80];
    for (int i = 1; i <= WH_MCS_UNDONE + 3; ++i) {
        assert_answer("WAIT 0.001", "OK");
    }
    for (int i = WH_MCS_UNDONE; i-- > 0;) {
        (void)snprintf(expected, sizeof expected, "OK undone=\"WAIT 0.001\" left=%d time=", i);
        assert_answer("UNDO", expected);
    }
    assert_answer("UNDO",
                  "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken back; of the last 50 commands "
                  "that changed something, which are taken back");
    assert_int_equal(wh_session_slice(&session), 3);
}

/* UNDO says since when nothing more is taken back: since the layout was read, or since a task. */
static void a_task_is_named_as_the_end_of_what_is_taken_back(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {
        {"UNDO", "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken back; since the layout was read"},
        {"WAIT 0.5", "OK"},
        {"TASK GET A 1", "OK task=1"},
        {"UNDO", "ERROR 54 BUSY"},
        {"JOIN 1", "OK"},
        {"HOLDER \"Wafer 1\"", "OK holder=EE"},
        {"UNDO",
         "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken back; since task 1 was begun: UNDO takes "
         "back nothing from before a task's end"},
        {"HOLDER \"Wafer 1\"", "OK holder=EE"},
        {"PUT B 2", "OK"},
        {"UNDO", "OK undone=\"PUT B 2\" left=0"},
        {"UNDO", "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken back; since task 1 was begun"},
        {"RESET", "OK"},
        {"UNDO", "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken back; since the layout was read"}};
    ASSERT_DIALOGUE(dialogue);
}

/* A link that does not give the state of its simulator. */
static void what_a_link_does_not_tell_is_refused_by_name(void **state) {
    (void)state;
    static const exchange_t dialogue[] = {{"SAVE a",
                                           "ERROR 69 NOT_RESTORED: the simulator does not take a saved "
                                           "state; this simulator does not tell all that it is"},
                                          {"GET A 1", "OK wafer=\"Wafer 1\""},
                                          {"UNDO", "ERROR 68 NOTHING_TO_UNDO: no command is left to be taken "
                                                   "back; since GET A 1: no state could be kept before it"}};
    ASSERT_DIALOGUE(dialogue);
}

int main(void) {
#define IN_PAPER(test) cmocka_unit_test_setup_teardown(test, open_paper, close_session)
#define IN_BETWEEN(test) cmocka_unit_test_setup_teardown(test, open_between, close_session)
    const struct CMUnitTest tests[] = {
        IN_PAPER(every_command),
        IN_PAPER(case_and_spelling),
        IN_PAPER(commands_are_recorded),
        IN_PAPER(errors_have_their_numbers),
        IN_PAPER(bad_arguments),
        IN_PAPER(a_wrong_word_of_any_command_is_named_with_what_was_expected),
        IN_PAPER(control_characters),
        IN_PAPER(line_length),
        IN_PAPER(injections),
        IN_PAPER(random_lines_leave_it_usable),
        IN_PAPER(complaints_are_told),
        IN_PAPER(answers_are_cut_between_characters),
        IN_PAPER(completion),
        IN_BETWEEN(another_link),
        IN_BETWEEN(stop),
        IN_BETWEEN(stop_of_a_link_that_waits),
        cmocka_unit_test_teardown(budget_is_for_each_command, close_session),
        cmocka_unit_test_teardown(a_line_is_reported, close_session),
        cmocka_unit_test(what_cannot_be_opened),
        cmocka_unit_test(a_layout_that_spoils_the_strings),
        IN_PAPER(an_old_error_is_not_forgotten),
        IN_PAPER(what_was_saved_goes_on_with_the_same_bits),
        IN_PAPER(what_was_done_is_taken_back),
        IN_PAPER(so_many_are_taken_back_and_no_more),
        IN_PAPER(a_task_is_named_as_the_end_of_what_is_taken_back),
        IN_BETWEEN(what_a_link_does_not_tell_is_refused_by_name),
        IN_PAPER(status_tells_where_all_is),
        IN_PAPER(reset_is_a_new_beginning),
        cmocka_unit_test(a_reset_to_a_layout_that_is_refused_changes_nothing),
        cmocka_unit_test(a_reset_that_leaves_a_parameter_unread_connects_to_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
