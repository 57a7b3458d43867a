/* The clockwork of one station that takes time in a cell with axes, stepped slice by slice. It goes by the
 * same description as a flow's station: tool.h. A flow knows the end of each process in advance; here a
 * slice passes, and a fault may make it slow.
 *
 * A process begins when the wafer lies there well, no blade is in the station and its doors are shut. It ends
 * with the first slice that ends so long after it, or later: times are rounded up to the slice. A clean is
 * due when the last of its wafers has left, and begins like a process. Each place has its own process and
 * its own clean.
 *
 * A wafer that is lifted has not left: if it comes to lie in its place again, its stay goes on. Once it has
 * left, its stay has lasted until it was lifted for the last time.
 *
 * It allocates nothing. All that it depends on is in wh_clock_t and in the places, which are plain data. */
#ifndef WH_FLOW_CLOCK_H
#define WH_FLOW_CLOCK_H

#include "tool.h"

typedef enum {
    WH_CLOCK_FREE,       /* empty */
    WH_CLOCK_WAITING,    /* a wafer lies there, its process has not begun */
    WH_CLOCK_PROCESSING, /* its process runs */
    WH_CLOCK_CLEANING,   /* without a wafer, or after the process with it inside */
    WH_CLOCK_DONE        /* a wafer lies there that may be taken */
} wh_clock_phase_t;

/* One slot. */
typedef struct {
    wh_clock_phase_t phase;
    int32_t wafer;       /* that has come and not left, or WH_FLOW_NONE */
    int32_t since_clean; /* wafers that have left it since */
    bool is_clean_due;
    bool is_around;          /* CLEANING: around the wafer that was processed there */
    bool is_away;            /* the wafer was lifted or moved, and has not left the station */
    bool is_bad;             /* it lies there, but not so that a process may begin */
    bool is_cut;             /* WAITING: its process had begun, and was cut */
    bool is_forced;          /* a command may take it though its process has not begun */
    bool has_next;           /* the next two are told; else they are the station's, and the wafer's own */
    int64_t own_us, next_us; /* how long its wafer's process takes, and the next wafer's; WH_FLOW_NONE: as the
                              * station says */
    int32_t recipe, next_recipe; /* of its wafer, or of the last one; of the next wafer */
    double left_us;              /* of the process or the clean that runs */
    int64_t begun_us;            /* when that began */
    int64_t done_us;             /* when the wafer's process ended; without one, when the wafer came */
    int64_t lifted_us;           /* when it was lifted last */
    int64_t empty_us;            /* FREE: since when; WH_FLOW_NEVER: and cleaned since */
} wh_clock_place_t;

typedef struct {
    wh_flow_side_t side; /* of a lock: its pressure, or the one that it had before it pumped */
    wh_flow_side_t pump_to;
    bool is_pumping;
    double left_us;
    int64_t begun_us;
} wh_clock_t;

typedef enum {
    WH_CLOCK_PROCESS_BEGINS,
    WH_CLOCK_PROCESS_ENDS,
    WH_CLOCK_PROCESS_CUT, /* the wafer was lifted before the end; `us` is how long it ran */
    WH_CLOCK_TAKEN,       /* a wafer that was done has left; `us` is its stay since then */
    WH_CLOCK_CLEAN_BEGINS,
    WH_CLOCK_CLEAN_ENDS,
    WH_CLOCK_PUMP_BEGINS,
    WH_CLOCK_PUMP_ENDS,
    WH_CLOCK_UNPROCESSED,  /* a wafer has left whose process never began; `us` is how long it lay there */
    WH_CLOCK_LATE,         /* a stay was beyond the window; `us` is by how much */
    WH_CLOCK_CLEAN_MISSED, /* a wafer came before the end of a clean, or in place of one; `us` was left */
    WH_CLOCK_CLEAN_CUT,    /* a wafer was lifted from a clean around it; `us` is how long that ran */
    WH_CLOCK_PORT_BEGINS,  /* a step of a load port, and the others as in load_port.h */
    WH_CLOCK_PORT_ENDS,
    WH_CLOCK_PORT_TIMEOUT,
    WH_CLOCK_CARRIER_CAME,
    WH_CLOCK_CARRIER_WENT
} wh_clock_kind_t;

#define WH_CLOCK_KINDS 17

typedef struct {
    wh_clock_kind_t kind;
    int32_t slot;        /* from 0; WH_FLOW_NONE: it is about the whole station */
    int32_t wafer;       /* or WH_FLOW_NONE */
    wh_flow_side_t side; /* of pumping: where it leads */
    int64_t at_us;
    int64_t us; /* of what begins: how long it takes by itself */
} wh_clock_event_t;

typedef struct {
    void (*tell)(void *user, const wh_clock_event_t *event);
    void *user;
} wh_clock_teller_t;

/* A place as it is seen. */
typedef struct {
    int32_t wafer;   /* that lies in it, well or not; WH_FLOW_NONE: none */
    bool is_bad;     /* so that no process may begin */
    bool keeps;      /* the place's own wafer does not lie in it, and has not left the station */
    bool is_lifted;  /* the wafer that seems to lie in it is on a blade */
    int32_t recipe;  /* of that wafer, by its number; 0: none */
    bool is_awaited; /* a command that was not refused brings a wafer: the idle time is over */
} wh_clock_seen_t;

/* "process_begins" and so on; never null. */
const char *wh_clock_kind_name(wh_clock_kind_t kind);

/* "empty", "waiting", "processing", "cleaning" or "done". */
const char *wh_clock_phase_name(wh_clock_phase_t phase);

/* At time 0, with `of->slots` empty places. */
void wh_clock_start(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[]);

/* `us` have passed and it is `now_us`: what runs goes on by rate times that time, and may end. Rate 1: as
 * described; 0: it stands. */
void wh_clock_pass(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[], double us,
                   double rate, int64_t now_us, const wh_clock_teller_t *teller);

/* How long nothing that runs there ends, and no clean begins by itself, at rate 1; INFINITY: nothing ever. 0
 * while a wafer is away: it may leave at any time. */
double wh_clock_quiet_us(const wh_flow_station_t *of, const wh_clock_t *clock,
                         const wh_clock_place_t places[], int64_t now_us);

/* How long the place's wafer is processed there. */
static inline int64_t wh_clock_process_us(const wh_flow_station_t *of, const wh_clock_place_t *place) {
    return place->own_us != WH_FLOW_NONE ? place->own_us : wh_flow_treatment(of, place->recipe).process_us;
}

/* This is seen of its slots now. `is_closed`: no blade is in it and its doors are shut. All that can begin
 * then begins. */
void wh_clock_look(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[],
                   const wh_clock_seen_t seen[], bool is_closed, int64_t now_us,
                   const wh_clock_teller_t *teller);

/* True if wh_clock_look changes nothing while the slots are seen so, closed or not: each wafer lies well, and
 * nothing waits for its begin. It costs much less than to find out what is seen. */
bool wh_clock_rests(const wh_flow_station_t *of, const wh_clock_place_t places[],
                    const wh_clock_seen_t seen[]);

/* The wafer that was lifted is lifted anew: the stay that it may end has lasted until now. */
void wh_clock_lift_anew(wh_clock_place_t *place, int64_t now_us);

/* At the end of all: tells of a wafer that is still there if its stay is beyond the window by now. `lies`
 * false: until it was lifted. Returns the stay; below 0: there is none. */
int64_t wh_clock_judge(const wh_flow_station_t *of, const wh_clock_place_t *place, int32_t slot, bool lies,
                       int64_t now_us, const wh_clock_teller_t *teller);

/* A lock begins to pump; nothing happens if it has this pressure or is on its way there. Call it only while
 * nobody is in it and its doors are shut. False: it is on its way to the other one. */
bool wh_clock_pump(const wh_flow_station_t *of, wh_clock_t *clock, const wh_clock_place_t places[],
                   wh_flow_side_t to, int64_t now_us, const wh_clock_teller_t *teller);

/* How long the place needs until nothing runs in it, without faults: its process, and the clean around its
 * wafer. 0: nothing runs or is due. */
double wh_clock_left_us(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us);

/* True if the place is empty and a clean is to begin in it: after wafers, or after its idle time. */
bool wh_clock_is_clean_due(const wh_flow_station_t *of, const wh_clock_place_t *place, int64_t now_us);

/* True if a clean must come when this place's wafer has left. */
bool wh_clock_cleans_next(const wh_flow_station_t *of, const wh_clock_place_t *place);

#endif
