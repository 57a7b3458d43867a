/* Events as text: digits compared with printf's, each kind of event, names, and texts that do not fit. */
#include "sim/event_text.h"

#include "sim/faults.h"
#include "sim/words_internal.h"
#include "support/grasp.h"

/* ------------------------------------------------------------------------------------------------- digits */

static const char *fixed(wh_real_t value, int decimals) {
    static char text[80];
    wh_words_t words = wh_words_begin(text, sizeof text);
    wh_words_fixed(&words, value, decimals);
    assert_int_equal(words.length, strlen(text));
    return text;
}

static const char *in_short(wh_real_t value, int digits) {
    static char text[80];
    wh_words_t words = wh_words_begin(text, sizeof text);
    wh_words_short(&words, value, digits, 0);
    return text;
}

static void expect_fixed(wh_real_t value, int decimals) {
    char wanted[80];
    snprintf(wanted, sizeof wanted, "%.*f", decimals, (double)value);
    assert_string_equal(fixed(value, decimals), value == 0 && wanted[0] == '-' ? wanted + 1 : wanted);
}

static void decimals_are_those_of_printf(void **state) {
    (void)state;
    for (int run = 0; run < 200000 / WH_TEST_SHARE; ++run) {
        const double magnitude = wh_test_decades(1e-25, 9e14);
        expect_fixed(WH_REAL(run % 2 == 0 ? magnitude : -magnitude), run % 16);
    }
}

/* Halves of the last decimal, which only binary fractions reach, round to the even digit. */
static void halves_are_rounded_to_even(void **state) {
    (void)state;
    for (int i = 0; i < 4096; i += WH_TEST_SHARE) {
        for (int decimals = 0; decimals < 12; ++decimals) {
            expect_fixed(WH_REAL(i) / 16, decimals);
        }
    }
    assert_string_equal(fixed(WH_REAL(0.5), 0), "0");
    assert_string_equal(fixed(WH_REAL(1.5), 0), "2");
    assert_string_equal(fixed(WH_REAL(-2.5), 0), "-2");
    assert_string_equal(fixed(WH_REAL(0.9999999), 3), "1.000");
}

static void short_numbers_are_those_of_printf_without_exponents(void **state) {
    (void)state;
    for (int run = 0; run < 200000 / WH_TEST_SHARE; ++run) {
        const int digits = 3 + run % 8;
        const wh_real_t value = WH_REAL(wh_test_decades(1.01e-4, 999));
        char wanted[80];
        snprintf(wanted, sizeof wanted, "%.*g", digits, (double)value);
        assert_string_equal(in_short(value, digits), wanted);
    }
    assert_string_equal(in_short(WH_REAL(0.5), 6), "0.5");
    assert_string_equal(in_short(-50, 6), "-50");
    assert_string_equal(in_short(1000000, 6), "1000000");
    assert_string_equal(in_short(WH_REAL(0.00005), 6), "0.00005");
    assert_string_equal(in_short(0, 6), "0");
}

static void numbers_that_have_no_digits_are_named(void **state) {
    (void)state;
    assert_string_equal(fixed(WH_REAL(NAN), 3), "nan");
    assert_string_equal(fixed(WH_REAL(INFINITY), 3), "more than 1e15");
    assert_string_equal(in_short(-WH_TEST_LARGEST, 3), "less than -1e15");
    assert_string_equal(fixed(WH_REAL(1e-30), 15), "0.000000000000000");
}

static void whole_numbers_are_written_in_full(void **state) {
    (void)state;
    const int64_t values[] = {0, 7, -7, 1234567890123, INT64_MAX, INT64_MIN};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        char text[40];
        char wanted[40];
        wh_words_t words = wh_words_begin(text, sizeof text);
        wh_words_integer(&words, values[i]);
        snprintf(wanted, sizeof wanted, "%lld", (long long)values[i]);
        assert_string_equal(text, wanted);
    }
}

/* ------------------------------------------------------------------------------------------------- events */

static wh_event_t event_of(wh_event_kind_t kind) {
    wh_event_t event;
    memset(&event, 0, sizeof event);
    event.kind = kind;
    event.wafer = 2;
    event.gripper = 1;
    event.other = 3;
    event.parts[0] = 4;
    event.parts[1] = 5;
    return event;
}

static const char *text_of(const wh_event_t *event, const wh_event_names_t *names) {
    static char text[WH_EVENT_TEXT_SIZE];
    const size_t length = wh_event_text(event, names, text, sizeof text);
    assert_int_equal(length, strlen(text));
    return text;
}

static wh_event_t missed_by_tolerance(double dz, double dx, double tilt) {
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_pose_t wafer = wh_test_pose(wh_test_rotation(1, 0, 0, tilt), dx, 0, 900);
    const wh_pose_t gripper = wh_test_at(0, 0, 900 - dz);
    wh_event_t event = event_of(WH_EVENT_NEAR_MISS);
    assert_int_equal(wh_proximity_measure(&wafer, &gripper, &tolerance, &event.measured), WH_OK);
    return event;
}

static void a_missed_pick_is_explained(void **state) {
    (void)state;
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    const wh_event_names_t names = {.tolerance = &tolerance};
    wh_event_t event = missed_by_tolerance(0, 55, 0);
    assert_string_equal(text_of(&event, &names),
                        "near miss: wafer 2, gripper 1: |dr_proj_xy| 55.000 is not below 50 (by 5.000 mm)");
    /* without the tolerance: from the margin */
    assert_string_equal(text_of(&event, NULL),
                        "near miss: wafer 2, gripper 1: |dr_proj_xy| 55.000 is not below 50 (by 5.000 mm)");
    event = missed_by_tolerance(0.5, 0, 0);
    assert_string_equal(text_of(&event, &names),
                        "near miss: wafer 2, gripper 1: |dr_proj_z| 0.500 is not below 0.5 (it is equal)");
    event.measured.failed = 0;
    assert_string_equal(text_of(&event, NULL), "near miss: wafer 2, gripper 1: ready, but not taken");
}

/* The first two numbers of a text, after the last colon but one. */
static void numbers_of(const char *text, double numbers[2]) {
    const char *at = strstr(text, "gripper 1: ") + strlen("gripper 1: ");
    for (size_t i = 0; i < 2; ++i) {
        at = strpbrk(at, "0123456789");
        char *end = NULL;
        numbers[i] = strtod(at, &end);
        at = strncmp(end, " mm/s^2", 7) == 0 ? end + 7 : end;
    }
}

/* A value as near to its limit as its number type allows is printed on its own side of it. */
static void a_value_beside_its_limit_does_not_read_as_the_limit(void **state) {
    (void)state;
    static const wh_event_kind_t kinds[] = {WH_EVENT_TOO_CLOSE, WH_EVENT_PLACED_OFF_CENTRE,
                                            WH_EVENT_PLACED_ASKEW, WH_EVENT_SLIPPED, WH_EVENT_VACUUM_LOST};
    for (int run = 0; run < 20000 / WH_TEST_SHARE; ++run) {
        wh_event_t event = event_of(kinds[run % 5]);
        const bool is_below = event.kind == WH_EVENT_TOO_CLOSE || event.kind == WH_EVENT_VACUUM_LOST;
        const bool is_fast = event.kind == WH_EVENT_SLIPPED;
        const double limit = is_fast ? wh_test_uniform(100, 9000) : wh_test_uniform(0.01, 1);
        const double apart = wh_test_decades(sizeof(wh_real_t) == sizeof(double) ? 1e-12 : 1e-5, 1e-1);
        event.limit = WH_REAL(run % 3 == 0 ? limit : floor(limit * 100) / 100 + 0.01);
        event.value = event.limit * WH_REAL(is_below ? 1 - apart : 1 + apart);
        event.parts[0] = event.parts[1] = WH_NONE;
        double numbers[2];
        numbers_of(text_of(&event, NULL), numbers);
        assert_true(is_below ? numbers[0] < numbers[1] : numbers[0] > numbers[1]);
    }
    wh_event_t event = event_of(WH_EVENT_VACUUM_LOST);
    event.limit = WH_REAL(0.6);
    event.value = WH_REAL(0.5996);
    assert_string_equal(
        text_of(&event, NULL),
        "vacuum lost: wafer 2, gripper 1: 59.96 % of the full vacuum, the sensor wants 60.00");
    event = event_of(WH_EVENT_TOO_CLOSE);
    event.limit = WH_REAL(0.5);
    event.value = WH_REAL(0.49996);
    assert_string_equal(text_of(&event, NULL),
                        "too close: wafer 2, gripper 1: part 4 and part 5: 0.49996 mm apart (limit 0.5 mm)");
    event.value = 0;
    event.at = wh_vec3(1, -2, WH_REAL(0.125));
    assert_string_equal(text_of(&event, NULL),
                        "too close: wafer 2, gripper 1: part 4 and part 5 touch at 1.000, -2.000, 0.125 mm");
    event = missed_by_tolerance(0, 50.00004, 0);
    assert_string_equal(
        text_of(&event, NULL),
        "near miss: wafer 2, gripper 1: |dr_proj_xy| 50.00004 is not below 50 (by 0.00004 mm)");
}

/* Between two slices 0.998 of the limit counts: the text says so, with the tolerance and without it. */
static void a_swept_near_miss_names_the_limit_that_was_applied(void **state) {
    (void)state;
    wh_grasp_config_t config = wh_grasp_config_default();
    const wh_event_names_t names = {.tolerance = &config.tolerance};
    cell_t cell;
    config.check = SWEPT_IF_BUILT;
    cell_begin(&cell, &config);
    cell_move(&cell, 0, 50 - 30 * 0.3348, 0, -0.6, OPEN);
    cell_move(&cell, 0, 50 + 30 * (1 - 0.3348), 0, -0.3, OPEN);
    cell_move(&cell, 0, 300, 0, -0.3, OPEN);
    const wh_event_t *miss = cell_event(&cell, WH_EVENT_NEAR_MISS);
    assert_non_null(miss);
    if (WH_SWEEP_BUILT) {
        static const char text[] = "near miss: wafer 0, gripper 0: |dr_proj_z| 0.4998 is not below 0.499 "
                                   "(by 0.0008 mm)";
        assert_string_equal(text_of(miss, &names), text);
        assert_string_equal(text_of(miss, NULL), text);
    }
}

static void each_condition_that_failed_is_a_reason(void **state) {
    (void)state;
    const wh_event_t event = missed_by_tolerance(0.75, 60, 0.2);
    char reason[WH_EVENT_TEXT_SIZE];
    size_t count = 0;
    while (wh_event_reason(&event, NULL, count, reason, sizeof reason) > 0) {
        ++count;
    }
    assert_int_equal(count, 3);
    assert_string_equal(reason, "");
    (void)wh_event_reason(&event, NULL, 2, reason, sizeof reason);
    assert_string_equal(reason, "n1_proj_n2 0.980067 is not above 0.99 (by 0.009933): tilted by 11.459 deg");
}

static void each_kind_has_its_words(void **state) {
    (void)state;
    static const struct {
        wh_event_kind_t kind;
        const char *text;
    } wanted[] = {
        {WH_EVENT_PICKED,
         "picked: wafer 2, gripper 1: |dr_proj_z| 0.000 mm, |dr_proj_xy| 0.000 mm, n1_proj_n2 0.000000"},
        {WH_EVENT_RELEASED, "released: wafer 2, gripper 1"},
        {WH_EVENT_HANDED_OVER,
         "handed over: wafer 2, gripper 1: from gripper 3, |dr_proj_z| 0.000 mm, |dr_proj_xy| 0.000 "
         "mm, n1_proj_n2 0.000000"},
        {WH_EVENT_CONTESTED, "contested: wafer 2, gripper 1: ready, but gripper 3 holds it"},
        {WH_EVENT_BAD_INPUT, "bad input: wafer 2, gripper 1: a number is NaN or infinite"},
        {WH_EVENT_RELEASED_UNSUPPORTED, "released unsupported: wafer 2, gripper 1: in no slot, tilted by "
                                        "42.972 deg, 3.250 mm above the nearest slot below or the floor"},
        {WH_EVENT_SLOT_OCCUPIED, "slot occupied: wafer 2, gripper 1: wafer 3 lies in that slot"},
        {WH_EVENT_PLACED_OFF_CENTRE,
         "placed off centre: wafer 2, gripper 1: 0.750 mm beside the centre (limit 0.5 mm)"},
        {WH_EVENT_PLACED_ASKEW, "placed askew: wafer 2, gripper 1: tilted by 42.972 deg (limit 28.6479 deg)"},
        {WH_EVENT_SETTLED, "settled: wafer 2, gripper 1: 0.750 mm lower"},
        {WH_EVENT_HIT, "hit: wafer 2, gripper 1: part 4 and part 5 touch at 1.000, -2.000, 0.125 mm"},
        {WH_EVENT_UNDECIDED,
         "undecided: wafer 2, gripper 1: whether part 4 and part 5 touch could not be decided"},
        {WH_EVENT_TOO_CLOSE,
         "too close: wafer 2, gripper 1: part 4 and part 5: 0.750 mm apart (limit 0.5 mm)"},
        {WH_EVENT_SLIPPED, "slipped: wafer 2, gripper 1: the motion asks for 1 mm/s^2, the pads carry 0"},
        {WH_EVENT_VACUUM_LOST,
         "vacuum lost: wafer 2, gripper 1: 75 % of the full vacuum, the sensor wants 50"},
        {WH_EVENT_FAULT_ARMED, "fault armed: wafer 2, gripper 1: valve_stuck, fault 4"},
        {WH_EVENT_FAULT_CLEARED, "fault cleared: wafer 2, gripper 1: valve_stuck, fault 4"},
        {WH_EVENT_PUSHED_THROUGH, "pushed through: wafer 2, gripper 1: down through its slot, 0.750 mm below "
                                  "the plane (limit 0.5 mm)"}};
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; ++i) {
        wh_event_t event = event_of(wanted[i].kind);
        event.status = WH_STATUS_NOT_FINITE;
        event.height = WH_REAL(3.25);
        event.value = WH_REAL(0.75);
        event.limit = event.kind == WH_EVENT_RELEASED_UNSUPPORTED ? 0 : WH_REAL(0.5);
        event.at = wh_vec3(1, -2, WH_REAL(0.125));
        event.other = event.kind == WH_EVENT_PUSHED_THROUGH ? WH_NONE : event.other;
        assert_string_equal(text_of(&event, NULL), wanted[i].text);
    }
    assert_int_equal(sizeof wanted / sizeof wanted[0], WH_EVENT_KINDS - 1); /* all but the near miss */
}

static const char *find(const void *user, wh_name_kind_t kind, int32_t index) {
    static const char *const names[3][6] = {{"A1", "A2", "A3", "A4", NULL, NULL},
                                            {"left", "right", NULL, "chuck", NULL, NULL},
                                            {NULL, NULL, NULL, NULL, "blade", NULL}};
    assert_string_equal(user, "user");
    return index >= 0 && index < 6 ? names[kind][index] : NULL;
}

static void things_have_their_names(void **state) {
    (void)state;
    const wh_event_names_t names = {.find = find, .user = "user", .first = 1, .degree = "\xc2\xb0"};
    wh_event_t event = event_of(WH_EVENT_CONTESTED);
    assert_string_equal(text_of(&event, &names), "contested: A3, right: ready, but chuck holds it");
    event.kind = WH_EVENT_PUSHED_THROUGH;
    assert_string_equal(text_of(&event, &names), "pushed through: A3, right: it goes through A4");
    event.wafer = WH_NONE;
    assert_string_equal(text_of(&event, &names), "pushed through: right: its blade goes through A4");
    event.wafer = 2;
    event.other = WH_NONE;
    event.value = WH_REAL(-0.25);
    event.limit = 1;
    assert_string_equal(
        text_of(&event, &names),
        "pushed through: A3, right: up through a slot, its face now at 0.250 mm over the plane");
    event.value = event.limit = 0;
    event.gripper = 2;
    event.kind = WH_EVENT_RELEASED;
    assert_string_equal(text_of(&event, &names), "released: A3, gripper 3");
    event.kind = WH_EVENT_HIT;
    event.wafer = event.gripper = WH_NONE;
    assert_string_equal(text_of(&event, &names), "hit: blade and part 6 touch at 0.000, 0.000, 0.000 mm");
    event.kind = WH_EVENT_UNDECIDED;
    event.parts[0] = event.parts[1] = WH_NONE;
    assert_string_equal(
        text_of(&event, NULL),
        "undecided: none is near to more parts and wafers than can be looked at: whether it touches one is "
        "not known (keep it farther away, or give it a smaller shape)");
    event.parts[0] = 5;
    event.value = 153;
    event.limit = 128;
    assert_string_equal(
        text_of(&event, &names),
        "undecided: part 6 is near to 153 parts and wafers at once, of which 128 can be looked at: whether "
        "it touches one is not known (keep it farther away, or give it a smaller shape)");
    event.kind = WH_EVENT_FAULT_ARMED;
    event.gripper = 0;
    event.parts[0] = 0;
    event.parts[1] = WH_FAULT_LEAK;
    assert_string_equal(text_of(&event, &names), "fault armed: left: leak, fault 1");
    event.kind = WH_EVENT_PLACED_ASKEW;
    event.value = event.limit = 0;
    assert_string_equal(text_of(&event, &names),
                        "placed askew: left: tilted by 0.000\xc2\xb0 (limit 0\xc2\xb0)");
}

/* Whatever an event contains, its text ends within the buffer, and the whole text begins with the
 * part that fits. */
static void what_does_not_fit_is_cut_off(void **state) {
    (void)state;
    for (int run = 0; run < 2000; ++run) {
        wh_event_t event = missed_by_tolerance(0.75, 60, 0.2);
        event.kind = (wh_event_kind_t)wh_test_below(WH_EVENT_KINDS + 2);
        event.value = WH_REAL(wh_test_decades(1e-20, 1e20));
        event.wafer = event.other = (int32_t)wh_test_random();
        event.parts[0] = event.parts[1] = (int32_t)wh_test_random();
        char whole[2 * WH_EVENT_TEXT_SIZE];
        char part[WH_EVENT_TEXT_SIZE + 1];
        const size_t length = wh_event_text(&event, NULL, whole, sizeof whole);
        const size_t size = wh_test_below(WH_EVENT_TEXT_SIZE);
        assert_true(length > 0 && length < WH_EVENT_TEXT_SIZE);
        memset(part, '#', sizeof part);
        assert_int_equal(wh_event_text(&event, NULL, part, size), length);
        if (size > 0) {
            const size_t kept = length < size ? length : size - 1;
            assert_int_equal(strlen(part), kept);
            assert_memory_equal(part, whole, kept);
        }
        assert_int_equal(part[size], '#');
    }
    const wh_event_t event = event_of(WH_EVENT_RELEASED);
    assert_int_equal(wh_event_text(&event, NULL, NULL, 0), strlen("released: wafer 2, gripper 1"));
}

/* Past the last reason there is nothing, however far past: that takes no time. */
static void there_is_no_reason_beyond_the_last(void **state) {
    (void)state;
    wh_event_t event = missed_by_tolerance(0.75, 60, 0.2);
    char text[WH_EVENT_TEXT_SIZE];
    for (unsigned failed = 0; failed < 8; ++failed) {
        const size_t beyond[] = {3, 4, 1000, SIZE_MAX - 1, SIZE_MAX};
        event.measured.failed = failed;
        for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; ++i) {
            text[0] = '#';
            assert_int_equal(wh_event_reason(&event, NULL, beyond[i], text, sizeof text), 0);
            assert_string_equal(text, "");
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decimals_are_those_of_printf),
        cmocka_unit_test(halves_are_rounded_to_even),
        cmocka_unit_test(short_numbers_are_those_of_printf_without_exponents),
        cmocka_unit_test(numbers_that_have_no_digits_are_named),
        cmocka_unit_test(whole_numbers_are_written_in_full),
        cmocka_unit_test(a_missed_pick_is_explained),
        cmocka_unit_test(a_value_beside_its_limit_does_not_read_as_the_limit),
        cmocka_unit_test(a_swept_near_miss_names_the_limit_that_was_applied),
        cmocka_unit_test(each_condition_that_failed_is_a_reason),
        cmocka_unit_test(each_kind_has_its_words),
        cmocka_unit_test(things_have_their_names),
        cmocka_unit_test(what_does_not_fit_is_cut_off),
        cmocka_unit_test(there_is_no_reason_beyond_the_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
