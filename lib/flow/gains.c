#include "path.h"

#include "../text/array.h"

static void shorten(int64_t times_us[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        times_us[i] -= (times_us[i] + 5) / 10;
    }
}

static void shorten_robot(wh_flow_tool_t *tool, int32_t robot) {
    const size_t of = wh_flow_of(tool, robot, 0), stations = tool->station_count;
    shorten(&tool->pick_us[of], stations);
    shorten(&tool->place_us[of], stations);
    shorten(&tool->swap_us[of], stations);
    shorten(&tool->move_us[of * stations], stations * stations);
}

static void shorten_station(wh_flow_tool_t *tool, int32_t station) {
    wh_flow_station_t *of = &tool->stations[station];
    of->is_shortened = true;
    shorten(&of->process_us, 1);
    shorten(&of->clean_us, 1);
    shorten(of->pump_us, 2);
    shorten(of->empty_pump_us, 2);
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        wh_flow_door_t *door = &tool->doors[wh_flow_of(tool, r, station)];
        shorten(&door->open_us, 1);
        shorten(&door->close_us, 1);
    }
}

wh_flow_gain_t *wh_flow_gains(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    const size_t robots = tool->robot_count, stations = tool->station_count;
    wh_flow_gain_t *gains = wh_array_new(robots + stations, sizeof *gains);
    for (size_t i = 0; i < robots + stations; ++i) {
        wh_flow_tool_t other;
        wh_flow_result_t result;
        const bool is_robot = i < robots;
        const int32_t number = (int32_t)(is_robot ? i : i - robots);
        wh_flow_tool_copy(&other, tool);
        if (is_robot) {
            shorten_robot(&other, number);
        } else {
            shorten_station(&other, number);
        }
        wh_flow_play(&other, plan, NULL, &result);
        gains[i] = (wh_flow_gain_t){is_robot ? number : WH_FLOW_NONE, is_robot ? WH_FLOW_NONE : number,
                                    result.end, result.makespan_us,
                                    result.period > 0 ? (double)result.cycle_us / result.period : -1};
        wh_flow_result_close(&result);
        wh_flow_tool_close(&other);
    }
    return gains;
}
