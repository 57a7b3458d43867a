/* JSON as it is built, printed and written in a stream: read back by jansson, with digits compared
 * with printf's. */
#include "text/json.h"

#include "support/support.h"

/* The whole written text; the caller frees it. */
typedef struct {
    FILE *out;
    char *text;
    size_t size;
} paper_t;

static FILE *take_paper(paper_t *paper) {
    memset(paper, 0, sizeof *paper);
    paper->out = open_memstream(&paper->text, &paper->size);
    assert_non_null(paper->out);
    return paper->out;
}

static void expect_written(paper_t *paper, const char *wanted) {
    assert_int_equal(fclose(paper->out), 0);
    assert_string_equal(paper->text, wanted);
    free(paper->text);
}

static void expect_json(json_t *value, const char *wanted) {
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
    assert_non_null(text);
    assert_string_equal(text, wanted);
    free(text);
    json_decref(value);
}

/* ------------------------------------------------------------------------------------------------- values */

static void values_are_made_as_the_header_says(void **state) {
    (void)state;
    const wh_vec3_t v = {1, 2.5, WH_REAL(NAN)};
    const wh_mat3_t m = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
    expect_json(wh_json_real((double)INFINITY), "null");
    expect_json(wh_json_real(-0.5), "-0.5");
    expect_json(wh_json_hash(0xabc), "\"0000000000000abc\"");
    expect_json(wh_json_text(NULL), "null");
    expect_json(wh_json_text("a\xff"), "\"a\xef\xbf\xbd\"");
    expect_json(wh_json_vector(v), "[1.0,2.5,null]");
    expect_json(wh_json_matrix(&m), "[[1.0,2.0,3.0],[4.0,5.0,6.0],[7.0,8.0,9.0]]");
}

static void members_are_set_by_their_conversions(void **state) {
    (void)state;
    json_t *object =
        wh_json_set(json_object(), "real %g text %s whole %d long %lld no %lld yes %i not %i hash %llx", 0.25,
                    "word", -3, 1LL << 40, WH_JSON_NONE, 7, 0, 0xfeULL);
    expect_json(object, "{\"real\":0.25,\"text\":\"word\",\"whole\":-3,\"long\":1099511627776,"
                        "\"no\":null,\"yes\":true,\"not\":false,\"hash\":\"00000000000000fe\"}");
    expect_json(wh_json_set(json_object(), "d %g", (double)NAN), "{\"d\":null}");
}

static void values_are_added_in_the_order_of_their_names(void **state) {
    (void)state;
    json_t *object =
        wh_json_add(json_object(), "a  longer b", json_integer(1), json_true(), json_null(), NULL);
    wh_json_put(object, "a", json_integer(2));
    expect_json(object, "{\"a\":2,\"longer\":true,\"b\":null}");
}

static json_t *odd_one(const void *subject, size_t i) {
    return i % 2 == 1 ? json_integer(*(const int *)subject + (int)i) : NULL;
}

static void a_list_leaves_out_what_is_not_made(void **state) {
    (void)state;
    const int base = 10;
    expect_json(wh_json_list(odd_one, &base, 6), "[11,13,15]");
    expect_json(wh_json_list(odd_one, &base, 0), "[]");
}

/* ----------------------------------------------------------------------------------------------- printing */

static void each_member_and_element_has_its_line(void **state) {
    (void)state;
    paper_t paper;
    json_t *root =
        json_pack("{s: i, s: [], s: [i, {s: s}], s: s}", "a", 1, "none", "list", 1, "b", "c", "last", "d");
    assert_int_equal(wh_json_print(root, take_paper(&paper)), 0);
    json_decref(root);
    expect_written(&paper, "{\n  \"a\": 1,\n  \"none\": [],\n  \"list\": [\n    1,\n    {\"b\": \"c\"}\n  "
                           "],\n  \"last\": \"d\"\n}\n");
}

static void what_steers_terminals_is_escaped(void **state) {
    (void)state;
    paper_t paper;
    json_t *root = json_pack("{s: s}", "a", "x\x7fy\xc2\x80z\xc2\x9f\xc2\xa0\x1b");
    assert_int_equal(wh_json_print(root, take_paper(&paper)), 0);
    json_decref(root);
    expect_written(&paper, "{\n  \"a\": \"x\\u007fy\\u0080z\\u009f\xc2\xa0\\u001B\"\n}\n");
}

static void what_cannot_be_written_is_told(void **state) {
    (void)state;
    json_t *root = json_pack("{s: i}", "a", 1);
    FILE *full = fopen("/dev/full", "w");
    assert_non_null(full);
    assert_int_equal(wh_json_print(root, full), -1);
    (void)fclose(full);
    json_decref(root);
}

/* -------------------------------------------------------------------------------------------- as it comes */

static void commas_stand_between_elements_alone(void **state) {
    (void)state;
    paper_t paper;
    wh_json_text_t text = {.out = take_paper(&paper)};
    wh_json_text_begin(&text, NULL, '{');
    wh_json_text_begin(&text, "list", '[');
    wh_json_text_integer(&text, NULL, -7);
    wh_json_text_number(&text, NULL, 0.125, 2, false);
    wh_json_text_number(&text, NULL, 0.1, 0, true);
    wh_json_text_begin(&text, NULL, '[');
    wh_json_text_end(&text, ']');
    wh_json_text_end(&text, ']');
    wh_json_text_string(&text, "name", "<b>&\"");
    wh_json_text_string(&text, "none", NULL);
    wh_json_text_number(&text, "not", (double)NAN, 3, true);
    wh_json_text_value(&text, "value", json_pack("[i, s]", 1, "a</script>"));
    assert_false(text.failed);
    wh_json_text_string(&text, "bad", "\xff");
    assert_true(text.failed);
    wh_json_text_end(&text, '}');
    expect_written(&paper,
                   "{\"list\":[-7,0.13,0.1,[]],\"name\":\"\\u003cb>&\\\"\",\"none\":null,\"not\":null,"
                   "\"value\":[1,\"a\\u003c/script>\"],\"bad\":null}");
}

/* printf's digits without the zeros at their end, except if a half decides. */
static void expect_rounded(double value, int decimals) {
    paper_t paper;
    char wanted[64];
    wh_json_text_t text = {.out = take_paper(&paper)};
    wh_json_text_number(&text, NULL, value, decimals, false);
    (void)snprintf(wanted, sizeof wanted, "%.*f", decimals, value);
    char *end = wanted + strlen(wanted);
    while (decimals > 0 && (end[-1] == '0' || end[-1] == '.')) {
        const bool is_point = end[-1] == '.';
        *--end = '\0';
        if (is_point) {
            break;
        }
    }
    expect_written(&paper, strcmp(wanted, "-0") == 0 ? "0" : wanted);
}

static void rounded_numbers_have_printfs_digits(void **state) {
    (void)state;
    static const double edges[] = {0,    -0.0,    1,     -1,      10,         100,   0.5,
                                   0.25, -0.0004, 0.001, 99.9999, -12345.678, 123456};
    for (int decimals = 0; decimals <= 9; ++decimals) {
        for (size_t i = 0; i < sizeof edges / sizeof edges[0]; ++i) {
            /* A half is rounded away from zero here, and to the even digit there. */
            expect_rounded(edges[i] == 0.5 || edges[i] == 0.25 ? edges[i] + 1e-4 : edges[i], decimals);
        }
        for (int i = 0; i < 200; ++i) {
            const double sign = wh_test_below(2) == 0 ? -1 : 1;
            expect_rounded(sign * wh_test_decades(1e-6, 1e5), decimals);
        }
    }
}

static void large_numbers_are_written_whole(void **state) {
    (void)state;
    paper_t paper;
    wh_json_text_t text = {.out = take_paper(&paper)};
    wh_json_text_number(&text, NULL, 1e300, 9, false);
    wh_json_text_number(&text, NULL, -123456789.5, 9, false);
    wh_json_text_number(&text, NULL, 0.1 + 0.2, 9, true);
    expect_written(&paper, "1e+300,-123456789.5,0.30000000000000004");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_made_as_the_header_says),
        cmocka_unit_test(members_are_set_by_their_conversions),
        cmocka_unit_test(values_are_added_in_the_order_of_their_names),
        cmocka_unit_test(a_list_leaves_out_what_is_not_made),
        cmocka_unit_test(each_member_and_element_has_its_line),
        cmocka_unit_test(what_steers_terminals_is_escaped),
        cmocka_unit_test(what_cannot_be_written_is_told),
        cmocka_unit_test(commas_stand_between_elements_alone),
        cmocka_unit_test(rounded_numbers_have_printfs_digits),
        cmocka_unit_test(large_numbers_are_written_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
