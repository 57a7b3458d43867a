/* A scalar's row: its value in the struct, its unit and its type. */
#include "support/support.h"

#include "math/hash.h"
#include "script/field.h"

typedef struct {
    double length, angle;
    int32_t count;
    uint64_t seed;
    bool is_on;
    enum { LEFT, RIGHT } side;
} thing_t;

static const char *const sides[] = {"left", "right", NULL};

static const wh_reader_field_t rows[] = {
    {"length", "number", "mm/s: how fast", false, WH_SCALAR_NUMBER, offsetof(thing_t, length), 0, 10, 1,
     NULL},
    {"angle", "number", "degrees about z", false, WH_SCALAR_DEGREES, offsetof(thing_t, angle), 0, 360, 0,
     NULL},
    {"count", "integer", "how many", false, WH_SCALAR_WHOLE, offsetof(thing_t, count), 0, 9, 0, NULL},
    {"seed", "integer", "names the noise", false, WH_SCALAR_SEED, offsetof(thing_t, seed), 0, 9, 0, NULL},
    {"on", "boolean", "true: it is", false, WH_SCALAR_SWITCH, offsetof(thing_t, is_on), 0, 1, 0, NULL},
    {"side", "", "which", false, WH_SCALAR_WORD, offsetof(thing_t, side), 0, 0, 0, sides},
    {"name", "string", "sN: not a unit", false},
    {NULL, NULL, NULL, false}};

static void a_scalar_is_set_and_got_in_its_own_unit(void **state) {
    (void)state;
    thing_t thing = {0};
    for (const wh_reader_field_t *row = rows; row->kind != WH_SCALAR_BY_HAND; ++row) {
        wh_field_set(row, 1, &thing);
        assert_near(wh_field_get(row, &thing), 1, 1e-15);
    }
    assert_near(thing.length, 1, 0);
    assert_near(thing.angle, 0.017453292519943295, 1e-18);
    assert_int_equal(thing.count, 1);
    assert_int_equal(thing.seed, 1);
    assert_true(thing.is_on);
    assert_int_equal(thing.side, RIGHT);
}

static void a_field_that_is_no_scalar_has_no_value(void **state) {
    (void)state;
    thing_t thing = {.length = 7};
    const wh_reader_field_t *name = wh_field_find(rows, "name");
    wh_field_set(name, 1, &thing);
    assert_near(wh_field_get(name, &thing), 0, 0);
    assert_near(thing.length, 7, 0);
    assert_null(wh_field_find(rows, "nam"));
}

static void a_member_is_hashed_as_the_struct_has_it(void **state) {
    (void)state;
    thing_t thing = {.length = 2, .angle = 0.5, .count = 3, .is_on = true, .side = RIGHT};
    const uint64_t hashes[] = {wh_hash_real(WH_HASH_START, 2), wh_hash_real(WH_HASH_START, 0.5),
                               wh_hash_int(WH_HASH_START, 3),  wh_hash_int(WH_HASH_START, 0),
                               wh_hash_int(WH_HASH_START, 1),  wh_hash_int(WH_HASH_START, 1)};
    for (size_t i = 0; wh_field_is_member(&rows[i]); ++i) {
        assert_int_equal(wh_field_hash(&rows[i], &thing, WH_HASH_START), hashes[i]);
    }
    assert_false(wh_field_is_member(wh_field_find(rows, "name")));
}

static void a_text_begins_with_the_unit(void **state) {
    (void)state;
    static const char *const units[] = {"mm/s", "degrees", "", "", "", "", ""};
    for (size_t i = 0; rows[i].name; ++i) {
        char unit[WH_FIELD_UNIT_BYTES];
        wh_field_unit(&rows[i], unit);
        assert_string_equal(unit, units[i]);
    }
}

static void an_enumeration_has_its_type_from_its_words(void **state) {
    (void)state;
    char type[40];
    wh_field_type(wh_field_find(rows, "side"), type, sizeof type);
    assert_string_equal(type, "\"left\"|\"right\"");
    wh_field_type(wh_field_find(rows, "count"), type, sizeof type);
    assert_string_equal(type, "integer");
    wh_field_type(wh_field_find(rows, "side"), type, 9);
    assert_string_equal(type, "\"left\"|\"");
}

static void numbers_are_told_from_other_scalars(void **state) {
    (void)state;
    for (size_t i = 0; rows[i].name; ++i) {
        assert_int_equal(wh_field_is_number(&rows[i]), i < 4);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scalar_is_set_and_got_in_its_own_unit),
        cmocka_unit_test(a_field_that_is_no_scalar_has_no_value),
        cmocka_unit_test(a_member_is_hashed_as_the_struct_has_it),
        cmocka_unit_test(a_text_begins_with_the_unit),
        cmocka_unit_test(an_enumeration_has_its_type_from_its_words),
        cmocka_unit_test(numbers_are_told_from_other_scalars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
