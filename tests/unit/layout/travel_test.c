/* In words why a line ends: a SCARA's near stretched and folded. */
#include "support/layout.h"

#include "layout/travel.h"
#include "math/trig.h"

#define SCARA                                                                                                \
    "grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 } } }, "                          \
    "robot = { kind = 'SCARA', links = { 450, 450 }, forearm = { min = -179.9, max = 179.9 } }, "

static void assert_said(double forearm, double dx, const char *want) {
    const wh_layout_t *layout = read_sound(SCARA);
    const wh_real_t axes[WH_AXES] = {0, wh_rad_from_deg(forearm), 900, 0};
    const wh_vec3_t travel = {dx, 0, 0};
    char text[WH_TRAVEL_BYTES];
    wh_travel_say_line(layout, WH_NONE, axes, &travel, text);
    assert_string_equal(text, want);
}

static void a_scara_line_ends_before_stretched(void **state) {
    (void)state;
#define REACHES "forearm: the links reach, but near stretched or folded no joint follows a line; "
    assert_said(-0.4, -5,
                REACHES "a line begins 0.573 degrees or more from stretched, and it is at 0.4: MOVE it 0.173 "
                        "degrees away first");
    assert_said(-3, 0.305,
                REACHES "a line ends 0.573 degrees before stretched, and this one of 0.305 mm is there after "
                        "0.297 mm: end it before");
    assert_said(179.8, 1,
                REACHES
                "a line begins 0.573 degrees or more from folded, and it is at 0.2: MOVE it 0.373 degrees "
                "away first");
    assert_said(
        -3, 5,
        "forearm: no angle (expected a wrist 0 to 900 mm from the shoulder); a line ends 0.573 degrees "
        "before stretched, and this one of 5 mm is there after 0.297 mm: end it before");
    assert_said(-3, 0.29, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scara_line_ends_before_stretched),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
