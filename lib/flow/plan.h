/* The plan of a flow: lots, their routes, and the rule by which robots choose. */
#ifndef WH_FLOW_PLAN_H
#define WH_FLOW_PLAN_H

#include "tool.h"

typedef struct {
    char *name;
    int32_t lot, home; /* home: a place */
    int32_t back;      /* the place where it ends, or WH_FLOW_NONE: the best of the last step */
    int32_t back_station;
    bool goes_back;  /* that is one more step, behind those of its route */
    int32_t recipe;  /* its number; 0: none */
    bool is_skipped; /* it is left where it lies: its carrier brought it so that nobody may take it */
} wh_flow_wafer_t;

typedef struct {
    char *name;
    int32_t route, priority;
    int64_t arrives_us;
    size_t first_wafer, wafer_count;
    bool is_dummy;   /* its wafers are moved, and not counted */
    bool is_mapped;  /* a real robot maps the station before it takes the first one */
    int32_t carrier; /* of a cell with axes: its number in the layout, from 1; 0: none is said */
    bool leaves;     /* its carrier goes away when it is over */
    int32_t call;    /* the number of that carrier's call, from 1; 0: it comes without */
} wh_flow_lot_t;

/* A carrier's stay at a load port, with one lot or several: those that come there at one time; in a cell with
 * axes those of one carrier. */
typedef struct {
    int32_t station, carrier; /* carrier: as of a lot; 0: the one that is there, or that comes */
    int64_t arrives_us;       /* of the first lot */
    bool leaves;
    bool is_there; /* at the beginning, and open */
} wh_flow_call_t;

/* A station that fails, or a robot that is held: it ends what it has begun, and begins nothing meanwhile. */
typedef struct {
    int32_t station;
    int64_t at_us, for_us; /* for_us: WH_FLOW_FOR_EVER if it never works again; of a station alone */
    int32_t robot;         /* WH_FLOW_NONE: it is a station */
} wh_flow_down_t;

typedef enum { WH_FLOW_TRANSFER, WH_FLOW_KEEP, WH_FLOW_BRING, WH_FLOW_SWAP, WH_FLOW_PUMP } wh_flow_do_t;

/* A line of a robot's list. */
typedef struct {
    wh_flow_do_t what;
    int32_t from, to; /* stations; the lock is `to` */
    int32_t wafer;    /* WH_FLOW_NONE: the first that entered, or was kept; see wh_flow_plan_t's `asked` */
    wh_flow_side_t side;
    int32_t out;    /* of a swap: the wafer that comes out */
    int32_t slot;   /* to which a wafer is brought; 0: any */
    int32_t behind; /* so many picks, places and swaps of the station come first */
} wh_flow_line_t;

/* A line's wafer until it is known: the number of its name. It is its own inverse. */
#define WH_FLOW_ASKED(number) (-2 - (number))

/* A transfer from nowhere to nowhere. */
#define WH_FLOW_NO_LINE                                                                                      \
    (wh_flow_line_t) {                                                                                       \
        WH_FLOW_TRANSFER, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_BOTH, WH_FLOW_NONE, 0, 0         \
    }

typedef struct {
    wh_flow_line_t *lines;
    size_t count, capacity;
} wh_flow_list_t;

typedef struct {
    char **items;
    size_t count, capacity;
} wh_flow_names_t;

/* A lock's turn behind so many picks, places and swaps in it. */
typedef struct {
    wh_flow_side_t side;
    int32_t behind;
} wh_flow_turn_t;

typedef struct {
    wh_flow_turn_t *turns;
    size_t count, capacity;
} wh_flow_turns_t;

typedef enum {
    WH_FLOW_BACKWARD,
    WH_FLOW_SWAPPING,
    WH_FLOW_FIRST_COME,
    WH_FLOW_LONGEST_WAIT,
    WH_FLOW_LISTS,
    WH_FLOW_OWN,
} wh_flow_rule_t;

struct wh_flow_state;

/* How many answers of a rule of the user's are looked at. */
#define WH_FLOW_ANSWERS 16

/* A rule of the user's: fills at most WH_FLOW_ANSWERS lines (transfers, "keep" and from there) for the
 * robot, the best one first, and returns their number. The first that can begin as soon as the robot is
 * there is carried out; if none can, the robot goes ahead to the first. A negative number ends the flow;
 * `why`, by malloc, tells why. */
typedef int (*wh_flow_own_rule_t)(void *context, const struct wh_flow_state *state, int32_t robot,
                                  wh_flow_line_t lines[], char **why);

/* Something that goes wrong on the way. */
typedef struct {
    enum { WH_FLOW_LATE, WH_FLOW_FAILS } what; /* a stay beyond a window; a station fails, or a robot */
    int32_t robot, wafer;                      /* of a stay: who takes which; else WH_FLOW_NONE */
    int32_t station;                           /* WH_FLOW_NONE: the robot is held */
    int64_t us;                                /* beyond the window; how long it will be down */
} wh_flow_problem_t;

/* Hears of each problem at its instant. Returns null, or why the flow ends, by malloc. */
typedef char *(*wh_flow_on_problem_t)(void *context, const struct wh_flow_state *state,
                                      const wh_flow_problem_t *problem);

typedef struct {
    wh_flow_route_t *routes;
    size_t route_count, step_count; /* of all routes together, with a way back for each */
    wh_flow_step_t *backs;          /* by station: the step back to it */
    wh_flow_lot_t *lots;            /* by arrival */
    size_t lot_count;
    wh_flow_call_t *calls; /* in the order in which their lots arrive */
    size_t call_count;
    wh_flow_wafer_t *wafers; /* lot after lot */
    size_t wafer_count;
    wh_flow_down_t *downs;
    size_t down_count;
    wh_flow_rule_t rule;
    wh_flow_list_t *lists;  /* by robot, for WH_FLOW_LISTS */
    wh_flow_names_t asked;  /* in lists, whose wafers are not known yet: WH_FLOW_ASKED stands for each */
    wh_flow_turns_t *turns; /* by station, of locks that turn by a list of their own; null: none does */
    bool is_given;          /* each step was carried out by somebody, from a station into itself as well */
    wh_flow_own_rule_t own;
    wh_flow_on_problem_t on_problem; /* may be null */
    void *own_context;               /* of both */
    int64_t until_us;                /* WH_FLOW_NEVER: until all wafers are there */
    bool ends_steady;                /* it is cut as soon as it is steady: see steadily.h */
    int64_t takt_us;                 /* the least time between two wafers' starts */
    bool is_safe; /* shipped rules leave out transfers after which wafers could block each other */
} wh_flow_plan_t;

/* The plan is zero, or filled by what frees like this: all arrays and names by malloc. */
void wh_flow_plan_close(wh_flow_plan_t *plan, const wh_flow_tool_t *tool);

/* To be called once when all is filled: numbers the steps, finds the ways back and the calls of carriers.
 * Returns null, or what is wrong, to be freed by the caller: a wafer that no robot can carry on, two wafers
 * in one place, a step whose places are all kept empty, the same station twice in succession, a process in
 * the last step, a step at a load port to which no carrier comes. */
char *wh_flow_plan_finish(wh_flow_plan_t *plan, const wh_flow_tool_t *tool);

/* True if the robot serves one of the step's stations. */
bool wh_flow_step_is_served(const wh_flow_tool_t *tool, const wh_flow_step_t *step, int32_t robot);

/* True if none before it comes to its station. */
bool wh_flow_is_first_call(const wh_flow_plan_t *plan, const wh_flow_call_t *call);

static inline int32_t wh_flow_priority(const wh_flow_plan_t *plan, int32_t wafer) {
    return plan->lots[plan->wafers[wafer].lot].priority;
}

static inline const wh_flow_route_t *wh_flow_route_of(const wh_flow_plan_t *plan, int32_t wafer) {
    return &plan->routes[plan->lots[plan->wafers[wafer].lot].route];
}

/* The number of the wafer's last step. */
static inline int32_t wh_flow_last_step(const wh_flow_plan_t *plan, int32_t wafer) {
    return (int32_t)wh_flow_route_of(plan, wafer)->step_count - (plan->wafers[wafer].goes_back ? 0 : 1);
}

/* A step of the wafer's route, or that of its way back. Step 0 has no stations. */
static inline const wh_flow_step_t *wh_flow_step_of(const wh_flow_plan_t *plan, int32_t wafer, int32_t step) {
    const wh_flow_route_t *route = wh_flow_route_of(plan, wafer);
    return (size_t)step < route->step_count ? &route->steps[step]
                                            : &plan->backs[plan->wafers[wafer].back_station];
}

/* The recipe by which the wafer is processed in this step, 0: by none. */
int32_t wh_flow_recipe_of(const wh_flow_plan_t *plan, int32_t wafer, int32_t step);

/* The place where the wafer must end, if this step of its route is the last one and `back` is given; else
 * WH_FLOW_NONE. */
static inline int32_t wh_flow_end_of(const wh_flow_plan_t *plan, int32_t wafer, int32_t step) {
    return step == wh_flow_last_step(plan, wafer) ? plan->wafers[wafer].back : WH_FLOW_NONE;
}

#endif
