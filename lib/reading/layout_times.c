/* The times of stations: those that a tool of times alone and a cell with axes have alike, and of the latter
 * which doors and sides go with them. */
#include <math.h>

#include "../layout/words.h"
#include "layout_internal.h"
#include "layout_tool.h"

int64_t wh_layout_us(double seconds) {
    return (int64_t)llround(seconds * 1e6);
}

int64_t wh_timed_read_us(wh_reader_t *reader, const char *field, double fallback) {
    return wh_layout_us(wh_reader_number(reader, field, fallback, 0, WH_TIMED_LONGEST_S));
}

int64_t wh_layout_read_us(wh_reader_t *reader, const char *field) {
    return wh_layout_us(wh_reader_apart(reader, field));
}

static void read_process(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes) {
    double by[WH_FLOW_RECIPES];
    bool is_table = false;
    station->process_us = wh_layout_us(wh_layout_read_by_recipe(reader, "process", recipes, by, &is_table));
    station->has_recipes = station->has_recipes || is_table;
    for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
        station->by_recipe[i].process_us = wh_layout_us(by[i]);
        station->by_recipe[i].idle_us = WH_FLOW_NEVER;
    }
}

static void read_after(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes) {
    double by[WH_FLOW_RECIPES];
    bool is_table = false;
    station->clean_after = (int32_t)wh_layout_read_by_recipe(reader, "after", recipes, by, &is_table);
    station->has_recipes = station->has_recipes || is_table;
    for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
        station->by_recipe[i].clean_after = (int32_t)by[i];
    }
}

static void read_idle(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes) {
    double by[WH_FLOW_RECIPES];
    bool is_table = false;
    station->idle_us = wh_layout_us(wh_layout_read_by_recipe(reader, "idle", recipes, by, &is_table));
    station->has_recipes = station->has_recipes || is_table;
    for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
        station->by_recipe[i].idle_us = wh_layout_us(by[i]);
    }
}

static void read_clean(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes) {
    if (!wh_reader_open(reader, "clean", wh_layout_clean_fields)) {
        return;
    }
    if (!wh_reader_has(reader, "after") && !wh_reader_has(reader, "idle")) {
        wh_reader_fail(reader, NULL, "when it comes: `after` wafers, or `idle` seconds");
    }
    if (wh_reader_has(reader, "after")) {
        read_after(reader, station, recipes);
    }
    station->clean_us = wh_layout_read_us(reader, "seconds");
    station->cleans_full = !(wh_reader_apart(reader, "empty") > 0);
    if (wh_reader_has(reader, "idle")) {
        read_idle(reader, station, recipes);
    }
    wh_reader_leave(reader);
}

static void read_pump(wh_reader_t *reader, wh_flow_station_t *station, const wh_reader_field_t *pump_fields) {
    station->is_lock = wh_reader_open(reader, "pump", pump_fields);
    if (station->is_lock) {
        const double down = wh_reader_apart(reader, "down"), up = wh_reader_apart(reader, "up");
        station->pump_us[WH_FLOW_VACUUM] = wh_layout_us(down);
        station->pump_us[WH_FLOW_ATMOSPHERE] = wh_layout_us(up);
        station->empty_pump_us[WH_FLOW_VACUUM] =
            wh_layout_us(wh_reader_apart_from(reader, "empty_down", down));
        station->empty_pump_us[WH_FLOW_ATMOSPHERE] =
            wh_layout_us(wh_reader_apart_from(reader, "empty_up", up));
        wh_reader_leave(reader);
    } else if (wh_reader_has(reader, "state")) {
        wh_reader_refuse(reader, "state", NULL, "nothing: it has no `pump`");
    }
    station->side = (wh_flow_side_t)wh_reader_apart(reader, "state");
}

void wh_layout_read_clockwork(wh_reader_t *reader, wh_flow_station_t *station, wh_flow_recipes_t *recipes,
                              const wh_reader_field_t *pump_fields) {
    read_process(reader, station, recipes);
    if (wh_reader_has(reader, "window")) {
        station->window_us = wh_layout_read_us(reader, "window");
    }
    read_clean(reader, station, recipes);
    read_pump(reader, station, pump_fields);
}

/* ------------------------------------------------------------------------------------ in a cell with axes */

static bool says_any(const wh_reader_t *reader) {
    static const char *const fields[] = {"process", "window", "clean", "pump", "state", "side"};
    bool says = false;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        says = says || wh_reader_has(reader, fields[i]);
    }
    return says;
}

/* Wafers on a chuck are turned and scanned, not processed. */
static void refuse_chuck(wh_reader_t *reader, const wh_layout_station_t *station) {
    static const char *const fields[] = {"process", "window", "clean", "pump"};
    for (size_t i = 0; (station->prealigner || station->flipper) && i < sizeof fields / sizeof fields[0];
         ++i) {
        wh_layout_refuse_field(reader, fields[i], "nothing: the station is a prealigner or a flipper");
    }
}

static wh_flow_side_t read_side(wh_reader_t *reader, const wh_layout_times_t *times, const char *who) {
    if (!times || !times->of.is_lock) {
        wh_layout_refuse_field(reader, "side", "nothing: the station has no `pump`");
        return WH_FLOW_BOTH;
    }
    if (!wh_reader_has(reader, "side")) {
        wh_reader_refuse(reader, "side", NULL,
                         "\"vacuum\" or \"atmosphere\": where %s comes into the load lock", who);
    }
    return (wh_flow_side_t)wh_reader_apart(reader, "side");
}

/* A door stands between the lock and one side. */
static void add_door(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_times_t *times, int32_t door,
                     wh_flow_side_t side) {
    if (door == WH_NONE || !times) {
        return;
    }
    times->doors |= UINT32_C(1) << door;
    if (!times->of.is_lock) {
        return;
    }
    times->side_doors[side] |= UINT32_C(1) << door;
    if ((times->side_doors[WH_FLOW_ATMOSPHERE] & times->side_doors[WH_FLOW_VACUUM]) != 0) {
        wh_reader_refuse(reader, "door", layout->door_list[door].name,
                         "a door of one side: on the load lock's other side it leads in, too");
    }
}

/* With several robots: the side and the door of each that serves the station. */
static void read_servers(wh_reader_t *reader, const wh_layout_t *layout, const wh_layout_station_t *station,
                         wh_layout_times_t *times) {
    const bool is_said = wh_reader_enter(reader, "by");
    wh_layout_refuse_field(reader, "side", "nothing: with several robots `by` says it of each");
    if (times->of.is_lock && !is_said) {
        wh_reader_refuse(reader, "by", NULL, "the load lock's robots by name, each with its `side`");
    }
    for (size_t r = 0; r < layout->robot_count; ++r) {
        if (is_said && wh_reader_open(reader, layout->robots[r].name, wh_layout_approach_fields)) {
            station->by[r].side = read_side(reader, times, layout->robots[r].name);
            add_door(reader, layout, times, station->by[r].door, station->by[r].side);
            wh_reader_leave(reader);
        } else if (!is_said && station->by[r].serves) {
            add_door(reader, layout, times, station->by[r].door, WH_FLOW_BOTH);
        }
    }
    if (is_said) {
        wh_reader_leave(reader);
    }
}

/* Doors of a lock through which no robot comes. */
static void read_pump_doors(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_times_t *times) {
    if (!wh_reader_enter(reader, "pump")) {
        return;
    }
    if (wh_reader_open(reader, "doors", wh_layout_lock_doors_fields)) {
        for (int side = 0; side < 2; ++side) {
            if (wh_reader_has(reader, wh_flow_side_words[side])) {
                const int32_t door =
                    wh_layout_read_name(reader, layout, wh_flow_side_words[side], NULL, wh_layout_find_door,
                                        "the name of one of this layout's doors");
                add_door(reader, layout, times, door, (wh_flow_side_t)side);
            }
        }
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* When a run begins no door of a lock may be open but to the side whose pressure it has. */
static void check_homes(wh_reader_t *reader, const wh_layout_t *layout, const wh_layout_times_t *times) {
    for (size_t d = 0; times->of.is_lock && d < layout->machine.door_count; ++d) {
        const bool is_wrong = (times->side_doors[1 - (int)times->of.side] >> d & 1U) != 0;
        if (is_wrong && layout->machine.doors[d].is_open) {
            wh_reader_refuse(reader, "state", wh_flow_side_words[times->of.side],
                             "the pressure behind %s, whose home is open", layout->door_list[d].name);
        }
    }
}

static wh_layout_times_t *read_times(wh_reader_t *reader, const wh_layout_t *layout, size_t s,
                                     wh_flow_recipes_t *recipes) {
    const wh_layout_station_t *station = &layout->stations[s];
    wh_layout_times_t *times = wh_layout_memory(reader->L, 1, sizeof *times);
    times->of.slots = layout->places[s].slots;
    times->of.window_us = times->of.idle_us = WH_FLOW_NEVER;
    times->side = WH_FLOW_BOTH;
    wh_layout_read_clockwork(reader, &times->of, recipes, wh_layout_lock_fields);
    if (station->by) {
        read_servers(reader, layout, station, times);
    } else {
        times->side = read_side(reader, times, "the robot");
        add_door(reader, layout, times, station->door, times->side);
    }
    read_pump_doors(reader, layout, times);
    return times;
}

/* `side` goes with a lock alone. */
static void refuse_sides(wh_reader_t *reader, const wh_layout_t *layout) {
    if (wh_reader_enter(reader, "by")) {
        for (size_t r = 0; r < layout->robot_count; ++r) {
            if (wh_reader_enter(reader, layout->robots[r].name)) {
                wh_layout_refuse_field(reader, "side", "nothing: the station has no `pump`");
                wh_reader_leave(reader);
            }
        }
        wh_reader_leave(reader);
    }
}

/* A robot that is times alone comes so to the station; `times` is null if that takes none. */
static void read_timed_server(wh_reader_t *reader, const wh_layout_t *layout, size_t s,
                              wh_layout_times_t *times, int32_t robot) {
    const wh_layout_station_t *station = &layout->stations[s];
    const size_t of = wh_flow_of(layout->timed, robot, (int32_t)s);
    const char *name = layout->timed->robots[robot].name;
    if (station->prealigner || station->flipper) {
        wh_reader_fail(reader, NULL, "nothing: %s is times alone, and passes no wafer to a chuck or a clamp",
                       name);
    }
    layout->timed->serves[of] = true;
    layout->timed->sides[of] = read_side(reader, times, name);
    if (wh_reader_has(reader, "door")) {
        const int32_t door = wh_layout_read_name(reader, layout, "door", NULL, wh_layout_find_door,
                                                 "the name of one of this layout's doors");
        layout->timed->doors[of] = (wh_flow_door_t){.is_real = true, .number = door};
        add_door(reader, layout, times, door, layout->timed->sides[of]);
    }
}

static void read_timed_servers(wh_reader_t *reader, const wh_layout_t *layout, size_t s,
                               wh_layout_times_t *times) {
    if (!layout->timed || !wh_reader_enter(reader, "by")) {
        return;
    }
    for (int32_t r = 0; r < (int32_t)layout->timed->robot_count; ++r) {
        if (wh_reader_open(reader, layout->timed->robots[r].name, wh_layout_timed_way_fields)) {
            read_timed_server(reader, layout, s, times, r);
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
}

/* layout_ports.c reads these. */
static bool is_port(wh_reader_t *reader) {
    return (int)wh_reader_apart(reader, "kind") == WH_LAYOUT_LOAD_PORT;
}

void wh_layout_read_times(wh_reader_t *reader, wh_layout_t *layout) {
    wh_flow_recipes_t *recipes = wh_layout_memory(reader->L, 1, sizeof *recipes);
    layout->recipes = recipes;
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_layout_station_t *station = &layout->stations[s];
        (void)wh_reader_open(reader, station->name, wh_layout_station_fields);
        refuse_chuck(reader, station);
        for (size_t r = 0; station->by && r < layout->robot_count; ++r) {
            station->by[r].side = WH_FLOW_BOTH;
        }
        wh_layout_times_t *times = NULL;
        if (says_any(reader) && !is_port(reader)) {
            times = read_times(reader, layout, s, recipes);
        } else {
            refuse_sides(reader, layout);
        }
        read_timed_servers(reader, layout, s, times);
        if (times) {
            check_homes(reader, layout, times);
        }
        station->times = times;
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}
