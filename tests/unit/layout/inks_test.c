/* The table of inks against the page's style sheet, and against itself. */
#include "support/support.h"

#include <string.h>

#include "layout/inks.h"
#include "script/embedded.h"

static const char *style_sheet(void) {
    for (size_t i = 0; i < wh_embedded_page_count; ++i) {
        if (strcmp(wh_embedded_page[i].name, "page.css") == 0) {
            return (const char *)wh_embedded_page[i].text;
        }
    }
    fail_msg("no page.css");
    return NULL;
}

/* The style sheet names each colour twice: first for light, then for dark. */
static void assert_shown(const char *name, wh_colour_t expected) {
    char key[40];
    unsigned light = 0, dark = 0;
    snprintf(key, sizeof key, "--%s: #", name);
    const char *at = strstr(style_sheet(), key);
    assert_non_null(at);
    assert_int_equal(sscanf(at + strlen(key), "%6x", &light), 1);
    at = strstr(at + 1, key);
    assert_non_null(at);
    assert_int_equal(sscanf(at + strlen(key), "%6x", &dark), 1);
    assert_null(strstr(at + 1, key));
    assert_int_equal(light, expected.light);
    assert_int_equal(dark, expected.dark);
}

static void the_pages_style_sheet_has_the_same_colours(void **state) {
    (void)state;
    static const char *const names[WH_INKS] = {[WH_INK_WALL] = "part-obstacle",
                                               [WH_INK_SHELL] = "part-shell",
                                               [WH_INK_LEDGE] = "part-ledge",
                                               [WH_INK_WAFER] = "wafer",
                                               [WH_INK_ARM] = "part-arm",
                                               [WH_INK_CHUCK] = "part-chuck",
                                               [WH_INK_BLADE] = "s0"};
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        assert_shown(names[ink], wh_ink_looks[ink].shown);
    }
    for (size_t i = 0; i < WH_INK_SERIES; ++i) {
        char name[8];
        snprintf(name, sizeof name, "s%zu", i);
        assert_shown(name, wh_ink_series[i]);
    }
    assert_null(strstr(style_sheet(), "--s6: "));
    assert_shown("edge", wh_ink_edge);
    assert_shown("stage", wh_ink_stage);
}

/* As IEC 61966-2-1 has it. */
static double linear_of(uint32_t part) {
    const double share = (double)(part & 0xffU) / 255;
    return share <= 0.04045 ? share / 12.92 : pow((share + 0.055) / 1.055, 2.4);
}

static void gltf_has_the_drawings_colours_in_linear_light(void **state) {
    (void)state;
    for (size_t ink = 0; ink < WH_INKS; ++ink) {
        const uint32_t drawn = wh_ink_looks[ink].drawn.light;
        assert_near(wh_ink_materials[ink].red, linear_of(drawn >> 16), 0.01);
        assert_near(wh_ink_materials[ink].green, linear_of(drawn >> 8), 0.01);
        assert_near(wh_ink_materials[ink].blue, linear_of(drawn), 0.01);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pages_style_sheet_has_the_same_colours),
        cmocka_unit_test(gltf_has_the_drawings_colours_in_linear_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
