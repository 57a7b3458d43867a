#include "figures.h"

#include "../text/array.h"

/* A tenth. */
#define LESS_PPM 100000

static void shorten(int64_t times_us[], size_t count, int32_t ppm) {
    for (size_t i = 0; i < count; ++i) {
        times_us[i] = wh_flow_less_us(times_us[i], ppm);
    }
}

static void shorten_robot(wh_flow_tool_t *tool, int32_t robot, int32_t ppm) {
    const size_t of = wh_flow_of(tool, robot, 0), stations = tool->station_count;
    shorten(&tool->pick_us[of], stations, ppm);
    shorten(&tool->place_us[of], stations, ppm);
    shorten(&tool->swap_us[of], stations, ppm);
    shorten(&tool->move_us[of * stations], stations * stations, ppm);
}

static void shorten_station(wh_flow_tool_t *tool, int32_t station, int32_t ppm) {
    wh_flow_station_t *of = &tool->stations[station];
    of->less_ppm = ppm;
    shorten(&of->process_us, 1, ppm);
    wh_flow_hasten_recipes(of, ppm);
    shorten(&of->clean_us, 1, ppm);
    shorten(&of->comes_us, 1, ppm);
    shorten(&of->goes_us, 1, ppm);
    shorten(of->pump_us, 2, ppm);
    shorten(of->empty_pump_us, 2, ppm);
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        wh_flow_door_t *door = &tool->doors[wh_flow_of(tool, r, station)];
        shorten(&door->open_us, 1, ppm);
        shorten(&door->close_us, 1, ppm);
    }
}

void wh_flow_shorten(wh_flow_tool_t *tool, int32_t robot, int32_t station, int32_t ppm) {
    if (robot != WH_FLOW_NONE) {
        shorten_robot(tool, robot, ppm);
    } else {
        shorten_station(tool, station, ppm);
    }
}

wh_flow_gain_t *wh_flow_gains(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan) {
    const size_t robots = tool->robot_count, stations = tool->station_count;
    wh_flow_gain_t *gains = wh_array_new(robots + stations, sizeof *gains);
    for (size_t i = 0; i < robots + stations; ++i) {
        wh_flow_tool_t other;
        wh_flow_figures_t figures;
        const int32_t robot = i < robots ? (int32_t)i : WH_FLOW_NONE;
        const int32_t station = i < robots ? WH_FLOW_NONE : (int32_t)(i - robots);
        wh_flow_tool_copy(&other, tool);
        wh_flow_shorten(&other, robot, station, LESS_PPM);
        wh_flow_measure(&other, plan, WH_FLOW_SUMS, &figures);
        const wh_flow_result_t *result = &figures.result;
        gains[i] = (wh_flow_gain_t){robot,
                                    station,
                                    result->end,
                                    result->makespan_us,
                                    result->period > 0 ? (double)result->cycle_us / result->period : -1,
                                    figures.stays.late_count};
        wh_flow_figures_close(&figures);
        wh_flow_tool_close(&other);
    }
    return gains;
}
