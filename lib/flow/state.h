/* A tool at an instant: who is where, what runs, and what is known of its end. The engine alone changes
 * it; rules read it. */
#ifndef WH_FLOW_STATE_H
#define WH_FLOW_STATE_H

#include "plan.h"

typedef struct {
    int32_t wafer;       /* that lies there, or WH_FLOW_NONE */
    int32_t coming;      /* whose transfer to here has begun, or WH_FLOW_NONE */
    int64_t empty_us;    /* since when it is empty; below 0: always */
    int64_t leaving_us;  /* the end of a pick out of it that has begun, or WH_FLOW_NEVER */
    int64_t clean_us;    /* the end of a clean that runs, or WH_FLOW_NEVER */
    int64_t idle_us;     /* when a clean is due because no wafer came, or WH_FLOW_NEVER */
    int32_t since_clean; /* wafers */
    int32_t owner;       /* the lot of a wafer that ends here: from its coming until the lot is over */
    bool is_clean_due;
    int32_t recipe; /* of the wafer that lies there, or lay there last */
} wh_flow_place_t;

/* Real things in a station: its door shuts behind a robot, or before the first one; a wafer is worked on. */
typedef struct {
    bool is_shutting, has_shut, has_worked, runs;
    int32_t shutter, work_wafer;  /* that robot; that wafer */
    int64_t shutting_us, work_us; /* since when */
    int64_t closed_us;            /* when something began there behind shut doors */
    bool is_port_shut;            /* a load port that is not open */
    bool has_carrier;             /* one stands there, comes or goes */
} wh_flow_station_real_t;

/* A carrier's call. */
typedef enum {
    WH_FLOW_CALL_AWAITED,
    WH_FLOW_CALL_COMING,
    WH_FLOW_CALL_THERE, /* open, and its wafers are known */
    WH_FLOW_CALL_GOING,
    WH_FLOW_CALL_GONE
} wh_flow_call_phase_t;

typedef struct {
    wh_flow_call_phase_t phase;
    int64_t since_us, until_us; /* of coming and going; until: WH_FLOW_NEVER of real ones */
    bool is_told;               /* a real one has come, or gone */
} wh_flow_call_state_t;

typedef struct {
    int32_t user;     /* the robot whose blade is in it or next, or WH_FLOW_NONE */
    int64_t shut_us;  /* until then its door shuts */
    int64_t busy_us;  /* the end of the access that runs, its door shut again */
    int64_t clean_us; /* the end of the clean that ends next in its places, or WH_FLOW_NEVER */
    int64_t idle_us;  /* the next time at which one is due because no wafer came, or WH_FLOW_NEVER */
    int64_t down_began_us;
    int64_t down_us; /* the end of a failure, or WH_FLOW_NEVER */
    int64_t pump_us; /* the end of pumping, or WH_FLOW_NEVER */
    int64_t pump_began_us;
    int64_t done_us; /* the end of the process that ends next, or WH_FLOW_NEVER */
    wh_flow_side_t side, pump_to;
    bool is_listed;   /* a lock that lists turn */
    uint64_t changes; /* of whether a blade may enter, and of what lies there */
    int32_t wafers;
    int32_t accesses;              /* picks, places and swaps that have ended */
    int32_t turned;                /* turns of its own list that have begun */
    bool has_due;                  /* one of its places must be cleaned, and is not yet */
    bool is_aside;                 /* as the last instant ended it was cleaned, pumped or had failed */
    int32_t call;                  /* the number, from 1, of the carrier's call that goes on; 0: none does */
    int64_t change_us, changed_us; /* a full carrier is changed for an empty one: since when, until when, or
                                    * WH_FLOW_NEVER */
    wh_flow_station_real_t real;
} wh_flow_station_state_t;

typedef struct {
    int32_t place, robot, arm; /* where it is; WH_FLOW_NONE else */
    int32_t taker;             /* the robot that takes it or has it; WH_FLOW_NONE: it lies */
    int32_t step;              /* in which it counts, or from which it comes */
    int64_t entered_us;        /* when it was placed there */
    int64_t done_us;           /* from then on it may be taken; WH_FLOW_NEVER: not known yet */
    int64_t process_us;        /* how long its process takes there */
    int64_t clean_us;          /* how long its place is cleaned around it before that, after its process */
    int32_t next, before;      /* in its step, by the time of entering */
    int32_t heading;           /* swap: the place, perhaps a full one, for which a robot has taken it */
    int32_t toward;            /* the step in which it counts already, or WH_FLOW_NONE */
    bool is_moving;            /* its transfer has begun */
    bool is_over, is_lost;     /* lost: in a station that failed, or on an arm with nowhere to go */
} wh_flow_wafer_state_t;

typedef enum {
    WH_FLOW_IDLE,
    WH_FLOW_MOVING,  /* empty, to `station` */
    WH_FLOW_OPENING, /* the door for a pick, a place or a swap that is next */
    WH_FLOW_PICKING,
    WH_FLOW_CARRYING, /* to `station` */
    WH_FLOW_WAITING,  /* in front of the place with the wafer */
    WH_FLOW_PLACING,
    WH_FLOW_SWAPS,
} wh_flow_action_t;

/* A rule's answer. */
typedef struct wh_flow_order {
    wh_flow_do_t what;
    int32_t wafer;   /* to be taken, or to be brought; WH_FLOW_NONE: it is not there yet */
    int32_t at;      /* the station in front of which the robot must stand for it */
    int32_t station; /* of its next step; WH_FLOW_NONE: the best one */
    int32_t place;   /* likewise, or of the wafer to swap against */
    int32_t onward;  /* of a swap: where the wafer that comes out goes next */
    int32_t mark;    /* of the rule: see wh_flow_robot_state_t */
    wh_flow_side_t side;
} wh_flow_order_t;

/* A robot that a request holds: see held.h. */
typedef struct {
    bool is_wanted, is_told; /* told since the last instant: a request stands; it stands within its action */
    bool is_on, stands;      /* likewise, as this instant has it */
    int64_t since_us;        /* it stands since then */
    int64_t stood_us;        /* how long it had stood before, in this action */
    int64_t planned_us;      /* until then the plan holds it, too */
} wh_flow_asked_t;

/* A robot that waits for a station alone: it need not be asked before that has changed. */
typedef struct {
    int32_t station; /* WH_FLOW_NONE: it waits for nothing, or for more than that */
    uint64_t changes;
} wh_flow_kept_out_t;

typedef struct {
    wh_flow_action_t action, then; /* then: what comes after the door */
    int64_t since_us, until_us;    /* of the action; until: WH_FLOW_NEVER for those that wait */
    int32_t station;               /* where it stands or goes */
    wh_flow_order_t order;         /* carried out now */
    int32_t from, to, arm;         /* of the transfer: places, and the arm in use */
    int32_t arms[2];               /* wafers, or WH_FLOW_NONE */
    int64_t kept_us[2];
    int32_t mark;     /* backward: where the round goes on; lists: the next line */
    int32_t possible; /* lists: the line of which it is known that it can be carried out, or WH_FLOW_NONE */
    uint64_t possible_at; /* the state's changes then */
    wh_flow_order_t wish; /* the first answer of the rule when it was asked last */
    bool has_wish;
    int64_t held_us, held_began_us; /* until then, and since when, it begins nothing; 0: it is not held */
    wh_flow_asked_t asked;          /* by a request, for as long as that stands */
    /* Real ones: the action has begun, and nobody has taken it up yet; it has ended, and that was told. */
    bool is_begun, is_ended;
    wh_flow_kept_out_t kept_out;
} wh_flow_robot_state_t;

typedef enum {
    WH_FLOW_EVENT_MOVE,
    WH_FLOW_EVENT_OPEN,
    WH_FLOW_EVENT_PICK,
    WH_FLOW_EVENT_PLACE,
    WH_FLOW_EVENT_SWAP,
    WH_FLOW_EVENT_PROCESS,
    WH_FLOW_EVENT_CLEAN,
    WH_FLOW_EVENT_PUMP,
    WH_FLOW_EVENT_DOWN,
    WH_FLOW_EVENT_STAY,  /* of what is done in a place, up to the pick */
    WH_FLOW_EVENT_SHUT,  /* a real door */
    WH_FLOW_EVENT_LEFT,  /* a stay in a real station: until the wafer was lifted */
    WH_FLOW_EVENT_HELD,  /* a robot began nothing */
    WH_FLOW_EVENT_ENDS,  /* a route ends where its wafer lies, because of stations that have failed */
    WH_FLOW_EVENT_COMES, /* a carrier, until it is open and mapped */
    WH_FLOW_EVENT_GOES,  /* from its closing until it is gone */
} wh_flow_event_kind_t;

/* One thing that took time, told when it has ended, so by the order of the ends. */
typedef struct {
    wh_flow_event_kind_t kind;
    wh_flow_side_t side; /* here, the struct has no gaps: long flows keep many of them */
    int64_t begin_us, end_us;
    int32_t robot, arm, wafer, other; /* other: what a swap brought in */
    int32_t place, station, from;     /* from: the station that a move comes from */
    int32_t step;
    int64_t stood_us; /* of an action: so long it stood still, since a request held its robot */
} wh_flow_event_t;

/* The listener of a flow. Each may be null. */
typedef struct {
    void *context;
    void (*event)(void *context, const struct wh_flow_state *state, const wh_flow_event_t *event);
    void (*advance)(void *context, const struct wh_flow_state *state,
                    int64_t to_us); /* before time goes on */
    void (*end)(void *context, const struct wh_flow_state *state);
} wh_flow_listener_t;

/* The player of all that is real. */
typedef struct {
    void *context;
    /* Tells what real stations have done up to this instant, before robots end. */
    void (*hear)(void *context, struct wh_flow_state *state);
    /* Robots have ended: sees how real stations stand. */
    void (*look)(void *context, struct wh_flow_state *state);
    /* A lock that nobody uses is to pump. False: it cannot begin yet. */
    bool (*pump)(void *context, int32_t station, wh_flow_side_t side);
    /* From now on nothing begins in the station, or it may again. */
    void (*down)(void *context, int32_t station, bool is_down);
    wh_flow_tool_t *tool; /* the same one: receives the times of what was played */
    int64_t slice_us;     /* what ends by itself ends with a slice */
} wh_flow_outside_t;

/* The next things of the plan. */
typedef struct {
    size_t lot, down; /* their indices in the plan; all lots before this one are there */
    int64_t start_us; /* by takt */
    int32_t wafer;    /* all before this one are over */
} wh_flow_next_t;

/* The places into which a wafer comes, in no order. */
typedef struct {
    int32_t *places;
    size_t count;
} wh_flow_coming_t;

/* All that has failed for ever: stations, and wafers that are lost by that. */
typedef struct {
    size_t stations, wafers;
} wh_flow_failures_t;

/* Stations by what may happen in them. */
typedef struct {
    int64_t *next_us; /* of each, as the last instant ended: when something ends next, or never; 0: touched */
    int64_t soonest_us; /* the least of them */
    int32_t *touched;   /* those whose times have changed since */
    size_t touched_count;
    int32_t *aside; /* those that are aside, in no order */
    size_t aside_count;
    int32_t *acting; /* locks that no list turns, and those that are cleaned */
    size_t acting_count;
} wh_flow_ahead_t;

/* Carriers and their lots. */
typedef struct {
    wh_flow_call_state_t *of; /* by call */
    bool *has_come;           /* by lot */
    size_t skipped;           /* wafers that were left where they lie */
    bool are_there;           /* some station is one to which carriers come, or one calls */
} wh_flow_calls_t;

typedef struct wh_flow_state {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    int64_t now_us;
    wh_flow_place_t *places;
    wh_flow_station_state_t *stations;
    wh_flow_robot_state_t *robots;
    wh_flow_wafer_state_t *wafers;
    wh_flow_ahead_t ahead;
    wh_flow_calls_t calls;
    int32_t *counts;        /* by step: from the begin of the transfer in to the end of the pick out */
    int32_t *leaving;       /* by step: those of them whose pick out runs */
    int32_t *heads, *tails; /* by step: the wafers that lie there */
    wh_flow_coming_t coming;
    struct wh_flow_safety *safety; /* see safe.h */
    uint64_t changes;              /* of where wafers are, and where they go */
    wh_flow_next_t next;
    size_t over; /* wafers at their end, lost ones with them */
    wh_flow_failures_t failures;
    int64_t last_us; /* the end of the last placing */
    wh_flow_listener_t listener;
    const wh_flow_outside_t *outside; /* null: nothing is real */
    bool checks_safety; /* rules leave out transfers after which wafers could block each other */
    bool is_relaxed;    /* nobody could go on: shipped rules wait for no fuller step now */
    char *cause;        /* why the flow ended early, or null; freed by wh_flow_state_close */
} wh_flow_state_t;

/* A blade may enter the station now, or may no longer, or other wafers lie there. */
static inline void wh_flow_stir(wh_flow_state_t *state, int32_t station) {
    ++state->stations[station].changes;
}

/* Likewise, and its times have changed. */
static inline void wh_flow_touch(wh_flow_state_t *state, int32_t station) {
    wh_flow_ahead_t *ahead = &state->ahead;
    wh_flow_stir(state, station);
    if (ahead->next_us[station] != 0) {
        ahead->next_us[station] = 0;
        ahead->touched[ahead->touched_count++] = station;
    }
}

/* The tool's beginning. The tool and the plan must outlive the state; the plan must be finished. */
void wh_flow_state_open(wh_flow_state_t *state, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan);
void wh_flow_state_close(wh_flow_state_t *state);

/* The index of a wafer's step in counts, heads and tails. */
static inline size_t wh_flow_step_index(const wh_flow_state_t *state, int32_t wafer, int32_t step) {
    return wh_flow_route_of(state->plan, wafer)->first_step + (size_t)step;
}

/* One more wafer is over, which its state says already. */
void wh_flow_note_over(wh_flow_state_t *state);

/* Puts the wafer behind all others of its step, or takes it out. */
void wh_flow_step_enter(wh_flow_state_t *state, int32_t wafer);
void wh_flow_step_leave(wh_flow_state_t *state, int32_t wafer);

/* This wafer comes into the place now; WH_FLOW_NONE: no wafer does. */
void wh_flow_come(wh_flow_state_t *state, int32_t place, int32_t wafer);

/* The next wafer behind this one in a step's list, WH_FLOW_NONE for the first, which lies there and nobody
 * has begun to take. A lot's wafers in their first places want the same: one stands for all, unless each
 * has a place of its own to go to. */
int32_t wh_flow_next_in(const wh_flow_state_t *state, size_t step, int32_t wafer);

/* Ties of rules: below 0 if the first wafer wins by priority, the later step, or its entering; above 0 if
 * the other one does; 0 if neither. */
int wh_flow_compare(const wh_flow_state_t *state, int32_t a, int32_t b);

/* How many wafers of arrived lots are still to come into this step of the route: they are before it. */
int32_t wh_flow_still_to_come(const wh_flow_state_t *state, int32_t route, int32_t step);

/* The arm that is free to take from the wafer's step, or WH_FLOW_NONE. */
int32_t wh_flow_free_arm(const wh_flow_state_t *state, int32_t robot, int32_t wafer);

/* True if a clean by the number of wafers is due when one more has been in the place. */
static inline bool wh_flow_is_clean_next(const wh_flow_state_t *state, int32_t place) {
    return wh_flow_is_clean_due(&state->tool->stations[state->tool->place_stations[place]],
                                state->places[place].recipe, state->places[place].since_clean);
}

/* True if such a clean begins as soon as the place's wafer is out of it. */
static inline bool wh_flow_is_clean_behind(const wh_flow_state_t *state, int32_t place) {
    return !state->tool->stations[state->tool->place_stations[place]].cleans_full &&
           wh_flow_is_clean_next(state, place);
}

/* The station in whose place the wafer lies, or WH_FLOW_NONE. */
static inline int32_t wh_flow_station_of(const wh_flow_state_t *state, int32_t wafer) {
    const int32_t place = state->wafers[wafer].place;
    return place == WH_FLOW_NONE ? WH_FLOW_NONE : state->tool->place_stations[place];
}

/* An event of a wafer in the place where it lies, from `begin_us` until now; without a robot. */
wh_flow_event_t wh_flow_event_at(const wh_flow_state_t *state, wh_flow_event_kind_t kind, int32_t wafer,
                                 int64_t begin_us);

/* The stay up to now of a wafer that lies processed in its place, and which nobody has begun to take. False
 * if it does not, or is at its end, or in its first place. */
bool wh_flow_open_stay(const wh_flow_state_t *state, int32_t wafer, wh_flow_event_t *stay);

/* How long a wafer has stayed since its process ended, with the clean around it, if there is one. Ask before
 * it is placed elsewhere. */
int64_t wh_flow_stay_us(const wh_flow_state_t *state, const wh_flow_event_t *stay);

/* How much longer than its station's window that is; below 0: it is not. */
int64_t wh_flow_over_window_us(const wh_flow_state_t *state, const wh_flow_event_t *stay);

/* The end of the slice in which this time is; the time itself where no slices are stepped. */
static inline int64_t wh_flow_slice_us(const wh_flow_state_t *state, int64_t us) {
    const int64_t slice_us = state->outside ? state->outside->slice_us : 1;
    return us >= WH_FLOW_FOR_EVER ? us : (us + slice_us - 1) / slice_us * slice_us;
}

/* Tells the plan's own function, if there is one; it may end the flow. */
void wh_flow_tell_problem(wh_flow_state_t *state, const wh_flow_problem_t *problem);

/* An event at a station, or at none: without robot, wafer, place and the station where it began. */
wh_flow_event_t wh_flow_event_of_station(wh_flow_event_kind_t kind, int32_t station, int64_t begin_us,
                                         int64_t end_us);

/* Tells the listener, if there is one. */
void wh_flow_tell(const wh_flow_state_t *state, const wh_flow_event_t *event);

#endif
