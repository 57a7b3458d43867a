/* waferhand schedule FILE */
#include <stdlib.h>

#include "../print/schedule_print.h"
#include "../schedule/map.h"
#include "../text/array.h"
#include "app.h"
#include "layout_arguments.h"

typedef struct {
    wh_layout_arguments_t layout;
    const char *path, *map;
    wh_option_list_t arms;
    bool json, play;
} arguments_t;

static const wh_option_t options[] = {
    {"columns", 0, "MAP.lua", "Read FILE by a Lua file that says which of its columns are ours",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, map)},
    {"layout", 0, "LAYOUT",
     "Also hold it against this cell of timed robots: times, windows, cleans, load locks, routes",
     WH_OPTION_TEXT, .variable = offsetof(arguments_t, layout.path)},
    {"arms", 0, "ROBOT=N", "How many arms a robot has, 1 or 2; may be given again", WH_OPTION_LIST,
     .variable = offsetof(arguments_t, arms)},
    {"play", 0, NULL,
     "Also play it in the layout by its timed robots, if it can be carried out: nothing but stays beyond "
     "windows was found",
     WH_OPTION_FLAG, .variable = offsetof(arguments_t, play)},
    {"json", 0, NULL, "Print one JSON object instead of tables", WH_OPTION_FLAG,
     .variable = offsetof(arguments_t, json)},
    {0}};

static void check_schedule_arguments(const void *given, struct argp_state *state) {
    const arguments_t *arguments = given;
    if (arguments->play && !arguments->layout.path) {
        argp_error(state, "--play: no cell to play it in (goes with --layout)");
    }
    if (arguments->layout.parameters.count > 0 && !arguments->layout.path) {
        argp_error(state, "--set: %s (goes with --layout)", arguments->layout.parameters.items[0]);
    }
}

static const wh_option_table_t tables[] = {{options, 0, NULL, check_schedule_arguments},
                                           {wh_layout_options, offsetof(arguments_t, layout), NULL, NULL},
                                           {0}};

static const wh_command_line_t command_line = {
    .name = "schedule",
    .synopsis = "FILE",
    .about = "Holds a schedule of others against what no tool can break: who picks, places, swaps, moves or "
             "processes which wafer, where and when. Columns: robot, action, wafer, station, slot, begin_s, "
             "end_s, and perhaps arm, wafer2, to, value. Tells the first line that cannot be, then all by "
             "rule, and which rules it did not look at.\v" WH_HELP_EXIT,
    .tables = tables,
    .operand = "schedule",
    .operand_variable = offsetof(arguments_t, path)};

/* The number of the robot whose name is the first bytes of a text; WH_FLOW_NONE: the schedule has none. */
static int32_t find_robot(const wh_schedule_names_t *robots, const char *text, size_t length) {
    for (size_t i = 0; i < robots->count; ++i) {
        if (strlen(robots->texts[i]) == length && strncmp(robots->texts[i], text, length) == 0) {
            return (int32_t)i;
        }
    }
    return WH_FLOW_NONE;
}

/* Reads --arms into counts by the numbers of the schedule's robots. */
static bool read_arms(const arguments_t *arguments, const wh_schedule_t *schedule, int32_t *arms) {
    for (size_t i = 0; i < arguments->arms.count; ++i) {
        const char *text = arguments->arms.items[i], *equals = strrchr(text, '=');
        if (!equals || (strcmp(equals, "=1") != 0 && strcmp(equals, "=2") != 0)) {
            fprintf(stderr, "--arms: %s (expected ROBOT=1 or ROBOT=2)\n", text);
            return false;
        }
        const int32_t robot = find_robot(&schedule->robots, text, (size_t)(equals - text));
        if (robot == WH_FLOW_NONE || arms[robot] != 0) {
            fprintf(stderr, "--arms: %s (expected a robot of the schedule, once)\n", text);
            return false;
        }
        arms[robot] = equals[1] - '0';
    }
    return true;
}

static int conclude(const arguments_t *arguments, const wh_schedule_report_t *report,
                    const wh_schedule_play_t *play) {
    const wh_style_t style = wh_style_of(stdout);
    const int printed = arguments->json ? wh_schedule_print_json(report, play, stdout)
                                        : wh_schedule_print_table(report, play, stdout, &style);
    if (!wh_app_is_printed(printed)) {
        return WH_EXIT_USAGE;
    }
    if (wh_schedule_first(report) || (play->is_played && play->figures.result.end != WH_FLOW_DONE)) {
        return WH_EXIT_FAILED;
    }
    return wh_schedule_is_good(report) ? WH_EXIT_MET : WH_EXIT_NO_ANSWER;
}

static int look_at(const arguments_t *arguments, const wh_schedule_t *schedule, const wh_flow_tool_t *tool,
                   const int32_t *arms) {
    wh_schedule_report_t report = {.schedule = schedule};
    wh_schedule_play_t play = {.is_played = false};
    const wh_schedule_given_t given = {tool, arms};
    int status = WH_EXIT_USAGE;
    if (!wh_schedule_check(&report, schedule, &given)) {
        fprintf(stderr, "%s\n", report.message);
    } else if (arguments->play && wh_schedule_first_bar(&report)) {
        fprintf(stderr, "--play: %s: not played, for it cannot be carried out\n", schedule->path);
        status = conclude(arguments, &report, &play);
    } else if (arguments->play && !wh_schedule_play(&play, schedule, tool)) {
        fprintf(stderr, "--play: %s\n", play.message);
    } else {
        status = conclude(arguments, &report, &play);
    }
    if (tool) {
        wh_schedule_play_close(&play, tool);
    }
    wh_schedule_report_close(&report);
    return status;
}

static int act(arguments_t *arguments) {
    wh_schedule_t schedule = {.path = NULL};
    char message[1600] = "";
    const wh_sandbox_limits_t limits = {.memory_bytes = (size_t)(arguments->layout.memory_mib * 1048576),
                                        .print_to = stderr};
    const wh_layout_t *layout = arguments->layout.path ? wh_layout_arguments_load(&arguments->layout) : NULL;
    int status = WH_EXIT_USAGE;
    if (arguments->layout.path && !layout) {
        return status;
    }
    const bool read =
        arguments->map ? wh_schedule_read_mapped(&schedule, arguments->path, arguments->map, &limits, message)
                       : wh_schedule_read(&schedule, arguments->path, message);
    if (!read) {
        fprintf(stderr, "%s\n", message);
    } else {
        int32_t *arms = wh_array_new(schedule.robots.count + 1, sizeof *arms);
        if (read_arms(arguments, &schedule, arms)) {
            status = look_at(arguments, &schedule, layout ? layout->tool : NULL, arms);
        }
        free(arms);
    }
    wh_schedule_close(&schedule);
    return status;
}

int wh_app_schedule(int argc, char **argv) {
    arguments_t arguments = {.layout = {.is_timed = true, .refuses_unread = true}};
    wh_options_parse(&command_line, argc, argv, &arguments);
    const int status = act(&arguments);
    wh_layout_arguments_free(&arguments.layout);
    wh_option_list_free(&arguments.arms);
    return status;
}
