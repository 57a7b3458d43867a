/* waferhand estimate frame|limits|robot FILE */
#include "../print/estimate_print.h"
#include "../text/options.h"
#include "app.h"

typedef struct {
    const char *path;
    bool json, delay, scales;
} arguments_t;

#define ABOUT                                                                                                \
    "Fits what a layout says of a cell to measurements: a table of comma-separated values whose first line " \
    "names its columns. Prints values with their standard deviations, what the measurements do not tell, "   \
    "and fields for a layout.\n\n"                                                                           \
    "frame: where stations stand, from points touched there. Columns: station, touched_x, touched_y, "       \
    "touched_z (mm in base), x, y, z (mm on the station).\n"                                                 \
    "limits: speed, acceleration and jerk of axes, from the times of moves. Columns: axis (theta, r, z, "    \
    "yaw or chuck), from, to (mm or degrees), seconds.\n"                                                    \
    "robot: where a robot stands, its axes' zeros and its tool, from points that it touched. Columns: "      \
    "theta, r, z, yaw (as its controller tells them), touched_x, touched_y, touched_z (mm), and perhaps "    \
    "heading (of the tool, degrees)."

#define JSON                                                                                                 \
    {                                                                                                        \
        "json", 0, NULL, "Print one JSON object instead of tables", WH_OPTION_FLAG,                          \
            .variable = offsetof(arguments_t, json)                                                          \
    }

#define DELAY                                                                                                \
    {                                                                                                        \
        "delay", 0, NULL, "For limits: also fit one delay, contained in each time", WH_OPTION_FLAG,          \
            .variable = offsetof(arguments_t, delay)                                                         \
    }

#define SCALES                                                                                               \
    {                                                                                                        \
        "scales", 0, NULL, "For a robot: also fit the factors of its axes' positions", WH_OPTION_FLAG,       \
            .variable = offsetof(arguments_t, scales)                                                        \
    }

static const wh_option_t frame_options[] = {JSON, {0}};
static const wh_option_t limits_options[] = {JSON, DELAY, {0}};
static const wh_option_t robot_options[] = {JSON, SCALES, {0}};
static const wh_option_t all_options[] = {JSON, DELAY, SCALES, {0}};
static const wh_option_table_t frame_tables[] = {{frame_options, 0, NULL, NULL}, {0}};
static const wh_option_table_t limits_tables[] = {{limits_options, 0, NULL, NULL}, {0}};
static const wh_option_table_t robot_tables[] = {{robot_options, 0, NULL, NULL}, {0}};
static const wh_option_table_t all_tables[] = {{all_options, 0, NULL, NULL}, {0}};

/* --------------------------------------------------------------------------------------- what is fitted */

static int refuse_table(const wh_csv_t *csv, wh_status_t status) {
    fprintf(stderr, "%s: error %d %s\n", csv->message, (int)status, wh_status_name(status));
    return WH_EXIT_USAGE;
}

/* The exit status after printing an estimate, determined or not. */
static int conclude(int printed, bool told) {
    if (!wh_app_is_printed(printed)) {
        return WH_EXIT_USAGE;
    }
    return told ? WH_EXIT_MET : WH_EXIT_FAILED;
}

static int fit_frames(const arguments_t *arguments) {
    wh_point_table_t table = {.count = 0};
    const wh_style_t style = wh_style_of(stdout);
    const wh_status_t status = wh_point_table_open(&table, arguments->path);
    int ends;
    if (status != WH_OK) {
        ends = refuse_table(&table.csv, status);
    } else {
        const bool told = wh_point_table_estimate(&table);
        ends = conclude(arguments->json ? wh_frames_print_json(&table, stdout)
                                        : wh_frames_print_table(&table, stdout, &style),
                        told);
    }
    wh_point_table_close(&table);
    return ends;
}

static int fit_limits(const arguments_t *arguments) {
    wh_move_table_t table = {.csv = {.path = NULL}};
    const wh_style_t style = wh_style_of(stdout);
    const wh_status_t status = wh_move_table_open(&table, arguments->path);
    int ends;
    if (status != WH_OK) {
        ends = refuse_table(&table.csv, status);
    } else {
        const bool told = wh_move_table_estimate(&table, arguments->delay);
        ends = conclude(arguments->json ? wh_limits_print_json(&table, stdout)
                                        : wh_limits_print_table(&table, stdout, &style),
                        told);
    }
    wh_move_table_close(&table);
    return ends;
}

static int fit_robot(const arguments_t *arguments) {
    wh_touch_table_t table = {.csv = {.path = NULL}};
    const wh_style_t style = wh_style_of(stdout);
    const wh_status_t status = wh_touch_table_open(&table, arguments->path);
    int ends;
    if (status != WH_OK) {
        ends = refuse_table(&table.csv, status);
    } else {
        const bool told = wh_touch_table_estimate(&table, arguments->scales);
        ends = conclude(arguments->json ? wh_geometry_print_json(&table, stdout)
                                        : wh_geometry_print_table(&table, stdout, &style),
                        told);
    }
    wh_touch_table_close(&table);
    return ends;
}

/* --------------------------------------------------------------------------------------------- its name */

static void refuse_kind(const void *filled, struct argp_state *state) {
    const arguments_t *arguments = filled;
    argp_error(state, "%s: no such estimate (expected frame, limits or robot)", arguments->path);
}

/* The line of an estimate whose name is known. */
#define LINE(KIND, TABLES)                                                                                   \
    {                                                                                                        \
        .name = "estimate " KIND, .synopsis = "FILE", .about = ABOUT "\v" WH_HELP_EXIT, .tables = (TABLES),  \
        .operand = "table", .operand_variable = offsetof(arguments_t, path)                                  \
    }

/* The first one is for a command line without a name: it ends the program. */
static const struct {
    const char *name;
    wh_command_line_t line;
    int (*fit)(const arguments_t *arguments);
} kinds[] = {
    {NULL,
     {.name = "estimate",
      .synopsis = "frame|limits|robot FILE",
      .about = ABOUT "\v" WH_HELP_EXIT,
      .tables = all_tables,
      .operand = "estimate: frame, limits or robot",
      .operand_variable = offsetof(arguments_t, path),
      .check = refuse_kind},
     NULL},
    {"frame", LINE("frame", frame_tables), fit_frames},
    {"limits", LINE("limits", limits_tables), fit_limits},
    {"robot", LINE("robot", robot_tables), fit_robot},
};

/* Takes the first word that is no option out of the arguments if it names an estimate; returns which. */
static size_t take_kind(int *argc, char **argv) {
    int at = 1;
    while (at < *argc && argv[at][0] == '-') {
        ++at;
    }
    for (size_t kind = 1; at < *argc && kind < sizeof kinds / sizeof kinds[0]; ++kind) {
        if (strcmp(argv[at], kinds[kind].name) == 0) {
            memmove(argv + at, argv + at + 1, (size_t)(*argc - at) * sizeof *argv);
            --*argc;
            return kind;
        }
    }
    return 0;
}

int wh_app_estimate(int argc, char **argv) {
    arguments_t arguments = {0};
    const size_t kind = take_kind(&argc, argv);
    wh_options_parse(&kinds[kind].line, argc, argv, &arguments);
    return kinds[kind].fit ? kinds[kind].fit(&arguments) : WH_EXIT_USAGE;
}
