#include <math.h>
#include <string.h>

#include "../math/trig.h"
#include "estimate_print.h"

const char *wh_limit_name(int limit) {
    static const char *const names[WH_LIMIT_PARAMETERS] = {"speed", "acceleration", "jerk", "delay"};
    return names[limit];
}

const char *wh_limit_unit(int limit, bool turns) {
    static const char *const units[2][WH_LIMIT_PARAMETERS] = {{"mm/s", "mm/s^2", "mm/s^3", "s"},
                                                              {"deg/s", "deg/s^2", "deg/s^3", "s"}};
    return units[turns][limit];
}

/* A value with two digits of its standard deviation. */
static void put_number(FILE *out, double value, double sd) {
    const double digits = sd > 0 ? 1 - floor(log10(sd)) : 9;
    const int decimals = digits > 9 ? 9 : (int)fmax(digits, 0);
    const double unit = pow(10, -decimals);
    fprintf(out, "%.*f", decimals, fabs(value) < unit / 2 ? 0 : value);
}

static void put_list(FILE *out, const double values[3], const double sds[3]) {
    fputs("{ ", out);
    for (int i = 0; i < 3; ++i) {
        fputs(i > 0 ? ", " : "", out);
        put_number(out, values[i], sds[i]);
    }
    fputs(" }", out);
}

/* ------------------------------------------------------------------------------------------------- frames */

/* True for a text that Lua takes as a field's name without quotes. Quotes around a word of Lua do no harm. */
static bool is_plain(const char *name) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
    static const char *const words[] = {
        "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
        "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while"};
    bool is_word = false;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        is_word = is_word || strcmp(name, words[i]) == 0;
    }
    const size_t begin = strspn(name, letters) > 0 ? 1 : 0;
    return !is_word && begin == 1 &&
           name[strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_0123456789")] == '\0';
}

static void put_key(FILE *out, const char *name) {
    if (is_plain(name)) {
        fputs(name, out);
        return;
    }
    fputs("[\"", out);
    for (; *name != '\0'; ++name) {
        fputs(*name == '"' || *name == '\\' ? "\\" : "", out);
        fputc(*name, out);
    }
    fputs("\"]", out);
}

void wh_frames_print_lua(const wh_point_table_t *table, FILE *out) {
    fputs("stations = {\n", out);
    for (size_t s = 0; s < table->count; ++s) {
        const wh_frame_estimate_t *frame = &table->stations[s].estimate;
        const wh_vec3_t *r = &frame->base_from_station.r;
        double deg[3];
        double sd_deg[3];
        for (int i = 0; i < 3; ++i) {
            deg[i] = wh_deg_from_rad(frame->rpy[i]);
            sd_deg[i] = wh_deg_from_rad(frame->rpy_sd[i]);
        }
        fputs(frame->status == WH_OK ? "  " : "  -- ", out);
        put_key(out, table->stations[s].name);
        if (frame->status == WH_OK) {
            fputs(" = { at = ", out);
            put_list(out, (const double[]){r->x, r->y, r->z}, frame->at_sd);
            fputs(", rpy = ", out);
            put_list(out, deg, sd_deg);
            fputs(" },\n", out);
        } else {
            fputs(" is not determined\n", out);
        }
    }
    fputs("},\n", out);
}

/* ------------------------------------------------------------------------------------------------- limits */

static void put_axis(const wh_move_table_t *table, size_t axis, FILE *out) {
    const wh_limits_estimate_t *limits = &table->axes[axis].estimate;
    const char *between = "";
    if (limits->status != WH_OK) {
        fprintf(out, "-- %s is not determined\n", wh_table_axis_name(axis));
        return;
    }
    fprintf(out, "%s = { ", wh_table_axis_name(axis));
    for (int k = WH_LIMIT_SPEED; k <= WH_LIMIT_JERK; ++k) {
        if (limits->values[k].is_determined) {
            fprintf(out, "%s%s = ", between, wh_limit_name(k));
            put_number(out, limits->values[k].value, limits->values[k].sd);
            between = ", ";
        }
    }
    fputs(" },", out);
    between = " -- ";
    for (int k = WH_LIMIT_SPEED; k <= WH_LIMIT_JERK; ++k) {
        if (!limits->values[k].is_determined) {
            fprintf(out, "%s%s is not determined", between, wh_limit_name(k));
            between = ", ";
        }
    }
    fputc('\n', out);
}

void wh_limits_print_lua(const wh_move_table_t *table, FILE *out) {
    bool has_robot = false;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        if (table->axes[axis].count > 0) {
            fputs(has_robot ? "  " : "robot = {\n  ", out);
            put_axis(table, axis, out);
            has_robot = true;
        }
    }
    fputs(has_robot ? "},\n" : "", out);
    if (table->axes[WH_ROBOT_AXES].count > 0) {
        put_axis(table, WH_ROBOT_AXES, out);
    }
}

/* ----------------------------------------------------------------------------------------------- geometry */

const char *wh_geometry_unit(int number, double *factor) {
    const bool is_tilt = number == WH_GEOMETRY_TILT_X || number == WH_GEOMETRY_TILT_Y;
    const int axis = number - WH_GEOMETRY_ZERO;
    const bool is_zero = axis >= 0 && axis < WH_ROBOT_AXES;
    *factor = 1;
    if (number >= WH_GEOMETRY_SCALE) {
        return "";
    }
    if (is_tilt || (is_zero && wh_table_axis_turns((size_t)axis))) {
        *factor = wh_deg_from_rad(1);
        return "deg";
    }
    return "mm";
}

static void put_comment(bool has_at, bool has_rpy, FILE *out) {
    if (!has_at) {
        fputs(has_rpy ? " -- at is not determined" : " -- at is not determined, rpy neither", out);
    } else if (!has_rpy) {
        fputs(" -- rpy is not determined", out);
    }
}

/* The fields of the gripper; a comment where one is not determined. */
static void put_tool(const wh_geometry_estimate_t *found, FILE *out) {
    const wh_estimate_value_t *x = &found->values[WH_GEOMETRY_TOOL_X];
    const wh_estimate_value_t *y = &found->values[WH_GEOMETRY_TOOL_Y];
    const wh_estimate_value_t *yaw = &found->values[WH_GEOMETRY_ZERO + WH_AXIS_YAW];
    const bool has_at = x->is_determined && y->is_determined;
    const double deg = wh_deg_from_rad(1);
    fputs("grippers = {\n  { ", out);
    if (has_at) {
        fputs("at = ", out);
        put_list(out, (const double[]){x->value, y->value, 0}, (const double[]){x->sd, y->sd, 10});
        fputs(yaw->is_determined ? ", " : " ", out);
    }
    if (yaw->is_determined) {
        fputs("rpy = ", out);
        put_list(out, (const double[]){0, 0, yaw->value * deg}, (const double[]){10, 10, yaw->sd * deg});
        fputc(' ', out);
    }
    fputs("},", out);
    put_comment(has_at, yaw->is_determined, out);
    fputs("\n},\n", out);
}

static void put_base(const wh_geometry_estimate_t *found, FILE *out) {
    const wh_estimate_value_t *values = found->values;
    const wh_vec3_t *r = &found->points_from_base.r;
    const double deg = wh_deg_from_rad(1);
    double rpy[3];
    for (int i = 0; i < 3; ++i) {
        rpy[i] = found->base_rpy[i] * deg;
    }
    if (!found->is_base_determined) {
        fputs("-- base is not determined\n", out);
        return;
    }
    fputs("-- A layout's robot stands at the origin of base, level. From the touched points' frame:\n"
          "-- base = { at = ",
          out);
    put_list(out, (const double[]){r->x, r->y, r->z},
             (const double[]){values[WH_GEOMETRY_X].sd, values[WH_GEOMETRY_Y].sd,
                              values[WH_GEOMETRY_ZERO + WH_AXIS_Z].sd});
    fputs(", rpy = ", out);
    put_list(out, rpy,
             (const double[]){values[WH_GEOMETRY_TILT_X].sd * deg, values[WH_GEOMETRY_TILT_Y].sd * deg,
                              values[WH_GEOMETRY_ZERO + WH_AXIS_THETA].sd * deg});
    fputs(" }\n-- Poses known in that frame go into base before they are a station's at and rpy.\n", out);
}

/* How a layout's axes relate to the controller's. */
static void put_axes(const wh_geometry_estimate_t *found, FILE *out) {
    for (int axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_estimate_value_t *scale = &found->values[WH_GEOMETRY_SCALE + axis];
        const wh_estimate_value_t *zero = &found->values[WH_GEOMETRY_ZERO + axis];
        const bool has_zero = axis == WH_AXIS_R && zero->is_determined;
        if (scale->is_determined || has_zero) {
            fprintf(out, "-- A layout's %s is the controller's", wh_table_axis_name((size_t)axis));
            if (scale->is_determined) {
                fputs(" * ", out);
                put_number(out, scale->value, scale->sd);
            }
            if (has_zero) {
                fputs(zero->value < 0 ? " - " : " + ", out);
                put_number(out, fabs(zero->value), zero->sd);
            }
            fputc('\n', out);
        }
    }
}

void wh_geometry_print_lua(const wh_touch_table_t *table, FILE *out) {
    const wh_geometry_estimate_t *found = &table->estimate;
    if (found->status != WH_OK) {
        fputs("-- the robot's geometry is not determined\n", out);
        return;
    }
    put_tool(found, out);
    put_base(found, out);
    put_axes(found, out);
}
