/* A flow: its rate first, then where the time of robots and stations went, and stays beyond windows. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../flow/textbook.h"
#include "../flow/waits.h"
#include "../text/array.h"
#include "print_internal.h"

/* The most rows of a list. */
#define LISTED 20

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

static const char *name_of(const wh_flow_tool_t *tool, int32_t robot, int32_t station) {
    return robot != WH_FLOW_NONE     ? tool->robots[robot].name
           : station != WH_FLOW_NONE ? tool->stations[station].name
                                     : "-";
}

/* The closed form's cycle and what limits it, and who has the least time to spare. */
static void print_limits(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_textbook_t textbook = wh_flow_textbook(figures->tool, figures->plan);
    const wh_flow_busy_t busiest = wh_flow_busiest(figures);
    if (textbook.why) {
        fprintf(printer->out, "no closed form for the cycle: %s\n", textbook.why);
    } else {
        fprintf(printer->out, "by closed form: one in %.6g s, for ", textbook.cycle_us / 1e6);
        const wh_flow_step_t *step = &figures->plan->routes[0].steps[textbook.step];
        for (size_t k = 0; k < step->station_count; ++k) {
            wh_print_say(printer, "%s%s", k > 0 ? ", " : "", figures->tool->stations[step->stations[k]].name);
        }
        wh_print_say(printer, "%s", textbook.step == 0 ? figures->tool->robots[0].name : "");
        fputc('\n', printer->out);
    }
    if (busiest.share > 0) {
        wh_print_say(printer, "busiest: %s, %.1f %% of the time",
                     name_of(figures->tool, busiest.robot, busiest.station), 100 * busiest.share);
        fputc('\n', printer->out);
    }
}

static void print_rate(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_result_t *result = &figures->result;
    char count[WH_PRINT_NUMBER_SIZE];
    if (result->period > 0) {
        const double cycle_s = seconds(result->cycle_us) / result->period;
        fprintf(printer->out, "%.1f wafers per hour, steady: one in %.6g s", 3600 / cycle_s, cycle_s);
        if (result->period > 1) {
            fprintf(printer->out, ", the same every %d wafers", (int)result->period);
        }
    } else {
        fprintf(printer->out, "no steady cycle: %s", result->no_cycle);
    }
    static const char *const behind[] = {"run-out", "a stop: nobody could go on", "an early end", "cut"};
    const bool has_rate = result->end == WH_FLOW_DONE || result->end == WH_FLOW_CUT;
    fprintf(printer->out, "\n%s %s in %.6f s, with start and %s",
            wh_print_count(count, (int64_t)result->over),
            result->over == 1 ? "wafer at its end" : "wafers at their ends", seconds(figures->end_us),
            behind[result->end]);
    if (has_rate && result->over > 0 && figures->end_us > 0) {
        fprintf(printer->out, ": %.1f an hour", 3600 * (double)result->over / seconds(figures->end_us));
    }
    if (figures->end_us != result->makespan_us) {
        fprintf(printer->out, "\nshares are of %.6f s; the last placing ended at %.6f s",
                seconds(figures->end_us), seconds(result->makespan_us));
    }
    fputc('\n', printer->out);
}

/* The classes that have any time, as columns in percent. */
static size_t name_columns(wh_grid_t *grid, const double sums[], const char *const names[], size_t count,
                           size_t columns[]) {
    size_t used = 0;
    for (size_t i = 0; i < count; ++i) {
        if (sums[i] > 0) {
            char heading[64], words[48];
            wh_text_words(words, sizeof words, names[i]);
            (void)snprintf(heading, sizeof heading, "%s %%{1}", words);
            wh_grid_columns(grid, heading);
            columns[used++] = i;
        }
    }
    return used;
}

static void print_robots(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    double sums[WH_FLOW_ROBOT_CLASSES] = {0};
    size_t columns[WH_FLOW_ROBOT_CLASSES];
    for (size_t r = 0; r < tool->robot_count; ++r) {
        for (size_t i = 0; i < WH_FLOW_ROBOT_CLASSES; ++i) {
            sums[i] += figures->robots[r][i];
        }
    }
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "robot");
    const size_t used = name_columns(grid, sums, wh_flow_robot_class_names, WH_FLOW_ROBOT_CLASSES, columns);
    for (size_t r = 0; r < tool->robot_count && figures->end_us > 0; ++r) {
        wh_grid_named_row(grid, tool->robots[r].name);
        for (size_t i = 0; i < used; ++i) {
            wh_grid_number(grid, 1 + i, WH_INK_PLAIN,
                           100 * figures->robots[r][columns[i]] / (double)figures->end_us);
        }
    }
    wh_print_titled(printer, "Robots", grid);
}

/* The robot or station for which done wafers of a station waited longest; null if they did not wait. */
static const char *blocker_of(const wh_flow_figures_t *figures, size_t station) {
    const wh_flow_tool_t *tool = figures->tool;
    const char *name = NULL;
    double most = 0;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        const double us = figures->blocked_by_robot[station * tool->robot_count + r];
        if (us > most) {
            most = us;
            name = tool->robots[r].name;
        }
    }
    for (size_t s = 0; s < tool->station_count; ++s) {
        const double us = figures->blocked_by_station[station * tool->station_count + s];
        if (us > most) {
            most = us;
            name = tool->stations[s].name;
        }
    }
    return name;
}

static void print_stations(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    double sums[WH_FLOW_STATION_CLASSES] = {0};
    size_t columns[WH_FLOW_STATION_CLASSES];
    for (size_t s = 0; s < tool->station_count; ++s) {
        for (size_t i = 0; i < WH_FLOW_STATION_CLASSES; ++i) {
            sums[i] += figures->stations[s][i];
        }
    }
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "station;placed{0}");
    const size_t used =
        name_columns(grid, sums, wh_flow_station_class_names, WH_FLOW_STATION_CLASSES, columns);
    wh_grid_columns(grid, "blocked most by");
    for (size_t s = 0; s < tool->station_count && figures->end_us > 0; ++s) {
        const double all = (double)figures->end_us * tool->stations[s].slots;
        wh_grid_named_row(grid, tool->stations[s].name);
        wh_grid_number(grid, 1, WH_INK_PLAIN, (double)figures->placed[s]);
        for (size_t i = 0; i < used; ++i) {
            wh_grid_number(grid, 2 + i, WH_INK_PLAIN, 100 * figures->stations[s][columns[i]] / all);
        }
        const char *blocker = blocker_of(figures, s);
        if (blocker) {
            wh_grid_text(grid, 2 + used, WH_INK_PLAIN, "%s", blocker);
        }
    }
    wh_print_titled(printer, "Stations", grid);
}

static void print_path(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "of;doing;s{3,6};%{1}");
    for (size_t i = 0; i < figures->part_count && i < LISTED; ++i) {
        const wh_flow_part_t *part = &figures->parts[i];
        const double values[] = {seconds(part->us), 100 * (double)part->us / (double)figures->end_us};
        wh_grid_named_row(grid, name_of(figures->tool, part->robot, part->station));
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", wh_flow_path_words[part->word]);
        wh_grid_numbers(grid, 2, values, sizeof values / sizeof values[0]);
    }
    const bool is_whole = figures->end_us == figures->result.makespan_us;
    wh_print_titled(printer, is_whole ? "Critical path" : "Critical path, to the last placing", grid);
    if (figures->part_count > LISTED) {
        fprintf(printer->out, "and %zu more\n", figures->part_count - LISTED);
    }
}

/* True if with some gain wafers stay beyond their windows. */
static bool has_late_gain(const wh_flow_figures_t *figures, size_t count) {
    bool has = false;
    for (size_t i = 0; i < count; ++i) {
        has = has || figures->gains[i].late > 0;
    }
    return has;
}

static bool changes_something(const wh_flow_gain_t *gain, const wh_flow_result_t *result) {
    const double cycle_us = result->period > 0 ? (double)result->cycle_us / result->period : -1;
    return gain->end == result->end &&
           (gain->makespan_us != result->makespan_us || fabs(gain->cycle_us - cycle_us) >= 1);
}

/* Those alone that change something. */
static void print_gains(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    const wh_flow_result_t *result = &figures->result;
    const size_t count = figures->gains ? tool->robot_count + tool->station_count : 0;
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "10 % less of;makespan s{3,6};less s{3,6};cycle s{3,6}");
    if (has_late_gain(figures, count)) {
        wh_grid_columns(grid, "too long{0}");
    }
    for (size_t i = 0; i < count; ++i) {
        const wh_flow_gain_t *gain = &figures->gains[i];
        if (!changes_something(gain, result)) {
            continue;
        }
        const double values[] = {seconds(gain->makespan_us), seconds(result->makespan_us - gain->makespan_us),
                                 gain->cycle_us / 1e6};
        wh_grid_named_row(grid, name_of(tool, gain->robot, gain->station));
        wh_grid_numbers(grid, 1, values, gain->cycle_us > 0 ? 3 : 2);
        if (gain->cycle_us <= 0) {
            wh_grid_text(grid, 3, WH_INK_DIM, "none");
        }
        if (gain->late > 0) {
            wh_grid_number(grid, 4, WH_INK_BAD, (double)gain->late);
        }
    }
    wh_print_titled(printer, "Gains", grid);
}

/* Sums over all robots, and over all wafers that are done. */
static void print_waits(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    size_t count = 0;
    wh_flow_wait_t *waits = wh_flow_waits(figures, &count);
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "who waits;for;s{3,6}");
    for (size_t i = 0; i < count; ++i) {
        const wh_flow_wait_t *wait = &waits[i];
        const char *cause = wait->cause ? wait->cause : name_of(figures->tool, wait->robot, wait->station);
        wh_grid_named_row(grid, wait->cause ? "robots" : "done wafers");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s%s", wait->cause ? "a " : "", cause);
        wh_grid_number(grid, 2, WH_INK_PLAIN, wait->us / 1e6);
    }
    wh_print_titled(printer, "Waits by cause", grid);
    free(waits);
}

/* Each window, with the stay that came nearest to its end or went furthest beyond it. */
static void print_windows(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    wh_grid_t *grid = wh_grid_new(printer->style, 1,
                                  "station;window s{3,6};stays{0};too long{0};wafer;stay s{3,6};left s{3,6}");
    for (size_t s = 0; s < figures->tool->station_count; ++s) {
        const wh_flow_window_t *window = &figures->stays.windows[s];
        const wh_flow_stay_t *nearest = &window->nearest;
        if (window->count == 0) {
            continue;
        }
        const double values[] = {seconds(nearest->window_us), (double)window->count, (double)window->late};
        const double stay[] = {seconds(nearest->taken_us - nearest->done_us),
                               seconds(wh_flow_gap_us(nearest))};
        wh_grid_named_row(grid, figures->tool->stations[s].name);
        wh_grid_numbers(grid, 1, values, sizeof values / sizeof values[0]);
        wh_grid_text(grid, 4, WH_INK_PLAIN, "%s", figures->plan->wafers[nearest->wafer].name);
        wh_grid_numbers(grid, 5, stay, sizeof stay / sizeof stay[0]);
    }
    wh_print_titled(printer, "Windows, and the smallest gap to each", grid);
}

static void print_late(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_stays_t *stays = &figures->stays;
    wh_grid_t *grid = wh_grid_new(printer->style, 1,
                                  "wafer;station;done at s{3,6};stay s{3,6};window s{3,6};too long s{3,6}");
    for (size_t i = 0; i < stays->late_count && i < LISTED; ++i) {
        const wh_flow_stay_t *stay = &stays->late[i];
        const double values[] = {seconds(stay->done_us), seconds(stay->taken_us - stay->done_us),
                                 seconds(stay->window_us), -seconds(wh_flow_gap_us(stay))};
        wh_grid_named_row(grid, figures->plan->wafers[stay->wafer].name);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", figures->tool->stations[stay->station].name);
        wh_grid_numbers(grid, 2, values, sizeof values / sizeof values[0]);
    }
    wh_print_titled(printer, "Stays beyond their windows", grid);
    if (stays->late_count > LISTED) {
        fprintf(printer->out, "and %zu more\n", stays->late_count - LISTED);
    }
}

/* Wafers of one fate, by their names, the first ones of many. */
static void print_fate(const wh_printer_t *printer, const wh_flow_figures_t *figures, wh_flow_fate_t fate,
                       const char *text) {
    size_t count = 0;
    for (size_t w = 0; w < figures->plan->wafer_count; ++w) {
        if (figures->fates[w] == fate && count++ < LISTED) {
            wh_print_say(printer, "%s%s", count == 1 ? text : ", ", figures->plan->wafers[w].name);
        }
    }
    if (count > LISTED) {
        fprintf(printer->out, " and %zu more", count - LISTED);
    }
    if (count > 0) {
        fputc('\n', printer->out);
    }
}

/* Where nobody has said where robots begin, and where safe cannot be held. */
static void print_notes(const wh_printer_t *printer, const wh_flow_figures_t *figures) {
    const wh_flow_tool_t *tool = figures->tool;
    size_t said = 0;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        if (tool->robots[r].is_at_assumed) {
            wh_print_say(printer, "%s%s in front of %s",
                         said++ == 0 ? "! without `at`, robots begin at their first station: " : ", ",
                         tool->robots[r].name, tool->stations[tool->robots[r].at].name);
        }
    }
    if (said > 0) {
        fputc('\n', printer->out);
    }
    print_fate(printer, figures, WH_FLOW_FATE_LOST, "! lost where a station failed: ");
    print_fate(printer, figures, WH_FLOW_FATE_SKIPPED, "! left in their carriers: ");
    print_fate(printer, figures, WH_FLOW_FATE_SHORTENED,
               "! at their ends without steps whose stations failed: ");
    if (figures->result.may_block) {
        fprintf(printer->out,
                "! safe is not held for every flow of several robots by rule swap: what one of them "
                "carries may be in the way of the others\n");
    }
}

void wh_print_flow(const wh_printer_t *printer) {
    const wh_flow_t *flow = printer->record->flow;
    if (!flow || !flow->figures.tool) {
        return;
    }
    wh_print_title(printer, "Flow");
    print_rate(printer, &flow->figures);
    print_limits(printer, &flow->figures);
    print_notes(printer, &flow->figures);
    print_robots(printer, &flow->figures);
    print_stations(printer, &flow->figures);
    print_path(printer, &flow->figures);
    print_gains(printer, &flow->figures);
    print_waits(printer, &flow->figures);
    print_windows(printer, &flow->figures);
    print_late(printer, &flow->figures);
}
