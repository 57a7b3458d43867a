/* A sweep's drawing, read back: the parameter and the figure give the place of each run, with its
 * own colour; ticks are round numbers at their places. */
#include "report/sweep_plot.h"

#include "support/support.h"

enum { FIRST = 5, OTHERS = 3, POINTS = FIRST * OTHERS };

/* The picture's frame: the ticks of y and the discs must agree with it. */
enum { LEFT = 90, RIGHT = 736, TOP = 56, PANEL = 170, PITCH = 196, LANE = 16 };

static wh_script_sweep_t sweep;
static wh_sweep_axis_t axes[3];
static wh_sweep_point_t points[POINTS];
static char names[3][8] = {"speed", "a<b", "c"};
static char *picture;

/* speed = 200, 150, ... 0 by a<b = 1, 2, 3 and c = 7. */
static int set_up(void **state) {
    (void)state;
    axes[0] = (wh_sweep_axis_t){names[0], 200, -50, 0, FIRST};
    axes[1] = (wh_sweep_axis_t){names[1], 1, 1, 3, OTHERS};
    axes[2] = (wh_sweep_axis_t){names[2], 7, 1, 7, 1};
    for (size_t i = 0; i < POINTS; ++i) {
        points[i] = (wh_sweep_point_t){.verdict = WH_SWEEP_OK,
                                       .simulated_s = wh_test_uniform(10, 30),
                                       .wafers_per_hour = (double)INFINITY,
                                       .projz = wh_test_uniform(-0.1, 0.4),
                                       .projxy = (double)INFINITY,
                                       .gap = (double)INFINITY};
    }
    sweep = (wh_script_sweep_t){
        .run.script = "a&b.lua", .axes = axes, .axis_count = 3, .points = points, .point_count = POINTS};
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    free(picture);
    picture = NULL;
    return 0;
}

static void draw(void) {
    size_t size = 0;
    FILE *out = open_memstream(&picture, &size);
    wh_sweep_plot(&sweep, out);
    assert_int_equal(fclose(out), 0);
}

static size_t count(const char *what) {
    size_t found = 0;
    for (const char *at = strstr(picture, what); at; at = strstr(at + 1, what)) {
        ++found;
    }
    return found;
}

static double x_of(size_t point) {
    const double room = 0.02 * 200;
    const double value = 200 - 50.0 * (double)(point / OTHERS);
    return LEFT + (value + room) / (200 + 2 * room) * (RIGHT - LEFT);
}

static double figure_of(size_t point, size_t panel) {
    return panel == 0 ? points[point].simulated_s : points[point].projz;
}

/* The least and greatest of all figures, and 5 % beyond them. */
static void range_of(size_t panel, double *low, double *high) {
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (size_t i = 0; i < POINTS; ++i) {
        *low = fmin(*low, figure_of(i, panel));
        *high = fmax(*high, figure_of(i, panel));
    }
    const double room = fmax(0.05 * (*high - *low), 1e-3 + 1e-3 * fabs(*high));
    *low -= room;
    *high += room;
}

static double y_of(size_t point, size_t panel) {
    double low, high;
    range_of(panel, &low, &high);
    const double top = TOP + PITCH * (double)panel;
    return top + PANEL - (figure_of(point, panel) - low) / (high - low) * PANEL;
}

static const char *const colours[OTHERS] = {"#0b5fa5", "#b84a00", "#00745a"};

static void expect_disc(size_t point, double y) {
    char disc[120];
    (void)snprintf(disc, sizeof disc, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>", x_of(point), y,
                   colours[point % OTHERS]);
    if (!strstr(picture, disc)) {
        print_error("not found: %s\nin:\n%s", disc, picture);
        fail();
    }
}

static void each_run_stands_at_its_figures(void **state) {
    (void)state;
    draw();
    for (size_t i = 0; i < POINTS; ++i) {
        expect_disc(i, y_of(i, 0));
        expect_disc(i, y_of(i, 1));
        expect_disc(i, TOP + 2 * PITCH + LANE * ((double)(i % OTHERS) + 0.5));
    }
    assert_int_equal(count("<circle"), 3 * POINTS);
    assert_int_equal(count("class=\"bad\" d"), 0);
}

static void curves_join_what_differs_in_the_first_parameter_alone(void **state) {
    (void)state;
    draw();
    const char *at = picture;
    for (size_t panel = 0; panel < 2; ++panel) {
        for (size_t series = 0; series < OTHERS; ++series) {
            char curve[400];
            int length =
                snprintf(curve, sizeof curve, "<path class=\"curve\" stroke=\"%s\" d=\"", colours[series]);
            for (size_t i = series; i < POINTS; i += OTHERS) {
                length += snprintf(curve + length, sizeof curve - (size_t)length, "%c%.1f %.1f",
                                   i == series ? 'M' : 'L', x_of(i), y_of(i, panel));
            }
            (void)snprintf(curve + length, sizeof curve - (size_t)length, "\"/>\n");
            at = strstr(at, curve);
            assert_non_null(at);
        }
    }
    assert_int_equal(count("class=\"curve\" stroke"), 2 * OTHERS);
}

/* A run without the figure leaves a hole, a failed one a cross. */
static void what_is_missing_or_failed_is_seen(void **state) {
    (void)state;
    char cross[80];
    points[2 * OTHERS].projz = (double)INFINITY;
    points[OTHERS + 1].verdict = WH_SWEEP_FAILED;
    draw();
    assert_int_equal(count("<circle"), 3 * POINTS - 4);
    assert_int_equal(count("class=\"bad\" d"), 3);
    (void)snprintf(cross, sizeof cross, "<path class=\"bad\" d=\"M%.1f %.1fl8 8m0 -8l-8 8\"/>",
                   x_of(OTHERS + 1) - 4, y_of(OTHERS + 1, 0) - 4);
    assert_non_null(strstr(picture, cross));
    assert_non_null(strstr(picture, ".bad{stroke:#b3121f;"));
    const char *holed = strstr(strstr(picture, "dr_proj_z"), "class=\"curve\"");
    size_t begun = 0;
    for (const char *end = strchr(holed, '>'); holed < end; ++holed) {
        begun += *holed == 'M' ? 1 : 0;
    }
    assert_int_equal(begun, 2);
}

/* Ticks of y stand at multiples of 1, 2 or 5 times a power of ten. There are two to nine, each at
 * its value's place. */
static void ticks_are_round_and_in_place(void **state) {
    (void)state;
    draw();
    for (size_t panel = 0; panel < 2; ++panel) {
        double low, high, before = 0;
        size_t ticks = 0;
        range_of(panel, &low, &high);
        const char *end = panel == 0 ? strstr(picture, "dr_proj_z") : strstr(picture, "ok, or failed");
        const char *at = panel == 0 ? picture : strstr(picture, "dr_proj_z");
        for (at = strstr(at, "<path class=\"grid\""); at && at < end;
             at = strstr(at + 1, "<path class=\"grid\"")) {
            double y = 0, text_y = 0, value = 0;
            assert_int_equal(
                sscanf(
                    at,
                    "<path class=\"grid\" d=\"M90 %lfH736\"/><text class=\"y\" x=\"82\" y=\"%lf\">%lf</text>",
                    &y, &text_y, &value),
                3);
            assert_true(value >= low && value <= high);
            assert_near(y, TOP + PITCH * (double)panel + PANEL * (high - value) / (high - low), 0.051);
            assert_near(text_y, y + 4, 0.101);
            if (ticks++ > 0) {
                const double step = value - before, power = pow(10, floor(log10(step) + 1e-9));
                assert_true(fabs(step / power - 1) < 1e-6 || fabs(step / power - 2) < 1e-6 ||
                            fabs(step / power - 5) < 1e-6);
                assert_near(value / step, floor(value / step + 0.5), 1e-6);
            }
            before = value;
        }
        assert_in_range(ticks, 3, 9);
    }
}

static void the_parameter_has_its_own_ticks(void **state) {
    (void)state;
    draw();
    assert_int_equal(count("<text class=\"x\""), 6); /* 0, 50, ... 200, and its name */
    for (int value = 0; value <= 200; value += 50) {
        char tick[160];
        const double x = LEFT + (value + 4) / 208.0 * (RIGHT - LEFT), top = TOP + 2 * PITCH;
        (void)snprintf(tick, sizeof tick,
                       "d=\"M%.1f %.1fV%.1f\"/><text class=\"x\" x=\"%.1f\" y=\"%.1f\">%d</text>", x, top,
                       top + OTHERS * LANE, x, top + OTHERS * LANE + 16, value);
        assert_non_null(strstr(picture, tick));
    }
    assert_non_null(strstr(picture, "<text class=\"x\" x=\"413\" y=\"534.0\">speed</text>\n</svg>\n"));
}

static void combinations_are_named_beside_their_lanes(void **state) {
    (void)state;
    draw();
    assert_non_null(strstr(picture, "width=\"760\" height=\"550\" viewBox=\"0 0 760 550\""));
    assert_non_null(strstr(picture, "y=\"22\">a&amp;b.lua</text>"));
    assert_non_null(strstr(
        picture, "<text class=\"y\" x=\"82\" y=\"460.0\" style=\"fill:#0b5fa5\">a&lt;b=1, c=7</text>"));
    assert_non_null(strstr(
        picture, "<text class=\"y\" x=\"82\" y=\"492.0\" style=\"fill:#00745a\">a&lt;b=3, c=7</text>"));
    assert_non_null(strstr(picture, "<text class=\"title\" x=\"90\" y=\"50.0\">simulated time, s</text>\n"));
    assert_non_null(
        strstr(picture, "<text class=\"title\" x=\"90\" y=\"246.0\">largest |dr_proj_z|, mm</text>\n"));
    assert_int_equal(count("class=\"frame\" x"), 2);
}

/* With one value, or with equal figures, both axes have some range. Nothing is divided by 0. */
static void a_single_run_has_room(void **state) {
    (void)state;
    axes[0].count = sweep.point_count = sweep.axis_count = 1;
    points[0].simulated_s = 12;
    points[0].projz = 0;
    points[0].verdict = WH_SWEEP_OK;
    draw();
    assert_null(strstr(picture, "nan"));
    assert_int_equal(count("<circle cx=\"413.0\" cy=\"141.0\" r=\"3\" fill=\"#0b5fa5\"/>"), 1);
    assert_int_equal(count("<circle cx=\"413.0\" cy=\"337.0\""), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_run_stands_at_its_figures, set_up, tear_down),
        cmocka_unit_test_setup_teardown(curves_join_what_differs_in_the_first_parameter_alone, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(what_is_missing_or_failed_is_seen, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ticks_are_round_and_in_place, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_parameter_has_its_own_ticks, set_up, tear_down),
        cmocka_unit_test_setup_teardown(combinations_are_named_beside_their_lanes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_single_run_has_room, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
