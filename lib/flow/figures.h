/* Where the time of a flow went: each robot's and each place's, in classes without a rest, so that they
 * add up to the makespan to the microsecond; each wafer's stays; what was waited for. */
#ifndef WH_FLOW_FIGURES_H
#define WH_FLOW_FIGURES_H

#include "engine.h"
#include "path.h"
#include "stays.h"
#include "waiting.h"

/* The time of a station's places. */
typedef enum {
    WH_FLOW_STATION_PROCESS,
    WH_FLOW_STATION_BLOCKED, /* done, and the next place full, or the robot busy elsewhere */
    WH_FLOW_STATION_HANDLED, /* a blade is in it, or its door shuts before a process */
    WH_FLOW_STATION_STORED,  /* by wafers that have not begun, or are at their end */
    WH_FLOW_STATION_CLEAN,
    WH_FLOW_STATION_PUMP,
    WH_FLOW_STATION_DOWN,
    WH_FLOW_STATION_EMPTY,
    WH_FLOW_STATION_CLASSES
} wh_flow_station_class_t;

/* Names for people and for JSON, such as waits_wafer. */
extern const char *const wh_flow_robot_class_names[WH_FLOW_ROBOT_CLASSES];
extern const char *const wh_flow_station_class_names[WH_FLOW_STATION_CLASSES];

/* A wafer's visit to a place, from the begin of the transfer there on. Times that have not come are
 * WH_FLOW_NEVER; the place is WH_FLOW_NONE until it lies there. */
typedef struct {
    int32_t wafer, step, robot, arm, from, place;
    int64_t pick_us, picked_us, place_us, placed_us, process_us, done_us;
    bool is_end; /* its route ends there */
} wh_flow_visit_t;

/* How a wafer's route ended. */
typedef enum {
    WH_FLOW_FATE_INSIDE,    /* not yet, or it never came */
    WH_FLOW_FATE_END,       /* at its end */
    WH_FLOW_FATE_SHORTENED, /* at its end, without steps whose stations have failed */
    WH_FLOW_FATE_LOST,      /* in a station that failed, or on an arm with nowhere to go */
    WH_FLOW_FATE_SKIPPED    /* it was left in its carrier */
} wh_flow_fate_t;

/* "inside", "end", "shortened", "lost", "skipped" */
extern const char *const wh_flow_fate_names[];

/* A station's own doing. */
typedef struct {
    /* WH_FLOW_EVENT_CLEAN, WH_FLOW_EVENT_PUMP, WH_FLOW_EVENT_DOWN; of real doors WH_FLOW_EVENT_OPEN and
     * WH_FLOW_EVENT_SHUT; of load ports WH_FLOW_EVENT_COMES and WH_FLOW_EVENT_GOES */
    wh_flow_event_kind_t kind;
    int32_t station, place; /* place: of a clean */
    int32_t robot;          /* of a door, or WH_FLOW_NONE */
    wh_flow_side_t side;    /* of a pump: to which it went */
    int64_t begin_us, end_us;
} wh_flow_doing_t;

/* A process or a clean that goes on when the flow ends, in a station of times alone. */
typedef struct {
    int32_t place, wafer; /* wafer: in its process; WH_FLOW_NONE: a clean */
    int64_t begin_us;
} wh_flow_running_t;

typedef struct {
    wh_flow_running_t *items;
    size_t count, capacity;
} wh_flow_runnings_t;

/* A robot's way between two stations; one that takes no time is left out. */
typedef struct {
    int32_t robot, from, to;
    int64_t begin_us, end_us;
} wh_flow_way_t;

typedef struct {
    wh_flow_way_t *items; /* null: not asked for */
    size_t count, capacity;
} wh_flow_ways_t;

typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    wh_flow_result_t result;
    /* Sums in us, whole numbers up to 2^53: many places times many years would be too much for integers. */
    double (*robots)[WH_FLOW_ROBOT_CLASSES];     /* by robot */
    double (*stations)[WH_FLOW_STATION_CLASSES]; /* of all its places */
    double *blocked_by_robot;                    /* of WH_FLOW_STATION_BLOCKED, by station and robot */
    double *blocked_by_station;                  /* by station and station */
    size_t *placed;                              /* wafers placed, by station */
    wh_flow_stays_t stays;
    wh_flow_visit_t *visits; /* by the end of placing, at last those under way; none if not asked for */
    size_t visit_count, visit_capacity;
    wh_flow_fate_t *fates;   /* by wafer */
    int64_t *came_us;        /* by wafer: when it came to its first place, or WH_FLOW_NEVER; null likewise */
    wh_flow_doing_t *doings; /* by their ends; none if visits are not kept */
    size_t doing_count, doing_capacity;
    wh_flow_runnings_t running; /* likewise */
    wh_flow_ways_t ways;        /* none if not asked for */
    wh_flow_part_t *parts;      /* of the critical path, the longest first; none with the sums alone */
    size_t part_count;
    wh_flow_gain_t *gains; /* by robot, then by station; null if not asked for */
    uint64_t hash;         /* of all that was told, in its order */
    int64_t end_us;        /* up to which time is counted: the makespan, the cut, or when nobody went on */
} wh_flow_figures_t;

/* A flow that a run has played: it owns the plan. */
typedef struct {
    int line;         /* of the script */
    int64_t began_us; /* in a cell with axes: when it began; times of the figures count from then on */
    const wh_flow_tool_t *tool;
    bool is_played;        /* in a cell with axes, slice by slice */
    bool has_gains;        /* what less time of each robot and station brings is asked for */
    bool is_lateness_told; /* a stay beyond a window is told, and does not fail the run */
    bool asks_steady;      /* it was to end as soon as it is steady */
    wh_flow_plan_t plan;
    wh_flow_figures_t figures;
} wh_flow_t;

void wh_flow_close(wh_flow_t *flow);

/* True if it was played, and a wafer was placed. */
bool wh_flow_has_moved(const wh_flow_t *flow);

/* True if it was cut: wafers are not at their ends then. */
bool wh_flow_is_cut(const wh_flow_t *flow);

/* Kept beside the sums: */
typedef enum {
    WH_FLOW_VISITS, /* about 100 bytes for each placing; and the critical path, as below */
    WH_FLOW_WAYS,   /* likewise, and about 70 bytes for each way, which schedules and pages alone need */
    WH_FLOW_PATH,   /* the critical path alone; while the flow goes on, about 500 bytes for each placing */
    WH_FLOW_SUMS    /* nothing */
} wh_flow_keep_t;

/* wh_flow_play, with figures. Close them in any case. */
void wh_flow_measure(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan, wh_flow_keep_t keeps,
                     wh_flow_figures_t *figures);

/* Likewise instant by instant: open it, step its engine until that is over, close it. Closed before that it
 * has no result. All that is given must outlive it. */
typedef struct wh_flow_measure wh_flow_measure_t;
wh_flow_measure_t *wh_flow_measure_open(const wh_flow_tool_t *tool, const wh_flow_plan_t *plan,
                                        wh_flow_keep_t keeps, const wh_flow_outside_t *outside,
                                        wh_flow_figures_t *figures);
wh_flow_engine_t *wh_flow_measure_engine(wh_flow_measure_t *measure);
void wh_flow_measure_close(wh_flow_measure_t *measure);

void wh_flow_figures_close(wh_flow_figures_t *figures);

#endif
