/* A plot's script and data: word for word, and curves split into lines that stay within their tolerance. */
#include "report/gnuplot.h"

#include "support/support.h"

static wh_plot_t plot;
static char *script, *data;
static size_t script_size, data_size;

static int set_up(void **state) {
    (void)state;
    memset(&plot, 0, sizeof plot);
    strcpy(plot.name, "axes");
    plot.script = open_memstream(&script, &script_size);
    plot.data = open_memstream(&data, &data_size);
    return plot.script && plot.data ? 0 : -1;
}

static void finish(void) {
    assert_int_equal(fclose(plot.script), 0);
    assert_int_equal(fclose(plot.data), 0);
}

static int tear_down(void **state) {
    (void)state;
    free(script);
    free(data);
    return 0;
}

static void draw_two_panels(void) {
    const wh_plot_frame_t frame = {
        .panels = 2, .panel_height = 100, .left = 60, .above = 12, .keys_wrap = true, .limits = true};
    wh_plot_begin(&plot, &frame, "two\nlines \\", 1.5, 4);
    wh_plot_panel(&plot, "it's 50 %");
    wh_plot_limit_label(&plot, '<', 0.5, "mm");
    wh_plot_limit_label(&plot, '>', 0.99, "");
    fputs("plot 1", plot.script);
    wh_plot_limit_curve(&plot, 0.5);
    fputs("\n", plot.script);
    wh_plot_panel(&plot, "second");
    wh_plot_fitting_label(&plot, 2, 3, "W\xc3\xa4 '1'");
    fputs("\n", plot.script);
}

static const char two_panels[] =
    "# two lines /\n"
    "# To draw it again: gnuplot axes.gp; in one column: gnuplot -e width_mm=85 axes.gp\n"
    "if (!exists('width_mm')) width_mm = 170\n"
    "reset\n"
    "W = width_mm / 25.4 * 96\n"
    "top = width_mm < 120 ? 28 : 0\n"
    "H = 262.0 + top\n"
    "set encoding utf8\n"
    "set terminal svg size W, H fixed noenhanced background rgb '#ffffff' font 'sans-serif,10' name 'axes'\n"
    "set output 'axes.svg'\n"
    "set linetype 1 lc rgb '#000000' lw 1.1 dt 1 pt 4 ps 0.45\n"
    "set linetype 2 lc rgb '#1f4e8c' lw 1.1 dt (10,4) pt 6 ps 0.45\n"
    "set linetype 3 lc rgb '#9c1c1c' lw 1.1 dt (3,3) pt 8 ps 0.45\n"
    "set linetype 4 lc rgb '#2b6b2b' lw 1.1 dt (12,3,3,3) pt 10 ps 0.45\n"
    "set linetype 5 lc rgb '#5c3a86' lw 1.1 dt (6,3,2,3,2,3) pt 12 ps 0.45\n"
    "set linetype 6 lc rgb '#8a6d00' lw 1.1 dt (2,5) pt 2 ps 0.45\n"
    "set linetype cycle 6\n"
    "set style line 9 lc rgb '#000000' lw 0.8 dt (5,4)\n"
    "set border 3 lw 0.7\n"
    "set tics nomirror scale 0.5\n"
    "set grid xtics lc rgb '#d0d0d0' lw 0.5 dt 1\n"
    "set key at graph 1, graph 1.03 bottom right horizontal samplen 2\n"
    "set style fill solid border lc rgb '#000000'\n"
    "set lmargin at screen 60 / W\n"
    "set rmargin at screen 1 - 58 / W\n"
    "if (!exists('from_s')) from_s = 1.5\n"
    "if (!exists('to_s')) to_s = 4\n"
    "set xrange [from_s:to_s]\n"
    "# Whether so many letters fit between two times.\n"
    "fits(letters, a, b) = a >= from_s && b <= to_s && \\\n"
    "    letters * 6.4 + 4 < 1.0 * (b - a) / (to_s - from_s) * (W - 118)\n"
    "set multiplot\n"
    "\n"
    "set tmargin at screen 1 - (top + 12) / H\n"
    "set bmargin at screen 1 - (top + 112) / H\n"
    "unset label\n"
    "unset object\n"
    "unset logscale y\n"
    "set yrange [*:*]\n"
    "set ytics autofreq\n"
    "set format x ''\n"
    "set label 1 'it''s 50 %' at screen 9 / W, graph 0.5 center rotate by 90\n"
    "set label '< 0.5 mm' at graph 1, first 0.5 left offset 0.5, 0\n"
    "set label '> 0.99' at graph 1, first 0.99 left offset 0.5, 0\n"
    "plot 1, \\\n"
    "  0.5 with lines ls 9 notitle\n"
    "\n"
    "set tmargin at screen 1 - (top + 124) / H\n"
    "set bmargin at screen 1 - (top + 224) / H\n"
    "unset label\n"
    "unset object\n"
    "unset logscale y\n"
    "set yrange [*:*]\n"
    "set ytics autofreq\n"
    "set format x '%g'\n"
    "set label 1 'second' at screen 9 / W, graph 0.5 center rotate by 90\n"
    "set label 2 't (s)' at graph 0.5, screen 8 / H center\n"
    "if (fits(6, 2, 3)) set label 'Wä ''1''' at 2.5\n";

static void the_script_of_two_panels(void **state) {
    (void)state;
    draw_two_panels();
    finish();
    assert_string_equal(script, two_panels);
}

/* One panel without limits, and no time. */
static void a_plot_that_is_not_over_time(void **state) {
    (void)state;
    const wh_plot_frame_t frame = {.panels = 1, .panel_height = 200, .left = 50, .above = 6};
    wh_plot_begin(&plot, &frame, "scans", 0, 0);
    wh_plot_panel(&plot, "mm");
    wh_plot_axis(&plot, "degrees");
    finish();
    assert_null(strstr(script, "from_s"));
    assert_non_null(strstr(script, "\ntop = width_mm < 120 ? 0 : 0\nH = 244.0 + top\n"));
    assert_non_null(
        strstr(script, "\nset lmargin at screen 50 / W\nset rmargin at screen 1 - 10 / W\nset multiplot\n"));
    assert_non_null(strstr(
        script, "\nset tmargin at screen 1 - (top + 6) / H\nset bmargin at screen 1 - (top + 206) / H\n"));
    assert_non_null(strstr(script, "\nset label 2 'degrees' at graph 0.5, screen 8 / H center\n"));
}

static void expect_quoted(void put(FILE *out, const char *text), const char *text, const char *wanted) {
    char *written = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&written, &size);
    put(out, text);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(written, wanted);
    free(written);
}

static void any_text_is_taken_as_it_is(void **state) {
    (void)state;
    finish();
    expect_quoted(wh_plot_put_text, "", "''");
    expect_quoted(wh_plot_put_text, "it's 5 %\n\x7f", "'it''s 5 %  '");
    expect_quoted(wh_plot_put_text, "\xc2\xb5m \xff", "'\xc2\xb5m ?'");
    expect_quoted(wh_plot_put_tic, "it's 5 %", "'it''s 5 %%'");
}

static void blocks_have_rows_and_gaps(void **state) {
    (void)state;
    const double values[] = {0.25, -1e-7, 123456789.5};
    wh_plot_block(&plot, "A\\B", "t (s), mm");
    wh_plot_gap(&plot); /* before the first row there is none */
    wh_plot_row(&plot, 0.001, values, 2);
    wh_plot_gap(&plot);
    wh_plot_gap(&plot);
    wh_plot_row(&plot, 2, values + 1, 2);
    assert_int_equal(wh_plot_end_block(&plot), 0);
    wh_plot_block(&plot, "empty", "nothing");
    assert_true(wh_plot_end_block(&plot) == SIZE_MAX);
    wh_plot_block(&plot, "C", "t (s)");
    wh_plot_row(&plot, 3, values, 0);
    wh_plot_gap(&plot); /* nor behind the last one */
    assert_int_equal(wh_plot_end_block(&plot), 1);
    finish();
    assert_string_equal(data, "# A/B\n# t (s), mm\n0.001 0.25 -1e-07\n\n2 -1e-07 123456790\n\n\n"
                              "# empty\n# nothing\n# C\n# t (s)\n3\n\n\n");
}

/* ------------------------------------------------------------------------------------------------- curves */

enum { SLICES = 3000 };

static double signal_at(int slice) {
    return 100 * sin(slice / 300.0);
}

/* From slice 1 on, without the slices 1001 to 1500. */
static void make_curve(wh_path_t *curve, double tolerance) {
    wh_path_open(curve, tolerance, 100000);
    for (int slice = 1; slice <= SLICES; ++slice) {
        if (slice == 1001) {
            wh_path_break(curve);
        }
        if (slice <= 1000 || slice > 1500) {
            wh_path_add(curve, slice, signal_at(slice));
        }
    }
    wh_path_finish(curve);
}

static void lines_stay_within_the_tolerance(void **state) {
    (void)state;
    wh_path_t curve;
    make_curve(&curve, 0.05);
    const wh_plot_curves_t of = {{&curve}, 1, 10, false, NULL};
    wh_plot_block(&plot, "sine", "t");
    assert_int_equal(wh_plot_curves(&plot, &of, 0.001), 0);
    finish();
    double t = 0, value = 0, before_t = -1, before = 0;
    size_t rows = 0, gaps = 0;
    for (char *line = strtok(data, "\n"); line; line = strtok(NULL, "\n")) {
        if (line[0] == '#') {
            continue;
        }
        assert_int_equal(sscanf(line, "%lf %lf", &t, &value), 2);
        gaps += before_t > 0 && t - before_t > 0.4 ? 1 : 0;
        for (double at = before_t; rows > 0 && t - before_t < 0.4 && at < t; at += 0.001) {
            const double line_value = before + (at - before_t) / (t - before_t) * (value - before);
            assert_near(line_value * 10, 100 * sin(at / 0.3), 0.101);
        }
        before_t = t;
        before = value;
        ++rows;
    }
    assert_near(before_t, SLICES * 0.001, 1e-9);
    assert_in_range(rows, 50, 500);
    assert_int_equal(gaps, 1);
    wh_path_close(&curve);
}

/* Slopes per second; and the number of the wafer, with a gap at each change. */
static void slopes_and_wafers(void **state) {
    (void)state;
    wh_path_t curve;
    wh_step_t changes[] = {{10, 0}, {20, 3}};
    const wh_steps_t wafers = {.steps = changes, .count = 2};
    wh_path_open(&curve, 1e-9, 1000);
    for (int slice = 1; slice <= 40; ++slice) {
        wh_path_add(&curve, slice, 2.0 * slice);
        if (slice == 5 || slice == 10 || slice == 15 || slice == 20) {
            wh_path_force(&curve);
        }
    }
    wh_path_finish(&curve);
    const wh_plot_curves_t of = {{&curve, &curve}, 2, 4, true, &wafers};
    wh_plot_block(&plot, "slopes", "t");
    assert_int_equal(wh_plot_curves(&plot, &of, 0.5), 0);
    finish();
    assert_string_equal(
        data, "# slopes\n# t\n0.5 1 1 -1\n2.5 1 1 -1\n\n5 1 1 0\n7.5 1 1 0\n\n10 1 1 3\n20 1 1 3\n\n\n");
    wh_path_close(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_script_of_two_panels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_plot_that_is_not_over_time, set_up, tear_down),
        cmocka_unit_test_setup_teardown(any_text_is_taken_as_it_is, set_up, tear_down),
        cmocka_unit_test_setup_teardown(blocks_have_rows_and_gaps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lines_stay_within_the_tolerance, set_up, tear_down),
        cmocka_unit_test_setup_teardown(slopes_and_wafers, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
