/* The clockwork of one station that takes time in a cell with axes, stepped slice by slice. It goes by the
 * same description as a flow's station: tool.h. A flow knows the end of each process in advance; here a
 * slice passes, and a fault may make it slow.
 *
 * A process begins when the wafer lies there, no blade is in the station and its doors are shut. It ends
 * with the first slice that ends so long after it, or later: times are rounded up to the slice. A clean is
 * due when the last of its wafers has left, and begins like a process. Each place has its own process and
 * its own clean.
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
    int32_t wafer;       /* that lies there, or WH_FLOW_NONE */
    int32_t since_clean; /* wafers that have left it since */
    bool is_clean_due;
    bool is_around;   /* CLEANING: around the wafer that was processed there */
    double left_us;   /* of the process or the clean that runs */
    int64_t begun_us; /* when that began */
    int64_t done_us;  /* DONE: since when */
    int64_t empty_us; /* FREE: since when */
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
    WH_CLOCK_PROCESS_CUT, /* the wafer was taken before the end; `us` is how long it ran */
    WH_CLOCK_TAKEN,       /* a wafer that was done has left; `us` is its stay since then */
    WH_CLOCK_CLEAN_BEGINS,
    WH_CLOCK_CLEAN_ENDS,
    WH_CLOCK_PUMP_BEGINS,
    WH_CLOCK_PUMP_ENDS
} wh_clock_kind_t;

#define WH_CLOCK_KINDS 8

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

/* "process_begins" and so on; never null. */
const char *wh_clock_kind_name(wh_clock_kind_t kind);

/* "atmosphere" or "vacuum". */
const char *wh_clock_side_name(wh_flow_side_t side);

/* "empty", "waiting", "processing", "cleaning" or "done". */
const char *wh_clock_phase_name(wh_clock_phase_t phase);

/* At time 0, with `of->slots` empty places. */
void wh_clock_start(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[]);

/* `us` have passed and it is `now_us`: what runs goes on by rate times that time, and may end. Rate 1: as
 * described; 0: it stands. */
void wh_clock_pass(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[], double us,
                   double rate, int64_t now_us, const wh_clock_teller_t *teller);

/* How long nothing that runs there ends, and no clean begins by itself, at rate 1; INFINITY: nothing ever. */
double wh_clock_quiet_us(const wh_flow_station_t *of, const wh_clock_t *clock,
                         const wh_clock_place_t places[], int64_t now_us);

/* These wafers lie in its slots now, WH_FLOW_NONE: none. `is_closed`: no blade is in it and its doors are
 * shut. All that can begin then begins. */
void wh_clock_look(const wh_flow_station_t *of, wh_clock_t *clock, wh_clock_place_t places[],
                   const int32_t wafers[], bool is_closed, int64_t now_us, const wh_clock_teller_t *teller);

/* A lock begins to pump; nothing happens if it has this pressure or is on its way there. Call it only while
 * nobody is in it and its doors are shut. False: it is on its way to the other one. */
bool wh_clock_pump(const wh_flow_station_t *of, wh_clock_t *clock, const wh_clock_place_t places[],
                   wh_flow_side_t to, int64_t now_us, const wh_clock_teller_t *teller);

/* How long the place needs until nothing runs in it, without faults: its process, and the clean around its
 * wafer. 0: nothing runs or is due. */
double wh_clock_left_us(const wh_flow_station_t *of, const wh_clock_place_t *place);

/* True if a clean must come when this place's wafer has left. */
bool wh_clock_cleans_next(const wh_flow_station_t *of, const wh_clock_place_t *place);

#endif
