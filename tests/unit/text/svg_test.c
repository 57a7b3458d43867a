/* The contents of pages and pictures: texts that are fit for XML, labels that keep apart, bytes in
 * base 64 and deflated ones, which zlib inflates again. */
#include "text/svg.h"

#include <zlib.h>

#include "support/support.h"
#include "text/packed.h"

/* ------------------------------------------------------------------------------------------------- labels */

static void expect_text(const char *text, const char *wanted) {
    char *written = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&written, &size);
    wh_svg_text(out, text);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(written, wanted);
    free(written);
}

static void text_is_fit_for_xml(void **state) {
    (void)state;
    expect_text("", "");
    expect_text("a<b> & \"c\" 'd'", "a&lt;b&gt; &amp; &quot;c&quot; 'd'");
    expect_text("µ→\xff\n\x7f", "µ→\xef\xbf\xbd\xef\xbf\xbd\x7f");
    expect_text("\xef\xbf\xbe|\xef\xbf\xbf|\xef\xbf\xbd|\xf0\x9d\x84\x9e",
                "\xef\xbf\xbd|\xef\xbf\xbd|\xef\xbf\xbd|\xf0\x9d\x84\x9e");
}

static bool overlap(const wh_svg_box_t *a, const wh_svg_box_t *b) {
    return !(a->x + a->width <= b->x || b->x + b->width <= a->x || a->y + a->height <= b->y ||
             b->y + b->height <= a->y);
}

/* Each label of the picture, read back, lies in its box. */
static void check_label(const char **written, const wh_svg_labels_t *labels, size_t i, const char *text) {
    char wanted[160];
    const wh_svg_box_t *box = &labels->taken[i];
    (void)snprintf(wanted, sizeof wanted, "<text class=\"label\" x=\"%.1f\" y=\"%.1f\">%s</text>\n",
                   box->x + box->width / 2, box->y + labels->size, text);
    assert_int_equal(strncmp(*written, wanted, strlen(wanted)), 0);
    *written += strlen(wanted);
}

static void labels_keep_apart_and_in_the_picture(void **state) {
    (void)state;
    enum { COUNT = 40 };
    static const char *const texts[] = {"A", "station", "µm"};
    char *written = NULL;
    size_t size = 0;
    wh_svg_labels_t labels = {.out = open_memstream(&written, &size), .size = 10, .left = 0, .right = 200};
    double wanted_y[COUNT];
    for (size_t i = 0; i < COUNT; ++i) {
        wanted_y[i] = wh_test_uniform(0, 60);
        wh_svg_label(&labels, wh_test_uniform(-20, 220), wanted_y[i], texts[i % 3]);
    }
    assert_int_equal(fclose(labels.out), 0);
    assert_int_equal(labels.count, COUNT);
    const char *at = written;
    for (size_t i = 0; i < COUNT; ++i) {
        const wh_svg_box_t *box = &labels.taken[i];
        check_label(&at, &labels, i, texts[i % 3]);
        assert_near(box->width, i % 3 == 0 ? 6 : i % 3 == 1 ? 42 : 12, 1e-9);
        assert_true(box->x >= 0 && box->x + box->width <= 200 + 1e-9);
        assert_true(box->y >= wanted_y[i] - labels.size);
        for (size_t k = 0; k < i; ++k) {
            assert_false(overlap(box, &labels.taken[k]));
        }
    }
    assert_string_equal(at, "");
    free(written);
}

static void a_free_place_is_taken_as_it_is(void **state) {
    (void)state;
    char *written = NULL;
    size_t size = 0;
    wh_svg_labels_t labels = {.out = open_memstream(&written, &size), .size = 10, .left = 0, .right = 200};
    wh_svg_label(&labels, 100, 50, "A");
    wh_svg_label(&labels, 106, 50, "B");   /* side by side */
    wh_svg_label(&labels, 100, 38.5, "C"); /* one above the other */
    wh_svg_label(&labels, 100, 50, "D");
    labels.count = WH_SVG_LABELS;
    wh_svg_label(&labels, 0, 0, "too many");
    assert_int_equal(fclose(labels.out), 0);
    assert_string_equal(written, "<text class=\"label\" x=\"100.0\" y=\"50.0\">A</text>\n"
                                 "<text class=\"label\" x=\"106.0\" y=\"50.0\">B</text>\n"
                                 "<text class=\"label\" x=\"100.0\" y=\"38.5\">C</text>\n"
                                 "<text class=\"label\" x=\"100.0\" y=\"61.5\">D</text>\n");
    free(written);
}

/* ------------------------------------------------------------------------------------------------- packed */

static void expect_packed(const char *bytes, const char *wanted) {
    char *text = wh_packed_bytes("head,", (const uint8_t *)bytes, strlen(bytes));
    assert_int_equal(strncmp(text, "head,", 5), 0);
    assert_string_equal(text + 5, wanted);
    free(text);
}

/* The test vectors of RFC 4648, and all digits. */
static void bytes_are_in_base_64(void **state) {
    (void)state;
    expect_packed("", "");
    expect_packed("f", "Zg==");
    expect_packed("fo", "Zm8=");
    expect_packed("foo", "Zm9v");
    expect_packed("foob", "Zm9vYg==");
    expect_packed("fooba", "Zm9vYmE=");
    expect_packed("foobar", "Zm9vYmFy");
    expect_packed("\xff\xef\xbe\xfb", "/+++"
                                      "+w==");
}

static uint32_t digit_of(char character) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = character == '=' ? digits : strchr(digits, character);
    assert_non_null(found);
    return (uint32_t)(found - digits);
}

static size_t unpack(const char *text, uint8_t bytes[]) {
    size_t size = 0;
    for (; *text != '\0'; text += 4) {
        const uint32_t bits =
            digit_of(text[0]) << 18 | digit_of(text[1]) << 12 | digit_of(text[2]) << 6 | digit_of(text[3]);
        bytes[size++] = (uint8_t)(bits >> 16);
        bytes[size++] = (uint8_t)(bits >> 8);
        bytes[size++] = (uint8_t)bits;
        size -= text[3] != '=' ? 0 : text[2] != '=' ? 1 : 2;
    }
    return size;
}

static void long_texts_are_deflated(void **state) {
    (void)state;
    enum { SIZE = 5000 };
    static char text[SIZE];
    static char again[SIZE];
    static uint8_t bytes[2 * SIZE];
    for (size_t size = 0; size <= SIZE; size += 1000) {
        for (size_t i = 0; i < size; ++i) {
            text[i] = "0123,.-"[wh_test_below(7)];
        }
        char *packed = wh_packed_text(text, size);
        const size_t packed_size = unpack(packed, bytes);
        uLongf again_size = SIZE;
        assert_int_equal(uncompress((Bytef *)again, &again_size, bytes, (uLong)packed_size), Z_OK);
        assert_int_equal(again_size, size);
        assert_memory_equal(again, text, size);
        assert_true(size == 0 || packed_size < size * 3 / 5);
        free(packed);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_fit_for_xml),
        cmocka_unit_test(labels_keep_apart_and_in_the_picture),
        cmocka_unit_test(a_free_place_is_taken_as_it_is),
        cmocka_unit_test(bytes_are_in_base_64),
        cmocka_unit_test(long_texts_are_deflated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
