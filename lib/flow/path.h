/* The critical path of a flow: what the makespan consists of, from the last placing back to the beginning;
 * and what less time of each robot and station would bring. */
#ifndef WH_FLOW_PATH_H
#define WH_FLOW_PATH_H

#include "flow.h"

/* The words for parts of the path. */
typedef enum {
    WH_FLOW_PATH_MOVE,
    WH_FLOW_PATH_DOOR,
    WH_FLOW_PATH_PICK,
    WH_FLOW_PATH_PLACE,
    WH_FLOW_PATH_SWAP,
    WH_FLOW_PATH_PROCESS,
    WH_FLOW_PATH_CLEAN,
    WH_FLOW_PATH_PUMP,
    WH_FLOW_PATH_DOWN,
    WH_FLOW_PATH_LOT,     /* until a lot arrives */
    WH_FLOW_PATH_CARRIER, /* that comes or goes */
    WH_FLOW_PATH_TAKT,    /* between two wafers' starts */
    /* Nothing known ended at the instant at which it goes on, such as a clean for want of wafers. */
    WH_FLOW_PATH_WAIT,
    WH_FLOW_PATH_WORDS
} wh_flow_path_word_t;

extern const char *const wh_flow_path_words[WH_FLOW_PATH_WORDS];

/* All of the path's time in one doing of one robot or station. */
typedef struct {
    wh_flow_path_word_t word;
    int32_t robot, station; /* one of them, or WH_FLOW_NONE both */
    int64_t us;
} wh_flow_part_t;

/* The time that a flow would take if one robot (its moves, picks, places, swaps) or station (its
 * processes, cleans, pumps and doors) took 10 % less time. */
typedef struct {
    int32_t robot, station;
    wh_flow_end_t end;
    int64_t makespan_us;
    double cycle_us; /* of a wafer; below 0: there is no steady one */
    size_t late;     /* stays beyond windows */
} wh_flow_gain_t;

/* All events of a flow, in the order of their ends; those without duration are left out. */
typedef struct {
    wh_flow_event_t *events;
    size_t count, capacity;
} wh_flow_log_t;

void wh_flow_log_add(wh_flow_log_t *log, const wh_flow_event_t *event);

/* The parts, the longest first; they add up to the makespan to the microsecond. The caller frees them.
 * Each instant of the path is the end of what let the next part begin: of the robot's own doing, else of
 * the wafer's process, else of what was at the station, else of anything. Cost: the events of the path,
 * each with its neighbours in time. */
wh_flow_part_t *wh_flow_path(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, const wh_flow_log_t *log,
                             size_t *count);

/* Plays the flow once more for each robot, then each station. The caller frees the gains: robot_count +
 * station_count of them. */
wh_flow_gain_t *wh_flow_gains(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan);

#endif
