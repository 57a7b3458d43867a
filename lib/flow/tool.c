#include "tool.h"

#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"

const char *const wh_flow_side_words[] = {"atmosphere", "vacuum", NULL};

void wh_flow_tool_open(wh_flow_tool_t *tool, size_t robot_count, size_t station_count) {
    const size_t pairs = robot_count * station_count;
    *tool = (wh_flow_tool_t){
        .stations = wh_array_new(station_count, sizeof *tool->stations),
        .robots = wh_array_new(robot_count, sizeof *tool->robots),
        .station_count = station_count,
        .robot_count = robot_count,
        .pick_us = wh_array_new(pairs, sizeof *tool->pick_us),
        .place_us = wh_array_new(pairs, sizeof *tool->place_us),
        .swap_us = wh_array_new(pairs, sizeof *tool->swap_us),
        .doors = wh_array_new(pairs, sizeof *tool->doors),
        .serves = wh_array_new(pairs, sizeof *tool->serves),
        .sides = wh_array_new(pairs, sizeof *tool->sides),
        .move_us = wh_array_new(pairs * station_count, sizeof *tool->move_us),
    };
    for (size_t i = 0; i < station_count; ++i) {
        tool->stations[i].slots = 1;
        tool->stations[i].window_us = WH_FLOW_NEVER;
        tool->stations[i].idle_us = WH_FLOW_NEVER;
    }
    for (size_t i = 0; i < robot_count; ++i) {
        tool->robots[i].arms = 1;
    }
    for (size_t i = 0; i < pairs; ++i) {
        tool->sides[i] = WH_FLOW_BOTH;
    }
}

static int64_t longer_us(int64_t process_us, int64_t us) {
    return process_us <= 0 ? process_us : process_us + us > 1 ? process_us + us : 1;
}

void wh_flow_lengthen(wh_flow_station_t *station, int64_t us) {
    station->process_us = longer_us(station->process_us, us);
    for (size_t i = 0; station->has_recipes && i < WH_FLOW_RECIPES; ++i) {
        station->by_recipe[i].process_us = longer_us(station->by_recipe[i].process_us, us);
    }
    station->off_us += us;
}

void wh_flow_tool_number(wh_flow_tool_t *tool) {
    tool->place_count = 0;
    for (size_t i = 0; i < tool->station_count; ++i) {
        tool->stations[i].first_place = (int32_t)tool->place_count;
        tool->place_count += (size_t)tool->stations[i].slots;
    }
    tool->place_stations = wh_array_new(tool->place_count, sizeof *tool->place_stations);
    tool->slot_sides = wh_array_new(tool->place_count, sizeof *tool->slot_sides);
    for (size_t i = 0; i < tool->station_count; ++i) {
        const wh_flow_station_t *station = &tool->stations[i];
        for (int32_t slot = 0; slot < station->slots; ++slot) {
            tool->place_stations[station->first_place + slot] = (int32_t)i;
            tool->slot_sides[station->first_place + slot] = WH_FLOW_BOTH;
        }
    }
}

void wh_flow_route_close(wh_flow_route_t *route) {
    for (size_t k = 0; k < route->step_count; ++k) {
        free(route->steps[k].stations);
    }
    free(route->steps);
    free(route->name);
}

void wh_flow_tool_close(wh_flow_tool_t *tool) {
    for (size_t i = 0; i < tool->station_count; ++i) {
        free(tool->stations[i].name);
    }
    for (size_t i = 0; i < tool->robot_count; ++i) {
        free(tool->robots[i].name);
    }
    for (size_t i = 0; i < tool->route_count; ++i) {
        wh_flow_route_close(&tool->routes[i]);
    }
    free(tool->routes);
    free(tool->stations);
    free(tool->robots);
    free(tool->pick_us);
    free(tool->place_us);
    free(tool->swap_us);
    free(tool->doors);
    free(tool->serves);
    free(tool->sides);
    free(tool->move_us);
    free(tool->place_stations);
    free(tool->slot_sides);
    memset(tool, 0, sizeof *tool);
}

static void *copy_of(const void *items, size_t count, size_t size) {
    void *copy = wh_array_new(count, size);
    memcpy(copy, items, count * size);
    return copy;
}

void wh_flow_tool_copy(wh_flow_tool_t *copy, const wh_flow_tool_t *tool) {
    const size_t pairs = tool->robot_count * tool->station_count;
    *copy = *tool;
    copy->routes = NULL;
    copy->route_count = 0;
    copy->stations = copy_of(tool->stations, tool->station_count, sizeof *copy->stations);
    copy->robots = copy_of(tool->robots, tool->robot_count, sizeof *copy->robots);
    copy->pick_us = copy_of(tool->pick_us, pairs, sizeof *copy->pick_us);
    copy->place_us = copy_of(tool->place_us, pairs, sizeof *copy->place_us);
    copy->swap_us = copy_of(tool->swap_us, pairs, sizeof *copy->swap_us);
    copy->doors = copy_of(tool->doors, pairs, sizeof *copy->doors);
    copy->serves = copy_of(tool->serves, pairs, sizeof *copy->serves);
    copy->sides = copy_of(tool->sides, pairs, sizeof *copy->sides);
    copy->move_us = copy_of(tool->move_us, pairs * tool->station_count, sizeof *copy->move_us);
    copy->place_stations = copy_of(tool->place_stations, tool->place_count, sizeof *copy->place_stations);
    copy->slot_sides = copy_of(tool->slot_sides, tool->place_count, sizeof *copy->slot_sides);
    for (size_t i = 0; i < tool->station_count; ++i) {
        copy->stations[i].name = wh_text_copy(tool->stations[i].name);
    }
    for (size_t i = 0; i < tool->robot_count; ++i) {
        copy->robots[i].name = wh_text_copy(tool->robots[i].name);
    }
}

bool wh_flow_is_cleaned(const wh_flow_station_t *station) {
    bool is_cleaned = station->clean_after > 0 || station->idle_us != WH_FLOW_NEVER;
    for (size_t i = 0; station->has_recipes && i < WH_FLOW_RECIPES; ++i) {
        is_cleaned = is_cleaned || station->by_recipe[i].clean_after > 0 ||
                     station->by_recipe[i].idle_us != WH_FLOW_NEVER;
    }
    return is_cleaned;
}

bool wh_flow_is_processing(const wh_flow_station_t *station) {
    bool is_processing = station->process_us > 0;
    for (size_t i = 0; station->has_recipes && i < WH_FLOW_RECIPES; ++i) {
        is_processing = is_processing || station->by_recipe[i].process_us > 0;
    }
    return is_processing;
}

int32_t wh_flow_recipe_named(const wh_flow_recipes_t *recipes, const char *name) {
    for (int32_t i = 0; i < recipes->count; ++i) {
        if (strcmp(recipes->names[i], name) == 0) {
            return i + 1;
        }
    }
    return 0;
}

void wh_flow_hasten_recipes(wh_flow_station_t *station, int32_t ppm) {
    for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
        station->by_recipe[i].process_us = wh_flow_less_us(station->by_recipe[i].process_us, ppm);
    }
}

int32_t wh_flow_station_named(const wh_flow_tool_t *tool, const char *name) {
    for (size_t i = 0; i < tool->station_count; ++i) {
        if (strcmp(tool->stations[i].name, name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_FLOW_NONE;
}

int32_t wh_flow_robot_named(const wh_flow_tool_t *tool, const char *name) {
    for (size_t i = 0; i < tool->robot_count; ++i) {
        if (strcmp(tool->robots[i].name, name) == 0) {
            return (int32_t)i;
        }
    }
    return WH_FLOW_NONE;
}

bool wh_flow_has_real(const wh_flow_tool_t *tool) {
    bool is_any = false;
    for (size_t r = 0; r < tool->robot_count; ++r) {
        is_any = is_any || tool->robots[r].is_real;
    }
    return is_any;
}

bool wh_flow_is_timed_at(const wh_flow_tool_t *tool, int32_t station, int32_t *robot) {
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        if (!tool->robots[r].is_real && tool->serves[wh_flow_of(tool, r, station)]) {
            *robot = r;
            return true;
        }
    }
    return false;
}

static uint64_t hash_times(uint64_t hash, const int64_t times_us[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = wh_hash_word(hash, (uint64_t)times_us[i]);
    }
    return hash;
}

uint64_t wh_flow_hash_recipes(const wh_flow_station_t *station, uint64_t hash) {
    for (size_t i = 0; station->has_recipes && i < WH_FLOW_RECIPES; ++i) {
        const wh_flow_treatment_t *by = &station->by_recipe[i];
        hash = hash_times(hash, (const int64_t[]){by->process_us, by->idle_us, by->clean_after}, 3);
    }
    return hash;
}

static uint64_t hash_station(uint64_t hash, const wh_flow_station_t *station) {
    const int64_t times_us[] = {station->process_us,       station->window_us,       station->clean_us,
                                station->idle_us,          station->pump_us[0],      station->pump_us[1],
                                station->empty_pump_us[0], station->empty_pump_us[1]};
    hash = hash_times(wh_hash_text(hash, station->name), times_us, sizeof times_us / sizeof times_us[0]);
    hash = wh_hash_int(wh_hash_int(hash, station->slots), station->clean_after);
    hash = wh_hash_int(wh_hash_int(hash, station->is_lock), station->is_load_port);
    hash = wh_flow_hash_recipes(station, wh_hash_int(hash, station->cleans_full));
    if (station->has_carriers) {
        hash =
            hash_times(hash, (const int64_t[]){station->is_absent, station->comes_us, station->goes_us}, 3);
    }
    return wh_hash_int(hash, (int32_t)station->side);
}

static uint64_t hash_route(uint64_t hash, const wh_flow_route_t *route) {
    hash = wh_hash_text(hash, route->name);
    for (size_t k = 1; k < route->step_count; ++k) {
        const wh_flow_step_t *step = &route->steps[k];
        hash = hash_times(hash, &step->process_us, 1);
        hash = wh_hash_int(wh_hash_int(hash, step->kept_empty), step->second_arm);
        hash = step->recipe > 0 ? wh_hash_int(hash, step->recipe) : hash;
        for (size_t i = 0; i < step->station_count; ++i) {
            hash = wh_hash_int(hash, step->stations[i]);
        }
    }
    return hash;
}

uint64_t wh_flow_tool_hash(const wh_flow_tool_t *tool, uint64_t hash) {
    const size_t pairs = tool->robot_count * tool->station_count;
    for (size_t i = 0; i < tool->station_count; ++i) {
        hash = hash_station(hash, &tool->stations[i]);
    }
    for (size_t i = 0; i < tool->robot_count; ++i) {
        hash = wh_hash_text(hash, tool->robots[i].name);
        hash = wh_hash_int(wh_hash_int(hash, tool->robots[i].arms), tool->robots[i].at);
    }
    hash = hash_times(hash, tool->pick_us, pairs);
    hash = hash_times(hash, tool->place_us, pairs);
    hash = hash_times(hash, tool->swap_us, pairs);
    hash = hash_times(hash, tool->move_us, pairs * tool->station_count);
    for (size_t i = 0; i < pairs; ++i) {
        hash = hash_times(hash, (const int64_t[]){tool->doors[i].open_us, tool->doors[i].close_us}, 2);
        hash = wh_hash_int(wh_hash_int(hash, tool->serves[i]), (int32_t)tool->sides[i]);
    }
    for (size_t i = 0; i < tool->place_count; ++i) {
        hash = wh_hash_int(hash, (int32_t)tool->slot_sides[i]);
    }
    for (int32_t i = 0; i < tool->recipes.count; ++i) {
        hash = wh_hash_text(hash, tool->recipes.names[i]);
    }
    for (size_t i = 0; i < tool->route_count; ++i) {
        hash = hash_route(hash, &tool->routes[i]);
    }
    return hash;
}
