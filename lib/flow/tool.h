/* A tool as its schedule sees it: stations that hold wafers and take time, robots that carry them. All
 * times are whole microseconds.
 *
 * What is real is played by somebody else, who tells when it has ended: see outside.h. The times of real
 * robots and doors are estimates, 0 until the first of a kind has ended.
 *
 * Stations have numbers from 0 on, in the layout's order; robots have numbers in the order of their names.
 * A place is one slot of one station; places are numbered through, station after station. */
#ifndef WH_FLOW_TOOL_H
#define WH_FLOW_TOOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* No station, place, wafer, robot, or step. */
#define WH_FLOW_NONE (-1)

/* A time that does not come. */
#define WH_FLOW_NEVER INT64_MAX

/* A failure's end that does not come, and whatever would come behind it. */
#define WH_FLOW_FOR_EVER (INT64_MAX / 2)

/* The most recipes of a tool, and the longest name of one, with its terminator. */
#define WH_FLOW_RECIPES 32
#define WH_FLOW_RECIPE_BYTES 64

/* The names of a tool's recipes. They have numbers from 1 on; 0 is none. */
typedef struct {
    char names[WH_FLOW_RECIPES][WH_FLOW_RECIPE_BYTES];
    int32_t count;
} wh_flow_recipes_t;

/* A station's times that go by recipe. */
typedef struct {
    int64_t process_us;  /* after each placing; 0: none */
    int64_t idle_us;     /* without a wafer, then a clean; WH_FLOW_NEVER: none */
    int32_t clean_after; /* wafers; 0: not by their number */
} wh_flow_treatment_t;

/* Two pressures, and what a robot or a slot without a side has. */
typedef enum { WH_FLOW_ATMOSPHERE, WH_FLOW_VACUUM, WH_FLOW_BOTH } wh_flow_side_t;

/* The pressures' words, in this order, and a null for WH_FLOW_BOTH, which also ends the list. */
extern const char *const wh_flow_side_words[];

/* The work on a wafer in a step, beside its process. In cells with axes alone. */
typedef enum {
    WH_FLOW_WORK_NONE,
    WH_FLOW_WORK_ALIGN, /* the station's own chuck aligns it */
    WH_FLOW_WORK_FLIP   /* the station's own clamp turns it over */
} wh_flow_work_t;

typedef struct {
    char *name;
    int32_t slots, first_place;
    int64_t process_us;  /* after each placing; 0: none */
    int64_t window_us;   /* the longest stay after a process; WH_FLOW_NEVER: any */
    int32_t clean_after; /* wafers; 0: not by their number */
    int64_t clean_us;
    bool
        cleans_full; /* the clean after wafers comes at the end of the last process, with that wafer inside */
    int64_t idle_us; /* without a wafer, then a clean; WH_FLOW_NEVER: none */
    bool has_recipes; /* `by_recipe` counts, with number 1 first */
    wh_flow_treatment_t by_recipe[WH_FLOW_RECIPES];
    bool is_lock, is_load_port;
    bool has_carriers;         /* a load port to which carriers come in steps that take time */
    bool is_absent;            /* none of them is there at the beginning */
    bool is_real_port;         /* somebody else tells when they have come and gone */
    int64_t comes_us, goes_us; /* of timed ones: until it is open and mapped; until it is gone */
    bool is_real;              /* its processes, cleans and pumps are told from outside */
    wh_flow_work_t works;      /* its own chuck or clamp can do this; else WH_FLOW_WORK_NONE */
    int32_t less_ppm;          /* processes of steps, too, take so much less: see wh_flow_shorten */
    int64_t off_us;            /* processes of steps, too, are longer by this: see wh_flow_lengthen */
    wh_flow_side_t side;       /* of a lock, at the beginning */
    int64_t pump_us[2], empty_pump_us[2]; /* to atmosphere, to vacuum; without a wafer */
} wh_flow_station_t;

typedef struct {
    char *name;
    int32_t arms;       /* 1 or 2 */
    int32_t at;         /* the station in front of which it stands at the beginning; real: or WH_FLOW_NONE */
    bool is_at_assumed; /* nobody says where: at the first one that it serves */
    bool is_real;
    int32_t number; /* in a cell with axes: among the layout's robots, or its timed ones */
} wh_flow_robot_t;

typedef struct {
    int64_t open_us, close_us;
    bool is_real;
    int32_t number; /* real: the layout's */
} wh_flow_door_t;

/* Step 0 of a route is where the lot lies at first; its steps count from 1 on. */
typedef struct {
    int32_t *stations; /* parallel ones, as listed */
    size_t station_count;
    int64_t process_us; /* WH_FLOW_NONE: that of the station */
    int32_t recipe;     /* by which it processes all wafers; 0: by theirs */
    int32_t kept_empty; /* places of the step that stay empty */
    bool second_arm;    /* the second arm alone takes out of it */
    wh_flow_work_t work;
    double align_deg; /* where the notch points then */
    bool centres;     /* beams centre it on its way in */
    bool maps;        /* the robot that has brought it maps the station */
} wh_flow_step_t;

typedef struct {
    char *name;
    wh_flow_step_t *steps; /* steps[0] is empty */
    size_t step_count;     /* with step 0 */
    size_t first_step;     /* the index of its step 0 among the steps of all routes */
} wh_flow_route_t;

/* Rows by robot, then by station: see wh_flow_of. */
typedef struct {
    wh_flow_station_t *stations;
    wh_flow_robot_t *robots;
    size_t station_count, robot_count, place_count;
    int64_t *pick_us, *place_us, *swap_us;
    wh_flow_door_t *doors;
    bool *serves;
    wh_flow_side_t *sides;      /* where this robot meets this station */
    int64_t *move_us;           /* by robot, station from, station to */
    int32_t *place_stations;    /* by place */
    wh_flow_side_t *slot_sides; /* by place: the side whose robots may bring a wafer there */
    wh_flow_recipes_t recipes;
    wh_flow_route_t *routes; /* by which wafers go; flows have their own */
    size_t route_count;
} wh_flow_tool_t;

/* Makes room for so many robots and stations. Names are null, times are 0, no robot serves a station, each
 * station has one slot. Close it in any case. */
void wh_flow_tool_open(wh_flow_tool_t *tool, size_t robot_count, size_t station_count);
void wh_flow_tool_close(wh_flow_tool_t *tool);

/* Frees what the route holds. */
void wh_flow_route_close(wh_flow_route_t *route);

/* True if the step has this station. */
static inline bool wh_flow_step_has(const wh_flow_step_t *step, int32_t station) {
    for (size_t i = 0; i < step->station_count; ++i) {
        if (step->stations[i] == station) {
            return true;
        }
    }
    return false;
}

/* A tool of its own, equal to a numbered one, but without its routes. */
void wh_flow_tool_copy(wh_flow_tool_t *copy, const wh_flow_tool_t *tool);

/* A time that is less by so many millionths, up to 999,999, rounded to the next microsecond. */
static inline int64_t wh_flow_less_us(int64_t us, int32_t ppm) {
    return us - us / 1000000 * ppm - (us % 1000000 * ppm + 500000) / 1000000;
}

/* Each time of one robot (its moves, picks, places, swaps), or of one station (its processes, in any route,
 * cleans, pumps and doors), takes so many millionths less. The other one is WH_FLOW_NONE. */
void wh_flow_shorten(wh_flow_tool_t *tool, int32_t robot, int32_t station, int32_t ppm);

/* Each process of a station, in any route, takes so much longer, or shorter; at least 1 us is left. */
void wh_flow_lengthen(wh_flow_station_t *station, int64_t us);

/* To be called once after each station has its number of slots: numbers the places. */
void wh_flow_tool_number(wh_flow_tool_t *tool);

/* The index of a robot and a station in pick_us, place_us, swap_us, doors, serves and sides. */
static inline size_t wh_flow_of(const wh_flow_tool_t *tool, int32_t robot, int32_t station) {
    return (size_t)robot * tool->station_count + (size_t)station;
}

/* How long a robot takes from one station to another; 0 if they are the same one, or if it stands nowhere. */
static inline int64_t wh_flow_move_us(const wh_flow_tool_t *tool, int32_t robot, int32_t from, int32_t to) {
    return from == to || from == WH_FLOW_NONE
               ? 0
               : tool->move_us[wh_flow_of(tool, robot, from) * tool->station_count + (size_t)to];
}

/* True if any robot of the tool is real. */
bool wh_flow_has_real(const wh_flow_tool_t *tool);

/* True if a robot that is times alone serves the station, and its number then. */
bool wh_flow_is_timed_at(const wh_flow_tool_t *tool, int32_t station, int32_t *robot);

/* True if a robot of the one side may use what is for the other. */
static inline bool wh_flow_sides_agree(wh_flow_side_t a, wh_flow_side_t b) {
    return a == WH_FLOW_BOTH || b == WH_FLOW_BOTH || a == b;
}

/* How a station treats wafers of a recipe, 0: of none. */
static inline wh_flow_treatment_t wh_flow_treatment(const wh_flow_station_t *station, int32_t recipe) {
    const wh_flow_treatment_t usual = {station->process_us, station->idle_us, station->clean_after};
    return recipe > 0 && station->has_recipes ? station->by_recipe[recipe - 1] : usual;
}

/* True if a clean by the number of wafers is due when one more, of this recipe, has been in a place, in which
 * `since_clean` have been since its last clean. */
static inline bool wh_flow_is_clean_due(const wh_flow_station_t *station, int32_t recipe,
                                        int32_t since_clean) {
    const int32_t after = wh_flow_treatment(station, recipe).clean_after;
    return after > 0 && since_clean + 1 >= after;
}

/* True if the station is ever cleaned. */
bool wh_flow_is_cleaned(const wh_flow_station_t *station);

/* True if the station processes wafers of any recipe. */
bool wh_flow_is_processing(const wh_flow_station_t *station);

/* How long a wafer of this recipe is processed in this station in this step of its route. */
static inline int64_t wh_flow_step_us(const wh_flow_step_t *step, const wh_flow_station_t *station,
                                      int32_t recipe) {
    const int64_t own_us = step->process_us;
    if (own_us == WH_FLOW_NONE) {
        return wh_flow_treatment(station, step->recipe > 0 ? step->recipe : recipe).process_us;
    }
    const int64_t us = wh_flow_less_us(own_us, station->less_ppm) + station->off_us;
    return own_us <= 0 ? own_us : us > 1 ? us : 1;
}

/* The number of the recipe of this name; 0: there is none. */
int32_t wh_flow_recipe_named(const wh_flow_recipes_t *recipes, const char *name);

/* Each process by recipe takes so many millionths less. */
void wh_flow_hasten_recipes(wh_flow_station_t *station, int32_t ppm);

/* Continues a hash with what goes by recipe; it is the same if nothing does. */
uint64_t wh_flow_hash_recipes(const wh_flow_station_t *station, uint64_t hash);

/* How long a lock takes to this side. */
static inline int64_t wh_flow_pump_us(const wh_flow_station_t *station, wh_flow_side_t to, bool is_empty) {
    return is_empty ? station->empty_pump_us[to] : station->pump_us[to];
}

/* The number of the station or robot of this name, or WH_FLOW_NONE. */
int32_t wh_flow_station_named(const wh_flow_tool_t *tool, const char *name);
int32_t wh_flow_robot_named(const wh_flow_tool_t *tool, const char *name);

/* Continues a hash with all that the tool's description says. */
uint64_t wh_flow_tool_hash(const wh_flow_tool_t *tool, uint64_t hash);

/* The slot of a place in its station, from 1 on. */
static inline int32_t wh_flow_slot(const wh_flow_tool_t *tool, int32_t place) {
    return place - tool->stations[tool->place_stations[place]].first_place + 1;
}

#endif
