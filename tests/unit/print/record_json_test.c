/* The record as JSON: read back, it is the record; two results are compared member by member. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "print/record_print.h"
#include "support/record.h"
#include "text/json_compare.h"

/* Prints a record and parses it again. */
static json_t *reread(const wh_record_t *record) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_json(record, out), 0);
    fclose(out);
    json_error_t error;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!root) {
        print_error("line %d: %s\n%s\n", error.line, error.text, text);
    }
    assert_non_null(root);
    free(text);
    return root;
}

/* The object's keys are these, in this order; `keys` ends with null. */
static void assert_keys(json_t *object, const char *const *keys) {
    const char *key;
    json_t *value;
    size_t i = 0;
    json_object_foreach(object, key, value) {
        assert_non_null(keys[i]);
        assert_string_equal(key, keys[i]);
        ++i;
    }
    assert_null(keys[i]);
}

static json_t *element(json_t *root, const char *list, size_t i) {
    json_t *value = json_array_get(json_object_get(root, list), i);
    assert_non_null(value);
    return value;
}

static void assert_text(json_t *object, const char *key, const char *text) {
    json_t *value = json_object_get(object, key);
    assert_non_null(value);
    if (text) {
        assert_string_equal(json_string_value(value), text);
    } else {
        assert_true(json_is_null(value));
    }
}

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void assert_real(json_t *object, const char *key, double value) {
    json_t *found = json_object_get(object, key);
    assert_true(json_is_real(found));
    assert_true(bits_of(json_real_value(found)) == bits_of(value));
}

static void head(void **state) {
    static const char *const keys[] = {"format",       "ok",          "script",   "layout", "slices",
                                       "missed",       "simulated_s", "wall_s",   "hash",   "throughput",
                                       "steady_cycle", "split",       "commands", "wafers", "events",
                                       "expectations", "cycles",      "gantt",    "reach",  NULL};
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    json_t *root = reread(&f.record);
    assert_keys(root, keys);
    assert_int_equal(json_integer_value(json_object_get(root, "format")), 2);
    assert_true(json_is_true(json_object_get(root, "ok")));
    assert_text(root, "script", "lua/examples/01_transfer.lua");
    assert_text(root, "layout", "lua/layouts/paper.lua");
    assert_int_equal(json_integer_value(json_object_get(root, "slices")), 22870);
    assert_real(root, "simulated_s", 22.87);
    assert_real(root, "wall_s", 0.0087);
    assert_text(root, "hash", "00c0ffee12345678");
    json_decref(root);
}

static void empty(void **state) {
    static fixture_t f;
    (void)state;
    fixture_empty(&f);
    json_t *root = reread(&f.record);
    assert_text(root, "script", NULL);
    assert_text(root, "layout", NULL);
    assert_text(root, "hash", "0000000000000000");
    assert_int_equal(json_array_size(json_object_get(root, "commands")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "wafers")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "events")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "expectations")), 0);
    json_decref(root);
}

static void failure_and_commands(void **state) {
    static const char *const keys[] = {"line", "text", "error", "begin_s", "end_s", "split", NULL};
    static const char *const keys_failed[] = {"line",  "text",  "error",   "begin_s",
                                              "end_s", "split", "message", NULL};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    assert_true(json_is_false(json_object_get(root, "ok")));
    assert_text(root, "failure", "02_prealigner.lua:9: error 42: wafer missing");
    assert_keys(element(root, "commands", 0), keys);
    json_t *failed = element(root, "commands", 2);
    assert_keys(failed, keys_failed);
    assert_text(failed, "text", "GET A 3");
    assert_int_equal(json_integer_value(json_object_get(failed, "error")), 42);
    assert_int_equal(json_integer_value(json_object_get(failed, "line")), 9);
    assert_real(failed, "begin_s", 30.5);
    assert_real(failed, "end_s", 33.75);
    json_decref(root);
}

static void wafers_are_written(void **state) {
    static const char *const keys[] = {"name", "holder",   "station",   "slot",     "dx",       "dy",
                                       "dz",   "tilt_deg", "notch_deg", "position", "rotation", NULL};
    static const char *const nulls[] = {"holder", "station", "slot", "dx", "dy", "dz", "tilt_deg"};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    f.wafers[1].base_from_wafer.r = wh_vec3(1.5, -0.0, 1e-310);
    f.wafers[1].base_from_wafer.R.m[1][2] = 0.1;
    json_t *root = reread(&f.record);
    json_t *held = element(root, "wafers", 1);
    assert_keys(held, keys);
    assert_text(held, "name", "Wafer 2");
    assert_text(held, "holder", "PA");
    assert_text(held, "station", "P");
    assert_int_equal(json_integer_value(json_object_get(held, "slot")), 1);
    assert_real(held, "dx", 13.794);
    assert_real(held, "tilt_deg", 0);
    assert_real(held, "notch_deg", 0);
    json_t *position = json_object_get(held, "position");
    assert_int_equal(json_array_size(position), 3);
    assert_true(bits_of(json_real_value(json_array_get(position, 1))) == bits_of(-0.0));
    assert_true(bits_of(json_real_value(json_array_get(position, 2))) == bits_of(1e-310));
    json_t *row = json_array_get(json_object_get(held, "rotation"), 1);
    assert_int_equal(json_array_size(row), 3);
    assert_true(bits_of(json_real_value(json_array_get(row, 2))) == bits_of(0.1));
    json_t *nowhere = element(root, "wafers", 2);
    assert_text(nowhere, "name", "Wäfer №3");
    for (size_t i = 0; i < sizeof nulls / sizeof nulls[0]; ++i) {
        assert_text(nowhere, nulls[i], NULL);
    }
    json_decref(root);
}

#define EVENT_KEYS                                                                                           \
    "utime", "kind", "wafer", "gripper", "dr_proj_z", "dr_proj_xy", "dr_proj_xy_norm", "n1_proj_n2",         \
        "margins", "failed", "measured_utime"

static void event_kinds(void **state) {
    static const char *const picked[] = {EVENT_KEYS, NULL};
    static const char *const handed_over[] = {EVENT_KEYS, "from", NULL};
    static const char *const contested[] = {EVENT_KEYS, "holder", NULL};
    static const char *const unsupported[] = {EVENT_KEYS, "height", NULL};
    static const char *const occupied[] = {EVENT_KEYS, "other", NULL};
    static const char *const bad_input[] = {EVENT_KEYS, "status", "message", NULL};
    static const char *const *const keys[] = {picked,      handed_over, picked,   contested,
                                              unsupported, occupied,    bad_input};
    static const char *const kinds[] = {"picked",    "handed_over",          "near_miss",
                                        "contested", "released_unsupported", "slot_occupied",
                                        "bad_input"};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    for (size_t i = 0; i < 7; ++i) {
        assert_keys(element(root, "events", i), keys[i]);
        assert_text(element(root, "events", i), "kind", kinds[i]);
    }
    assert_text(element(root, "events", 1), "from", "EE");
    assert_text(element(root, "events", 3), "holder", "EE");
    assert_real(element(root, "events", 4), "height", 12.5);
    assert_text(element(root, "events", 5), "other", "Wafer 1");
    assert_text(element(root, "events", 6), "wafer", NULL);
    assert_text(element(root, "events", 6), "margins", NULL);
    assert_int_equal(json_integer_value(json_object_get(element(root, "events", 6), "status")), 2);
    json_decref(root);
}

static void event_values(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    const wh_proximity_t *measured = &f.events[2].event.measured;
    f.events[2].event.measured_slice = 31999;
    json_t *root = reread(&f.record);
    json_t *miss = element(root, "events", 2);
    assert_int_equal(json_integer_value(json_object_get(miss, "utime")), 32100000);
    assert_int_equal(json_integer_value(json_object_get(miss, "measured_utime")), 31999000);
    assert_text(miss, "wafer", "Wäfer №3");
    assert_text(miss, "gripper", "EE");
    assert_real(miss, "dr_proj_z", measured->dr_proj_z);
    assert_real(miss, "dr_proj_xy_norm", 55);
    assert_real(miss, "n1_proj_n2", 1);
    json_t *margins = json_object_get(miss, "margins");
    assert_real(margins, "projz", measured->margin_projz);
    assert_real(margins, "projxy", -5);
    assert_real(margins, "planar", measured->margin_planar);
    json_t *failed = json_object_get(miss, "failed");
    assert_int_equal(json_array_size(failed), 2);
    assert_string_equal(json_string_value(json_array_get(failed, 0)), "projz");
    assert_string_equal(json_string_value(json_array_get(failed, 1)), "projxy");
    json_decref(root);
}

/* Degrees, as the layout has its limit and a wafer its tilt. */
static void askew_in_degrees(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    const size_t i = f.record.event_count;
    wh_event_t *event = fixture_event(&f, WH_EVENT_PLACED_ASKEW, 33300000, 1, FIXTURE_EE);
    event->value = wh_rad_from_deg(90);
    event->limit = wh_rad_from_deg(45);
    event = fixture_event(&f, WH_EVENT_PLACED_OFF_CENTRE, 33300000, 1, FIXTURE_EE);
    event->value = 4;
    event->limit = 2;
    json_t *root = reread(&f.record);
    assert_real(element(root, "events", i), "value", 90);
    assert_real(element(root, "events", i), "limit", 45);
    assert_real(element(root, "events", i + 1), "value", 4);
    assert_real(element(root, "events", i + 1), "limit", 2);
    json_decref(root);
}

static void expectations_are_written(void **state) {
    static const char *const keys[] = {"line", "text", "ok", NULL};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    json_t *unmet = element(root, "expectations", 1);
    assert_keys(unmet, keys);
    assert_int_equal(json_integer_value(json_object_get(unmet, "line")), 12);
    assert_text(unmet, "text", "Wafer 3 on EE, but nobody holds it");
    assert_true(json_is_false(json_object_get(unmet, "ok")));
    assert_true(json_is_true(json_object_get(element(root, "expectations", 0), "ok")));
    json_decref(root);
}

/* Text may be anything, and NaN is no JSON. */
static void hostile_values(void **state) {
    static char wrong[] = "a\xff\xc3\xa4\xe2\x82 \x1b\"\n\xed\xa0\x80", broken[] = "\xf0\x9f";
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    f.commands[0].text = wrong;
    f.record.script = broken;
    f.commands[0].begin_s = (double)NAN;
    f.commands[0].end_s = -(double)INFINITY;
    f.events[0].event.wafer = 99;
    f.events[0].event.gripper = -7;
    json_t *root = reread(&f.record);
    assert_text(element(root, "commands", 0), "text",
                "a\xef\xbf\xbd\xc3\xa4\xef\xbf\xbd\xef\xbf\xbd \x1b\"\n"
                "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    assert_text(root, "script", "\xef\xbf\xbd\xef\xbf\xbd");
    assert_text(element(root, "commands", 0), "begin_s", NULL);
    assert_text(element(root, "commands", 0), "end_s", NULL);
    assert_text(element(root, "events", 0), "wafer", NULL);
    assert_text(element(root, "events", 0), "gripper", NULL);
    json_decref(root);
}

static void write_error(void **state) {
    static fixture_t f;
    (void)state;
    FILE *full = fopen("/dev/full", "w");
    if (!full) {
        skip();
    }
    fixture_transfer(&f);
    assert_int_equal(wh_record_print_json(&f.record, full), -1);
    fclose(full);
}

static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Any finite double; one in eight a denormal, one in eight of a magnitude that reports have. */
static double random_double(uint64_t *state) {
    double value;
    do {
        uint64_t bits = next_random(state);
        const uint64_t form = next_random(state) % 8;
        if (form == 0) {
            bits &= UINT64_C(0x800fffffffffffff);
        } else if (form == 1) {
            bits = (bits & UINT64_C(0x800fffffffffffff)) | ((UINT64_C(1013) + bits % 20) << 52);
        }
        memcpy(&value, &bits, sizeof value);
    } while (!isfinite(value));
    return value;
}

static void doubles_return_bit_for_bit(void **state) {
    static const double special[] = {0.0, -0.0, DBL_MAX, -DBL_MAX, DBL_MIN, -DBL_MIN, 4.9e-324, -4.9e-324};
    enum { COMMANDS = 50000 };
    static wh_command_record_t commands[COMMANDS];
    static fixture_t f;
    uint64_t random = 20261121;
    (void)state;
    fixture_empty(&f);
    for (size_t i = 0; i < COMMANDS; ++i) {
        commands[i].begin_s = i < 8 ? special[i] : random_double(&random);
        commands[i].end_s = random_double(&random);
    }
    f.record.commands = commands;
    f.record.command_count = COMMANDS;
    json_t *root = reread(&f.record);
    for (size_t i = 0; i < COMMANDS; ++i) {
        assert_real(element(root, "commands", i), "begin_s", commands[i].begin_s);
        assert_real(element(root, "commands", i), "end_s", commands[i].end_s);
    }
    json_decref(root);
}

/* --------------------------------------------------------------------------------------------- comparison */

static char told[500];

/* "path@time " for each difference. */
static void note(void *user, const wh_json_difference_t *difference) {
    const size_t length = strlen(told);
    assert_ptr_equal(user, told);
    assert_true(difference->a || difference->b);
    snprintf(told + length, sizeof told - length, isnan(difference->time_s) ? "%s " : "%s@%g ",
             difference->path, difference->time_s);
}

static void results_are_compared_member_by_member(void **state) {
    (void)state;
    static const char *const aside[] = {"wall_s", NULL};
    static const struct {
        const char *a, *b, *told;
    } rows[] = {
        {"{}", "{}", ""},
        {"{\"x\": 1}", "{\"x\": 1.0}", ""},
        {"{\"x\": 0.0}", "{\"x\": -0.0}", "x "},
        {"{\"x\": 1}", "{\"x\": \"1\"}", "x "},
        {"{\"x\": 9007199254740993}", "{\"x\": 9007199254740992}", "x "},
        {"{\"x\": null}", "{}", "x "},
        {"{\"wall_s\": 1, \"y\": {\"wall_s\": 2}}", "{\"y\": {}}", ""},
        {"{\"a\": 1, \"b\": {\"c\": [1, 2]}}", "{\"d\": 1, \"b\": {\"c\": [1, 3, 4]}}", "a b.c[1] b.c[2] d "},
        /* Times: an element's own, of two the earlier, that around it, and that of its place in the list beside. */
        {"{\"e\": [{\"utime\": 2000000, \"v\": 1}]}", "{\"e\": [{\"utime\": 2000000, \"v\": 2}]}",
         "e[0].v@2 "},
        {"{\"e\": [{\"begin_s\": 2}]}", "{\"e\": [{\"begin_s\": 3}]}", "e[0].begin_s@2 "},
        {"{\"e\": [{\"t\": 4, \"l\": [1]}]}", "{\"e\": [{\"t\": 4, \"l\": [2]}]}", "e[0].l[0]@4 "},
        {"{\"t\": [1, 2], \"v\": [5, 6]}", "{\"t\": [1, 2], \"v\": [5, 7]}", "v[1]@2 "},
        {"{\"t\": [1], \"v\": [5, 6]}", "{\"t\": [1], \"v\": [5, 7]}", "v[1] "},
        {"{\"begin_s\": 1, \"v\": 1}", "{\"begin_s\": 1, \"v\": 2}", "v "},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        json_t *a = json_loads(rows[i].a, 0, NULL);
        json_t *b = json_loads(rows[i].b, 0, NULL);
        assert_true(a && b);
        told[0] = '\0';
        wh_json_compare(a, b, aside, note, told);
        assert_string_equal(told, rows[i].told);
        json_decref(a);
        json_decref(b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(head),
        cmocka_unit_test(empty),
        cmocka_unit_test(failure_and_commands),
        cmocka_unit_test(wafers_are_written),
        cmocka_unit_test(event_kinds),
        cmocka_unit_test(event_values),
        cmocka_unit_test(askew_in_degrees),
        cmocka_unit_test(expectations_are_written),
        cmocka_unit_test(hostile_values),
        cmocka_unit_test(write_error),
        cmocka_unit_test(doubles_return_bit_for_bit),
        cmocka_unit_test(results_are_compared_member_by_member),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
