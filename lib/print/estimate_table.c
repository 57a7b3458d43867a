#include <string.h>

#include "../math/trig.h"
#include "estimate_print.h"
#include "print_internal.h"

/* Lines set aside that are named; of more, how many there are. */
#define NAMED_LINES 20

static void say(const wh_printer_t *printer, const char *name, wh_status_t status, const char *reason) {
    const bool is_wrong = status != WH_OK;
    wh_style_print(printer->style, printer->out, is_wrong ? WH_INK_BAD : WH_INK_WARN, "%s",
                   is_wrong ? wh_style_glyph(printer->style, WH_GLYPH_CROSS) : "!");
    if (is_wrong) {
        wh_print_say(printer, " %s: error %d %s: %s; %s", name, (int)status, wh_status_name(status),
                     wh_record_error_text(status), reason);
    } else {
        wh_print_say(printer, " %s: not determined, for want of these: %s", name, reason);
    }
    fputc('\n', printer->out);
}

/* `what` is one, `many` are any other number. */
static void print_heading(const wh_printer_t *printer, const char *path, size_t count, const char *what,
                          const char *many) {
    wh_style_put(printer->out, path);
    fprintf(printer->out, ": %zu %s\n", count, count == 1 ? what : many);
}

static int finish(FILE *out) {
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}

/* Names a line that was set aside, the first with a text before it. Returns how many are named. */
static size_t name_line(const wh_printer_t *printer, const char *name, size_t line, size_t named) {
    if (named == NAMED_LINES) {
        return named;
    }
    if (named == 0) {
        fprintf(printer->out, "%s, set aside: lines ", name);
    }
    fprintf(printer->out, "%s%zu", named == 0 ? "" : ", ", line);
    return named + 1;
}

static void end_lines(const wh_printer_t *printer, size_t all, size_t named) {
    if (all > named) {
        fprintf(printer->out, " and %zu more", all - named);
    }
    fputs(named > 0 ? "\n" : "", printer->out);
}

/* ------------------------------------------------------------------------------------------------- frames */

static void print_frames(const wh_printer_t *printer, const wh_point_table_t *table) {
    static const char *const names[6] = {"x mm", "y mm", "z mm", "roll deg", "pitch deg", "yaw deg"};
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "station;value;estimate{4,6};sd{4,6}");
    for (size_t s = 0; s < table->count; ++s) {
        const wh_frame_estimate_t *frame = &table->stations[s].estimate;
        const wh_vec3_t *r = &frame->base_from_station.r;
        const double at[3] = {r->x, r->y, r->z};
        for (size_t i = 0; i < 6 && frame->status == WH_OK; ++i) {
            const bool turns = i >= 3;
            wh_grid_named_row(grid, table->stations[s].name);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", names[i]);
            wh_grid_number(grid, 2, WH_INK_PLAIN, turns ? wh_deg_from_rad(frame->rpy[i - 3]) : at[i]);
            wh_grid_number(grid, 3, WH_INK_PLAIN,
                           turns ? wh_deg_from_rad(frame->rpy_sd[i - 3]) : frame->at_sd[i]);
        }
    }
    wh_print_titled(printer, "Frames, in base", grid);
}

static void print_fits(const wh_printer_t *printer, const wh_point_table_t *table) {
    wh_grid_t *grid =
        wh_grid_new(printer->style, 1, "station;points{0};set aside{0};rms mm{4};largest mm{4};in line{0}");
    for (size_t s = 0; s < table->count; ++s) {
        const wh_station_points_t *station = &table->stations[s];
        wh_grid_named_row(grid, station->name);
        wh_grid_number(grid, 1, WH_INK_PLAIN, (double)station->count);
        if (station->estimate.status == WH_OK) {
            wh_grid_number(grid, 2, WH_INK_PLAIN, (double)station->estimate.set_aside);
            wh_grid_number(grid, 3, WH_INK_PLAIN, station->estimate.rms);
            wh_grid_number(grid, 4, WH_INK_PLAIN, station->estimate.largest);
            wh_grid_number(grid, 5, WH_INK_PLAIN, (double)station->lines[station->estimate.largest_index]);
        }
    }
    wh_print_titled(printer, "Residuals", grid);
}

static void print_points(const wh_printer_t *printer, const wh_point_table_t *table) {
    wh_grid_t *grid = wh_grid_new(printer->style, 2, "line{0};station;dx mm{4};dy mm{4};dz mm{4}");
    for (size_t s = 0; s < table->count; ++s) {
        const wh_station_points_t *station = &table->stations[s];
        for (size_t i = 0; i < station->count && station->estimate.status == WH_OK; ++i) {
            const wh_vec3_t off = wh_frame_residual(&station->estimate, &station->points[i]);
            wh_grid_row(grid);
            wh_grid_number(grid, 0, WH_INK_PLAIN, (double)station->lines[i]);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", station->name);
            wh_grid_numbers(grid, 2, (const double[]){off.x, off.y, off.z}, 3);
        }
    }
    wh_print_titled(printer, "Points touched, less where the frame has them", grid);
}

/* Which lines were set aside. */
static void print_points_aside(const wh_printer_t *printer, const wh_station_points_t *station) {
    size_t named = 0;
    for (size_t i = 0; i < station->count; ++i) {
        if (station->points[i].is_set_aside) {
            named = name_line(printer, station->name, station->lines[i], named);
        }
    }
    end_lines(printer, station->estimate.set_aside, named);
}

static void print_wrong_stations(const wh_printer_t *printer, const wh_point_table_t *table) {
    const char *before = "\n";
    for (size_t s = 0; s < table->count; ++s) {
        const wh_frame_estimate_t *frame = &table->stations[s].estimate;
        if (frame->status == WH_OK && frame->set_aside > 0) {
            fputs(before, printer->out);
            print_points_aside(printer, &table->stations[s]);
            before = "";
        }
        if (frame->status != WH_OK) {
            fputs(before, printer->out);
            say(printer, table->stations[s].name, frame->status, frame->reason);
            before = "";
        }
    }
}

int wh_frames_print_table(const wh_point_table_t *table, FILE *out, const wh_style_t *style) {
    const wh_printer_t printer = {NULL, style, out};
    size_t points = 0;
    for (size_t s = 0; s < table->count; ++s) {
        points += table->stations[s].count;
    }
    print_heading(&printer, table->csv.path, points, "point", "points");
    print_frames(&printer, table);
    print_fits(&printer, table);
    print_points(&printer, table);
    print_wrong_stations(&printer, table);
    wh_print_title(&printer, "For a layout");
    wh_frames_print_lua(table, out);
    return finish(out);
}

/* ------------------------------------------------------------------------------------------------- limits */

static void add_limit(wh_grid_t *grid, size_t axis, int k, const wh_limits_estimate_t *limits) {
    const wh_estimate_value_t *value = &limits->values[k];
    wh_grid_named_row(grid, wh_table_axis_name(axis));
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s %s", wh_limit_name(k),
                 wh_limit_unit(k, wh_table_axis_turns(axis)));
    if (value->is_determined) {
        wh_grid_numbers(grid, 2, (const double[]){value->value, value->sd}, 2);
    } else if (limits->at_least[k] > 0) {
        wh_grid_number(grid, 4, WH_INK_WARN, limits->at_least[k]);
    }
}

static void print_limits(const wh_printer_t *printer, const wh_move_table_t *table) {
    wh_grid_t *grid = wh_grid_new(printer->style, 2, "axis;limit;estimate{3};sd{3};at least{3}");
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        const wh_limits_estimate_t *limits = &table->axes[axis].estimate;
        const bool is_fitted = table->axes[axis].count > 0 && limits->status == WH_OK;
        for (int k = 0; k < WH_LIMIT_PARAMETERS && is_fitted; ++k) {
            if (k < WH_LIMIT_DELAY || limits->values[k].is_determined) {
                add_limit(grid, axis, k, limits);
            }
        }
    }
    wh_print_titled(printer, "Limits", grid);
}

static void print_moves(const wh_printer_t *printer, const wh_move_table_t *table) {
    wh_grid_t *grid =
        wh_grid_new(printer->style, 1, "axis;moves{0};set aside{0};shortest{0,6};longest{0,6};rms ms{3}");
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        const wh_axis_moves_t *moves = &table->axes[axis];
        if (moves->count > 0) {
            wh_grid_named_row(grid, wh_table_axis_name(axis));
            wh_grid_number(grid, 1, WH_INK_PLAIN, (double)moves->count);
            wh_grid_number(grid, 2, WH_INK_PLAIN, (double)moves->estimate.set_aside);
        }
        if (moves->estimate.longest > 0) {
            wh_grid_numbers(grid, 3,
                            (const double[]){moves->estimate.shortest, moves->estimate.longest,
                                             moves->estimate.rms * 1e3},
                            3);
        }
    }
    wh_print_titled(printer, "Moves", grid);
}

/* Which lines were set aside. */
static void print_aside(const wh_printer_t *printer, const wh_axis_moves_t *moves, const char *name) {
    size_t named = 0;
    for (size_t i = 0; i < moves->count; ++i) {
        if (moves->moves[i].is_set_aside) {
            named = name_line(printer, name, moves->lines[i], named);
        }
    }
    end_lines(printer, moves->estimate.set_aside, named);
}

static void print_remarks(const wh_printer_t *printer, const wh_move_table_t *table) {
    const char *before = "\n";
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        const wh_limits_estimate_t *limits = &table->axes[axis].estimate;
        const bool is_simulated = wh_axis_moves_look_simulated(&table->axes[axis]);
        if (limits->set_aside > 0 || limits->reason[0] != '\0' || is_simulated) {
            fputs(before, printer->out);
            before = "";
        }
        print_aside(printer, &table->axes[axis], wh_table_axis_name(axis));
        if (is_simulated) {
            fprintf(printer->out,
                    "%s: its times are those of one profile, rounded to 1 ms: they look simulated\n",
                    wh_table_axis_name(axis));
        }
        if (limits->reason[0] != '\0') {
            say(printer, wh_table_axis_name(axis), limits->status, limits->reason);
        }
    }
}

int wh_limits_print_table(const wh_move_table_t *table, FILE *out, const wh_style_t *style) {
    const wh_printer_t printer = {NULL, style, out};
    size_t count = 0;
    for (size_t axis = 0; axis < WH_TABLE_AXES; ++axis) {
        count += table->axes[axis].count;
    }
    print_heading(&printer, table->csv.path, count, "move", "moves");
    print_limits(&printer, table);
    print_moves(&printer, table);
    print_remarks(&printer, table);
    wh_print_title(&printer, "For a layout");
    wh_limits_print_lua(table, out);
    return finish(out);
}

/* ----------------------------------------------------------------------------------------------- geometry */

static void print_numbers(const wh_printer_t *printer, const wh_geometry_estimate_t *found) {
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "number;estimate{4,6};sd{4,6}");
    for (int k = 0; k < (found->has_scales ? WH_GEOMETRY_PARAMETERS : WH_GEOMETRY_SCALE); ++k) {
        const wh_estimate_value_t *value = &found->values[k];
        double unit;
        char name[40];
        const char *of = wh_geometry_unit(k, &unit);
        (void)snprintf(name, sizeof name, "%s%s%s", wh_geometry_name(k), of[0] != '\0' ? " " : "", of);
        wh_grid_named_row(grid, name);
        if (value->is_determined) {
            wh_grid_numbers(grid, 1, (const double[]){value->value * unit, value->sd * unit}, 2);
        } else {
            wh_grid_text(grid, 1, WH_INK_WARN, "not determined");
        }
    }
    wh_print_titled(printer, "Robot, in the touched points' frame", grid);
}

static void print_fit(const wh_printer_t *printer, const wh_touch_table_t *table) {
    const wh_geometry_estimate_t *found = &table->estimate;
    wh_grid_t *grid =
        wh_grid_new(printer->style, 0,
                    "touches{0};set aside{0};rms mm{4};largest mm{4};in line{0};headings{0};rms deg{4}");
    wh_grid_row(grid);
    wh_grid_numbers(grid, 0,
                    (const double[]){(double)found->used, (double)found->set_aside, found->rms,
                                     found->largest, (double)table->lines[found->largest_index],
                                     (double)found->headings},
                    6);
    if (found->headings > 0) {
        wh_grid_number(grid, 6, WH_INK_PLAIN, wh_deg_from_rad(found->heading_rms));
    }
    wh_print_titled(printer, "Residuals", grid);
}

static void print_touches(const wh_printer_t *printer, const wh_touch_table_t *table) {
    const wh_geometry_estimate_t *found = &table->estimate;
    wh_grid_t *grid =
        wh_grid_new(printer->style, 1,
                    "line{0};dx mm{4};dy mm{4};dz mm{4};x in base mm{3};y in base mm{3};z in base mm{3}");
    for (size_t i = 0; i < table->count; ++i) {
        const wh_vec3_t off = wh_geometry_residual(found, &table->touches[i]);
        wh_grid_row(grid);
        wh_grid_number(grid, 0, WH_INK_PLAIN, (double)table->lines[i]);
        wh_grid_numbers(grid, 1, (const double[]){off.x, off.y, off.z}, 3);
        if (found->is_base_determined) {
            const wh_vec3_t there = wh_geometry_in_base(found, &table->touches[i].touched);
            wh_grid_numbers(grid, 4, (const double[]){there.x, there.y, there.z}, 3);
        }
    }
    wh_print_titled(printer, "Points touched, less where the robot has them; and where a layout has them",
                    grid);
}

static void print_touches_aside(const wh_printer_t *printer, const wh_touch_table_t *table) {
    const wh_geometry_estimate_t *found = &table->estimate;
    size_t touches = 0;
    size_t headings = 0;
    if (found->set_aside > 0 || found->headings_aside > 0 || found->reason[0] != '\0') {
        fputc('\n', printer->out);
    }
    for (size_t i = 0; i < table->count; ++i) {
        if (table->touches[i].is_set_aside) {
            touches = name_line(printer, "robot", table->lines[i], touches);
        }
    }
    end_lines(printer, found->set_aside, touches);
    for (size_t i = 0; i < table->count; ++i) {
        if (table->touches[i].is_heading_set_aside) {
            headings = name_line(printer, "headings", table->lines[i], headings);
        }
    }
    end_lines(printer, found->headings_aside, headings);
}

int wh_geometry_print_table(const wh_touch_table_t *table, FILE *out, const wh_style_t *style) {
    const wh_printer_t printer = {NULL, style, out};
    const wh_geometry_estimate_t *found = &table->estimate;
    print_heading(&printer, table->csv.path, table->count, "touch", "touches");
    if (found->status == WH_OK) {
        print_numbers(&printer, found);
        print_fit(&printer, table);
        print_touches(&printer, table);
    }
    print_touches_aside(&printer, table);
    if (found->reason[0] != '\0') {
        say(&printer, "robot", found->status, found->reason);
    }
    wh_print_title(&printer, "For a layout");
    wh_geometry_print_lua(table, out);
    return finish(out);
}
