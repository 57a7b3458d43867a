/* A study's table, CSV and JSON, word for word, for trials with invented outcomes. */
#include "print/study_print.h"

#include <locale.h>

#include "support/layout.h"

static const char cell[] =
    "grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, slots = 3 }, "
    "B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3 } }, "
    "wafers = { { name = 'W1', station = 'A', slot = 1 }, { name = 'W, 2', station = 'A', slot = 2 } }, "
    "study = { placement = { dx = 0.5, tilt = 0.02 }, teaching = { z = 0.1, yaw = 0.05 }, "
    "timing = { valve = 0.005, vacuum = 0.01, shape = 'uniform' } }";

enum { PICKED = WH_EVENT_PICKED };

static wh_study_t study;
static wh_tally_t tally;
static char script[] = "cell_test.lua";
static char *text;

static int set_up(void **state) {
    (void)state;
    memset(&study, 0, sizeof study);
    study.layout = read_sound(cell);
    study.run.script = script;
    study.seed = 7;
    study.nominal.record = (wh_record_t){.script = script,
                                         .layout = study.layout,
                                         .ok = true,
                                         .hash = 0xabc,
                                         .slices = 4302,
                                         .simulated_s = 4.302};
    study.wafer_count = 2;
    /* The first in B 3, 0.1 mm beside and tilted by 1 degree; the second is held. */
    study.wafers[0] = (wh_study_wafer_t){0, WH_NONE, {1, 3, 0.1, 0, 0.2, WH_PI / 180, WH_FACE_BACK}};
    study.wafers[1] = (wh_study_wafer_t){1, 0, {.station = WH_NONE}};
    study.causes = wh_causes_of(study.layout, &study.cause_count);
    study.drawn = wh_causes_of(study.layout, &study.drawn_count);
    study.lines = 1000;
    wh_tally_init(&tally, study.wafer_count);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    wh_tally_free(&tally);
    free(study.causes);
    free(study.drawn);
    free(text);
    text = NULL;
    return 0;
}

/* The drawn error for the first wafer's dx; a third of it is taken over. It fails above 0.4. */
static void add_trial(uint64_t trial) {
    static char expected[] = "W1 in B slot 3; found dX 0.7", held[] = "W, 2 held by EE", get[] = "GET A 1";
    static char put[] = "PUT B 3: W1 in that slot; it lies in B slot 2";
    const wh_trial_t name = {study.seed, trial};
    const double dx = (double)wh_errors_draw_wafer(study.layout->errors, &name, 0).moved.x;
    const bool is_met = fabs(dx) <= 0.4;
    wh_expectation_record_t expectations[] = {{4, expected, is_met, false}, {5, held, trial != 5, false}};
    wh_command_record_t command = {
        .line = 3, .text = get, .error = trial == 2 || trial == 6 ? WH_STATUS_WAFER_MISSING : WH_OK};
    /* Two PUTs in the line of an expectation: the first is always met, and is not told. */
    wh_expectation_record_t implied[] = {{4, put, true, true}, {4, put, trial != 1, true}};
    const wh_record_t record = {.expectations = expectations,
                                .expectation_count = 2,
                                .implied = implied,
                                .implied_count = 2,
                                .commands = &command,
                                .command_count = 1,
                                .failure = trial == 6 ? get : NULL};
    wh_outcome_t outcome = {.trial = trial,
                            .met = is_met && trial != 5 && trial != 6,
                            .whole = trial % 4 == 0,
                            .record = &record};
    outcome.events[PICKED] = 2;
    outcome.events[WH_EVENT_HIT] = trial == 5 ? 3 : 0;
    outcome.wafers[0] = study.wafers[0];
    outcome.wafers[0].place.dx += dx / 3;
    outcome.wafers[0].place.slot = trial == 3 ? 2 : 3;
    outcome.wafers[1] = study.wafers[1];
    outcome.wafers[1].holder = trial == 4 ? WH_NONE : 0;
    wh_tally_add(&tally, &study, &outcome);
}

static void add_trials(uint64_t count) {
    for (uint64_t trial = 0; trial < count; ++trial) {
        add_trial(trial);
    }
    wh_tally_sort(&tally);
    tally.relations.wafer_count = 2;
}

static void print(int (*to)(const wh_study_result_t *told, FILE *out), double require, size_t worst) {
    const wh_study_result_t told = {&study, &tally, require, worst};
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(to(&told, out), 0);
    assert_int_equal(fclose(out), 0);
}

static int plain_table(const wh_study_result_t *told, FILE *out) {
    static const wh_style_t piped = {false, true, 0};
    return wh_study_print_table(told, out, &piped);
}

static void assert_says(const char *wanted) {
    if (!strstr(text, wanted)) {
        print_error("not found: %s\nin:\n%s", wanted, text);
        fail();
    }
}

static void the_whole_table(void **state) {
    (void)state;
    add_trials(40);
    print(plain_table, 0.5, 3);
    assert_string_equal(
        text,
        "cell_test.lua on cell.lua\n"
        "40 trials of seed 7\n"
        "\n"
        "Expectations\n"
        "line  expected                  seen  met      %  95 %                first missed\n"
        "   4  PUT B 3: W1 in that slot    40   39  97.50  87.1186 to 99.5573             1\n"
        "   4  W1 in B slot 3              40   21  52.50  37.4974 to 67.0645             2\n"
        "   5  W, 2 held by EE             40   39  97.50  87.1186 to 99.5573             5\n"
        "\n"
        "Errors of commands\n"
        "line  command  error             trials     %  95 %               first\n"
        "   3  GET A 1  42 WAFER_MISSING       2  5.00  1.3821 to 16.5039      2\n"
        "\n"
        "Events\n"
        "event   trials       %  95 %                 all in all\n"
        "picked      40  100.00  91.2378 to 100.0000          80\n"
        "hit          1    2.50  0.4427 to 12.8814             3\n"
        "\n"
        "Wafers at the end\n"
        "wafer  in   what        mean  deviation      min    0.1 %      5 %    50 %    95 %  99.9 %     max\n"
        "W1     B 3  dX mm     0.1095     0.1707  -0.2100  -0.2100  -0.2066  0.1182  0.3432  0.5746  0.5754\n"
        "            dY mm     0.0000     0.0000   0.0000   0.0000   0.0000  0.0000  0.0000  0.0000  0.0000\n"
        "            dz mm     0.2000     0.0000   0.2000   0.2000   0.2000  0.2000  0.2000  0.2000  0.2000\n"
        "            tilt deg  1.0000     0.0000   1.0000   1.0000   1.0000  1.0000  1.0000  1.0000  1.0000\n"
        "            off mm    0.1369     0.0999   0.0004   0.0004   0.0134  0.1245  0.3105  0.4746  0.4754\n"
        "W1 ends elsewhere in 1 trial, which are not in these figures\n"
        "W, 2 ends elsewhere in 1 trial, which are not in these figures\n"
        "\n"
        "Which error costs most: correlations, all together 95 % sure\n"
        "drawn            failing with its size  with its value         strongest at the end   of\n"
        "W1 dx mm         0.77 (0.40 to 0.92)    0.12 (-0.44 to 0.61)   1.00 (1.00 to 1.00)    W1 dX\n"
        "A yaw deg        -0.39 (-0.76 to 0.18)  -0.45 (-0.79 to 0.11)  -0.49 (-0.81 to 0.06)  W1 off\n"
        "W1 tilt x deg    0.02 (-0.52 to 0.54)   0.29 (-0.28 to 0.71)   0.17 (-0.40 to 0.65)   W1 off\n"
        "W1 tilt y deg    -0.12 (-0.61 to 0.43)  -0.27 (-0.70 to 0.31)  -0.27 (-0.70 to 0.31)  W1 off\n"
        "EE valve s       -0.21 (-0.66 to 0.36)                         -0.23 (-0.68 to 0.35)  W1 off\n"
        "B z mm           -0.08 (-0.58 to 0.47)  0.12 (-0.44 to 0.61)   -0.13 (-0.62 to 0.43)  W1 off\n"
        "W, 2 tilt x deg  -0.04 (-0.55 to 0.50)  -0.11 (-0.60 to 0.45)  -0.09 (-0.60 to 0.47)  W1 off\n"
        "W, 2 tilt y deg  -0.11 (-0.60 to 0.45)  -0.01 (-0.53 to 0.52)  0.17 (-0.40 to 0.64)   W1 off\n"
        "and 4 more, which --json tells\n"
        "\n"
        "Worst trials\n"
        "trial  result  off mm  why\n"
        "   30  failed  0.4754  line 4 missed\n"
        "   19  failed  0.3100  line 4 missed\n"
        "    5  failed  0.3075  line 4 missed, 1 more, hit\n"
        "\n"
        "10 trials ran the script whole, the others are the run without errors, replayed\n"
        "without errors: no wafers per hour: no wafer was put into a station that counts\n"
        "20 of 40 trials ok: 50.0000 %, 95 % sure from 35.1995 to 64.8005 % (Wilson)\n"
        "not the required 50 %\n"
        "! collisions were not looked for: the layout has no collision = true\n"
        "--trial 30 --seed 7 plays the worst one\n");
}

static void trials_as_lines(void **state) {
    (void)state;
    add_trials(7);
    print(wh_study_print_csv, 0, 0);
    assert_string_equal(
        text,
        "trial,ok,whole,ended,missed,errors,complaints,elsewhere,off mm,W1 dX mm,W1 dY mm,W1 dz mm,W1 tilt "
        "deg,\"W, 2 dX mm\",\"W, 2 dY mm\",\"W, 2 dz mm\",\"W, 2 tilt deg\",drawn W1 dx mm,drawn W1 tilt x "
        "deg,drawn W1 tilt y deg,\"drawn W, 2 dx mm\",\"drawn W, 2 tilt x deg\",\"drawn W, 2 tilt y "
        "deg\",drawn A z mm,drawn A yaw deg,drawn B z mm,drawn B yaw deg,drawn EE valve s,drawn vacuum s\n"
        "0,1,1,0,0,0,0,0,0.12498065863898977,0.22498065863898978,0,0.2,1,,,,,0.3749419759169693,-0."
        "012181567957851847,-0.00297298028044582,0.24758481242947378,-0.02411642460972152,0."
        "016670200143385727,-0.11393095721762003,0.07614047196578146,0.1562176781956932,0.04889254469437307,"
        "0.002875165945335948,0.005671021848391915\n"
        "1,1,0,0,0,0,0,0,0.05443920552268469,0.1544392055226847,0,0.2,1,,,,,0.16331761656805407,0."
        "02765002752453168,-0.004853426305309885,-0.05476946991201115,-0.0058815176756021135,0."
        "02164531876073322,-0.08884765998297005,0.05308384956916127,-0.12540612125425374,-0."
        "03205518499678433,0.003918414924385651,0.006535513931098016\n"
        "2,0,0,0,1,1,0,0,0.15065661217929635,0.25065661217929636,0,0.2,1,,,,,0.451969836537889,-0."
        "014659992348016338,0.025260960188187524,-0.2652092078572405,0.02700455420371705,-0."
        "0027046479337100755,-0.19864161703653108,0.008482158181018537,0.06635038265203104,-0."
        "09858112499965943,0.003592330740763422,0.00879365362589977\n"
        "3,1,0,0,0,0,0,1,,,,,,,,,,-0.059369822644695903,0.002017497283902497,-0.03426718793282196,-0."
        "18652380801524165,0.011782604702026751,0.0008702579441845112,-0.003417049295188006,-0."
        "05801157713721994,0.03689601610859854,-0.007463293784263411,0.004405678587934653,0."
        "004318882543835596\n"
        "4,1,1,0,0,0,0,1,,0.03873514025277677,0,0.2,1,,,,,-0.1837945792416697,-0.020806542581308145,0."
        "002748207843460019,0.23849523511658358,-0.008074985498834442,0.015093215580482922,-0."
        "23131436385001405,0.1153308749496209,-0.0183600916835777,0.009614893855121548,0.003158306272455779,"
        "0.0018431737718271424\n"
        "5,0,0,0,2,0,3,0,0.30745897861324084,-0.20745897861324084,0,0.2,1,,,,,-0.9223769358397226,0."
        "018841810893343438,0.01421760836768263,0.1440022193235966,-0.01634779384720518,0.026005205225581206,"
        "-0.08184968563868028,-0.015319419944921468,-0.008482935255988772,0.014474381303810513,0."
        "002046870027593245,0.0066472041339965295\n"
        "6,0,0,1,0,1,0,0,0.05645762512402491,0.15645762512402492,0,0.2,1,,,,,0.1693728753720747,0."
        "004522029711022428,0.01875274194720013,0.11615237211536182,0.020761647895394014,-0."
        "010722393229376464,-0.03507041298954769,-0.08037167644232117,0.024413938504323458,0."
        "018667057883540276,0.004077496885060498,0.00653852516477998\n");
}

/* The text continues with these lines; returns the rest after them. */
static const char *expect_lines(const char *at, const char *const lines[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        const size_t length = strcspn(at, "\n");
        if (strlen(lines[i]) != length || strncmp(at, lines[i], length) != 0) {
            fail_msg("expected\n%s\nfound\n%.*s", lines[i], (int)length, at);
        }
        at += length + 1;
    }
    return at;
}

/* The JSON up to the drawn errors, some of these, and the rest after them. */
static const char *const begin[] = {
    "{",
    "  \"format\": 1,",
    "  \"ok\": true,",
    "  \"script\": \"cell_test.lua\",",
    "  \"layout\": \"cell.lua\",",
    "  \"seed\": 7,",
    "  \"trials\": 8,",
    "  \"success\": {\"met\": 5, \"rate\": 0.625, \"low\": 0.30574239460262731, \"high\": "
    "0.86315571417640269},",
    "  \"require\": null,",
    "  \"ended\": 1,",
    "  \"whole\": 2,",
    "  \"whole_why\": null,",
    "  \"noise_alone\": false,",
    "  \"drawn_aside\": 0,",
    "  \"run_without_errors\": {\"ok\": true, \"hash\": \"0000000000000abc\", \"slices\": 4302, "
    "\"simulated_s\": 4.3019999999999996, \"throughput\": {\"wafers_per_hour\": null, \"reason\": \"no wafer "
    "was put into a station that counts\", \"wafers\": 0, \"seconds\": 4.3019999999999996, \"first_cycle\": "
    "null, \"last_cycle\": null, \"puts\": 0, \"counting\": [\"A\", \"B\"]}},",
    "  \"expectations\": [",
    "    {\"line\": 4, \"text\": \"PUT B 3: W1 in that slot\", \"seen\": 8, \"met\": 7, \"rate\": 0.875, "
    "\"low\": "
    "0.52911181778714655, \"high\": 0.97758250854994333, \"first_missed\": 1},",
    "    {\"line\": 4, \"text\": \"W1 in B slot 3\", \"seen\": 8, \"met\": 6, \"rate\": 0.75, \"low\": "
    "0.40927543031016894, \"high\": 0.928520787247891, \"first_missed\": 2},",
    "    {\"line\": 5, \"text\": \"W, 2 held by EE\", \"seen\": 8, \"met\": 7, \"rate\": 0.875, \"low\": "
    "0.52911181778714655, \"high\": 0.97758250854994333, \"first_missed\": 5}",
    "  ],",
    "  \"errors\": [",
    "    {\"line\": 3, \"text\": \"GET A 1\", \"error\": 42, \"name\": \"WAFER_MISSING\", \"trials\": 2, "
    "\"rate\": 0.25, \"low\": 0.071479212752109014, \"high\": 0.59072456968983111, \"first\": 2}",
    "  ],",
    "  \"events\": [",
    "    {\"kind\": \"picked\", \"complaint\": false, \"trials\": 8, \"rate\": 1.0, \"low\": "
    "0.67559243511611977, \"high\": 1.0, \"total\": 16},",
    "    {\"kind\": \"hit\", \"complaint\": true, \"trials\": 1, \"rate\": 0.125, \"low\": "
    "0.022417491450056667, \"high\": 0.47088818221285345, \"total\": 3}",
    "  ],",
    "  \"wafers\": [",
    "    {\"name\": \"W1\", \"station\": \"B\", \"slot\": 3, \"holder\": null, \"elsewhere\": 1, \"count\": "
    "7, \"dx\": {\"mean\": 0.090236898884177213, \"deviation\": 0.15785436971370706, \"min\": "
    "-0.20745897907763719, \"p0_1\": -0.20664062453433871, \"p1\": -0.20664062453433871, \"p5\": "
    "-0.20664062453433871, \"p50\": 0.15444335890933872, \"p95\": 0.25065661258995531, \"p99\": "
    "0.25065661258995531, \"p99_9\": 0.25065661258995531, \"max\": 0.25065661258995531}, \"dy\": {\"mean\": "
    "0.0, \"deviation\": 0.0, \"min\": 0.0, \"p0_1\": 0.0, \"p1\": 0.0, \"p5\": 0.0, \"p50\": 0.0, \"p95\": "
    "0.0, \"p99\": 0.0, \"p99_9\": 0.0, \"max\": 0.0}, \"dz\": {\"mean\": 0.20000000000000001, "
    "\"deviation\": 0.0, \"min\": 0.20000000000000001, \"p0_1\": 0.20000000000000001, \"p1\": "
    "0.20000000000000001, \"p5\": 0.20000000000000001, \"p50\": 0.20000000000000001, \"p95\": "
    "0.20000000000000001, \"p99\": 0.20000000000000001, \"p99_9\": 0.20000000000000001, \"max\": "
    "0.20000000000000001}, \"tilt_deg\": {\"mean\": 1.0, \"deviation\": 0.0, \"min\": 1.0, \"p0_1\": 1.0, "
    "\"p1\": 1.0, \"p5\": 1.0, \"p50\": 1.0, \"p95\": 1.0, \"p99\": 1.0, \"p99_9\": 1.0, \"max\": 1.0}, "
    "\"off\": {\"mean\": 0.1202014157814639, \"deviation\": 0.090403333953064935, \"min\": "
    "0.054439205676317215, \"p0_1\": 0.054443358909338713, \"p1\": 0.054443358909338713, \"p5\": "
    "0.054443358909338713, \"p50\": 0.086425780784338713, \"p95\": 0.30664062453433871, \"p99\": "
    "0.30664062453433871, \"p99_9\": 0.30664062453433871, \"max\": 0.3074589790776372}},",
    "    {\"name\": \"W, 2\", \"station\": null, \"slot\": null, \"holder\": \"EE\", \"elsewhere\": 1, "
    "\"count\": 0, \"dx\": null, \"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}",
    "  ],",
    "  \"drawn\": ["};

static const char *const drawn[] = {
    "    {\"kind\": \"wafer\", \"of\": \"W1\", \"what\": \"dx\", \"unit\": \"mm\", \"width\": 0.5, "
    "\"failing\": {\"by_size\": null, \"by_value\": null}, \"ends\": [{\"wafer\": \"W1\", \"dx\": null, "
    "\"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}, {\"wafer\": \"W, 2\", \"dx\": null, "
    "\"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}]},",
    "    {\"kind\": \"station\", \"of\": \"B\", \"what\": \"yaw\", \"unit\": \"deg\", \"width\": "
    "0.050000000000000003, \"failing\": {\"by_size\": null, \"by_value\": null}, \"ends\": [{\"wafer\": "
    "\"W1\", \"dx\": null, \"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}, {\"wafer\": \"W, "
    "2\", \"dx\": null, \"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}]},",
    "    {\"kind\": \"vacuum\", \"of\": null, \"what\": \"vacuum\", \"unit\": \"s\", \"width\": 0.01, "
    "\"failing\": {\"by_size\": null, \"by_value\": null}, \"ends\": [{\"wafer\": \"W1\", \"dx\": null, "
    "\"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}, {\"wafer\": \"W, 2\", \"dx\": null, "
    "\"dy\": null, \"dz\": null, \"tilt_deg\": null, \"off\": null}]}"};

static const char *const end[] = {
    "  ],",
    "  \"worst\": [",
    "    {\"trial\": 5, \"ok\": false, \"off\": 0.30745897861324084, \"why\": \"line 4 missed, 1 more, "
    "hit\", \"drawn\": {\"wafers\": [{\"name\": \"W1\", \"dx\": -0.92237693583972258, \"dy\": 0.0, \"dz\": "
    "0.0, \"tilt_x\": 0.018841810893343438, \"tilt_y\": 0.014217608367682631, \"turn\": 0.0}, {\"name\": "
    "\"W, 2\", \"dx\": 0.14400221932359661, \"dy\": 0.0, \"dz\": 0.0, \"tilt_x\": -0.01634779384720518, "
    "\"tilt_y\": 0.026005205225581206, \"turn\": 0.0}], \"stations\": [{\"name\": \"A\", \"x\": 0.0, \"y\": "
    "0.0, \"z\": -0.081849685638680281, \"roll\": 0.0, \"pitch\": 0.0, \"yaw\": -0.015319419944921468}, "
    "{\"name\": \"B\", \"x\": 0.0, \"y\": 0.0, \"z\": -0.0084829352559887723, \"roll\": 0.0, \"pitch\": 0.0, "
    "\"yaw\": 0.014474381303810513}], \"rims\": [], \"beams\": [], \"valves\": [{\"gripper\": \"EE\", "
    "\"slices\": 3}], "
    "\"vacuum_s\": 0.0066472041339965295}},",
    "    {\"trial\": 2, \"ok\": false, \"off\": 0.15065661217929635, \"why\": \"1 command failed: 42 "
    "WAFER_MISSING in line 3, line 4 "
    "missed\", \"drawn\": {\"wafers\": [{\"name\": \"W1\", \"dx\": 0.45196983653788902, \"dy\": 0.0, \"dz\": "
    "0.0, \"tilt_x\": -0.014659992348016338, \"tilt_y\": 0.025260960188187524, \"turn\": 0.0}, {\"name\": "
    "\"W, 2\", \"dx\": -0.2652092078572405, \"dy\": 0.0, \"dz\": 0.0, \"tilt_x\": 0.02700455420371705, "
    "\"tilt_y\": -0.0027046479337100755, \"turn\": 0.0}], \"stations\": [{\"name\": \"A\", \"x\": 0.0, "
    "\"y\": 0.0, \"z\": -0.19864161703653108, \"roll\": 0.0, \"pitch\": 0.0, \"yaw\": 0.008482158181018537}, "
    "{\"name\": \"B\", \"x\": 0.0, \"y\": 0.0, \"z\": 0.06635038265203104, \"roll\": 0.0, \"pitch\": 0.0, "
    "\"yaw\": -0.098581124999659431}], \"rims\": [], \"beams\": [], \"valves\": [{\"gripper\": \"EE\", "
    "\"slices\": 4}], "
    "\"vacuum_s\": 0.0087936536258997697}}",
    "  ]",
    "}"};

/* There are so few trials that no correlation is determined: their last digits depend on the
 * machine's own tanh. */
static void the_whole_json(void **state) {
    (void)state;
    add_trials(8);
    print(wh_study_print_json, 0, 2);
    const char *at = expect_lines(text, begin, sizeof begin / sizeof begin[0]);
    for (size_t i = 0; i < sizeof drawn / sizeof drawn[0]; ++i) {
        assert_says(drawn[i]);
    }
    at = expect_lines(strstr(at, "  ],\n  \"worst\""), end, sizeof end / sizeof end[0]);
    assert_string_equal(at, "");
}

static void what_is_said_of_other_studies(void **state) {
    (void)state;
    study.whole = "a clock";
    study.nominal.record.ok = false;
    add_trial(0);
    print(plain_table, 0.9, 0);
    assert_says("\n1 trial of seed 7\nwithout any errors the script fails already\n");
    assert_says("\neach trial ran the script whole, for in the run without errors this was read: a clock\n");
    assert_says("\n1 of 1 trial ok: 100.0000 %, 95 % sure from 20.6549 to 100.0000 % (Wilson)\nnot the "
                "required 90 %\n");
    assert_says("\nnone of the trials failed, so nothing tells what failing goes with\n");
    assert_true(strstr(text, "plays the worst one") == NULL);
    print(wh_study_print_json, 0.9, 0);
    assert_says("\n  \"ok\": false,");
    assert_says("\n  \"require\": 0.90000000000000002,");
    assert_says("\n  \"whole_why\": \"a clock\",");
    assert_says("\n  \"worst\": []\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_whole_table, set_up, tear_down),
        cmocka_unit_test_setup_teardown(trials_as_lines, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_whole_json, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_said_of_other_studies, set_up, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
