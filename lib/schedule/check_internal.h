/* Within the check of a schedule: the tool at an instant, and the parts that hold rows against it. */
#ifndef WH_SCHEDULE_CHECK_INTERNAL_H
#define WH_SCHEDULE_CHECK_INTERNAL_H

#include "check.h"

#define WH_CHECK_NO_ROW (-1)

typedef enum {
    WH_CHECK_NOWHERE,
    WH_CHECK_LIES,
    WH_CHECK_TAKEN,  /* a pick out of `place` runs */
    WH_CHECK_ABOARD, /* of `robot` */
    WH_CHECK_PLACED, /* a placing into `place` runs */
} wh_check_where_t;

typedef struct {
    wh_check_where_t where;
    int32_t place, robot, arm; /* arm: from 1; 0: not known */
    int32_t next;              /* in its place */
    int32_t row;               /* the last one that told of it, or WH_CHECK_NO_ROW */
    int32_t process_row;       /* the last one of this stay */
    int32_t visits, home;      /* home: a station of the layout */
    int64_t placed_us;         /* when it lay there */
    int64_t done_us;           /* its process is over, as far as is known */
    int64_t processed_us;      /* of rows, in this stay */
    int64_t whole_us;          /* when they had lasted as long as the layout says; WH_FLOW_NEVER: not yet */
    int32_t recipe;            /* the layout's number; 0: none */
    int32_t stay_recipe;       /* that of this stay, as a row of its process says */
    int64_t around_us;         /* of done_us: a clean around it, which has no row */
    uint64_t routes;           /* by which it may go, by their bits */
    bool is_lost;              /* it left all routes; told once */
    bool has_start;
} wh_check_wafer_t;

typedef struct {
    int32_t head; /* a wafer, or WH_FLOW_NONE */
    int32_t count, capacity;
    int64_t empty_us;   /* since then, if it is */
    int64_t clean_us;   /* the end of its last clean */
    int64_t cleaned_us; /* the begin of its last clean; below 0: none */
    int64_t placing_us; /* the end of the last placing */
    int32_t clean_row, placing_row;
    int32_t since;  /* wafers since the last clean */
    int32_t recipe; /* of the wafer that lies there, or lay there last */
} wh_check_place_t;

typedef struct {
    int32_t tool; /* its number there, or WH_FLOW_NONE */
    int32_t wafers;
    wh_flow_side_t side;
    int64_t pump_us, access_us; /* the ends of what runs */
    int32_t pump_row, access_row;
    bool has_pumps; /* rows of its own */
    int32_t slots;  /* of which rows tell */
} wh_check_station_t;

typedef struct {
    int32_t tool;
    int32_t row; /* the action that ends last */
    int32_t arms, aboard;
    int32_t on[2];   /* wafers by arm, where arms are told */
    int32_t station; /* of the layout, in front of which it stands */
    int64_t free_us;
    bool tells_arms;
} wh_check_robot_t;

/* A station's door, by side or by robot. */
typedef struct {
    int32_t station, key; /* key: a side, or 2 + the robot */
    enum { WH_CHECK_SHUT, WH_CHECK_OPENING, WH_CHECK_OPEN, WH_CHECK_CLOSING } state;
    int32_t row, access_row;
    int64_t access_us;
} wh_check_door_t;

typedef struct {
    const wh_schedule_t *schedule;
    const wh_flow_tool_t *tool;
    wh_schedule_report_t *report;
    wh_check_wafer_t *wafers;
    wh_check_place_t *places;
    wh_check_station_t *stations;
    wh_check_robot_t *robots;
    wh_check_door_t *doors; /* by station, then by key */
    size_t door_count;
    bool has_cleans;        /* rows of them: each that is due then has one */
    size_t doors_from_open; /* that shut first, in a schedule that does not say how it begins */
} wh_schedule_state_t;

/* Adds a finding; the text is "COLUMN: VALUE (expected ...)". */
__attribute__((format(printf, 5, 6))) void wh_check_found(wh_schedule_state_t *check, int rule, int32_t row,
                                                          int32_t other, const char *format, ...);

/* "R's pick of W1 at A 1, 5 to 8 s, line 3", for a text that lives until the function is called 4 times. */
typedef struct {
    char text[700];
} wh_check_text_t;
const char *wh_check_describe(const wh_schedule_state_t *check, int32_t row, wh_check_text_t *text);

/* "A 1", where a wafer is, or what it is in. */
const char *wh_check_place_name(const wh_schedule_state_t *check, int32_t place, wh_check_text_t *text);
const char *wh_check_where(const wh_schedule_state_t *check, int32_t wafer, wh_check_text_t *text);

static inline double wh_check_seconds(int64_t us) {
    return (double)us / 1e6;
}

static inline const wh_schedule_row_t *wh_check_row(const wh_schedule_state_t *check, int32_t row) {
    return &check->schedule->rows[row];
}

/* True if the time is more than an instant behind the other one. */
static inline bool wh_check_is_behind(int64_t us, int64_t other_us) {
    return us > other_us + WH_SCHEDULE_INSTANT_US;
}

/* The row's action begins when the other one's is over, at `us`; true if it does not: that is found, by this
 * rule. */
bool wh_check_is_early(wh_schedule_state_t *check, int rule, int32_t row, int64_t us, int32_t other);

/* The layout's station of a row's; null: there is no layout. */
const wh_flow_station_t *wh_check_station(const wh_schedule_state_t *check, int32_t station);

/* The layout's recipe that the row names; 0: none, or there is no layout. */
int32_t wh_check_recipe(const wh_schedule_state_t *check, const wh_schedule_row_t *row);

/* The index of robot and station of a row in the layout's tables; only with a layout, and a robot. */
size_t wh_check_pair(const wh_schedule_state_t *check, const wh_schedule_row_t *row);

/* ------------------------------------------------------------------------------- before the first instant */
void wh_check_open(wh_schedule_state_t *check);
void wh_check_close(wh_schedule_state_t *check);

/* False, with a message, if a row names what the layout does not have. */
bool wh_check_take_names(wh_schedule_state_t *check);

/* Notes what the rows tell of the whole schedule, and where its doors and wafers are at first. */
void wh_check_begin(wh_schedule_state_t *check);

/* --------------------------------------------------------------------------- robots: rules 1, 2, 6, 7, 14 */
void wh_check_robot_begins(wh_schedule_state_t *check, int32_t row);
void wh_check_length(wh_schedule_state_t *check, int32_t row, int64_t least_us);
void wh_check_takes_aboard(wh_schedule_state_t *check, int32_t row, int32_t wafer, int32_t arm);

/* -------------------------------------------------------------------- places: rules 3, 4, 5, 8, 9, 10, 16 */
void wh_check_lay(wh_schedule_state_t *check, int32_t wafer, int32_t place);
void wh_check_begin_start(wh_schedule_state_t *check, int32_t row);
void wh_check_begin_leave(wh_schedule_state_t *check, int32_t row);
void wh_check_begin_take(wh_schedule_state_t *check, int32_t row, int32_t wafer);
void wh_check_end_take(wh_schedule_state_t *check, int32_t row, int32_t wafer);
void wh_check_begin_put(wh_schedule_state_t *check, int32_t row, int32_t wafer, int32_t leaving);
void wh_check_end_put(wh_schedule_state_t *check, int32_t row, int32_t wafer);
void wh_check_need_aboard(wh_schedule_state_t *check, int32_t row, int32_t wafer);

/* --------------------------------------------------------------- processes and cleans: rules 8, 9, 10, 16 */
void wh_check_begin_process(wh_schedule_state_t *check, int32_t row);
void wh_check_begin_clean(wh_schedule_state_t *check, int32_t row);
void wh_check_leave(wh_schedule_state_t *check, int32_t row, int32_t wafer);
void wh_check_enter(wh_schedule_state_t *check, int32_t row, int32_t leaving);
int64_t wh_check_process_us(const wh_schedule_state_t *check, int32_t wafer);
void wh_check_finish_stays(wh_schedule_state_t *check);

/* ---------------------------------------------------------------------- locks and doors: rules 11, 12, 13 */
void wh_check_open_doors(wh_schedule_state_t *check);
void wh_check_access(wh_schedule_state_t *check, int32_t row);
void wh_check_begin_pump(wh_schedule_state_t *check, int32_t row);
void wh_check_end_pump(wh_schedule_state_t *check, int32_t row);
void wh_check_begin_door(wh_schedule_state_t *check, int32_t row);
void wh_check_end_door(wh_schedule_state_t *check, int32_t row);
void wh_check_process_door(wh_schedule_state_t *check, int32_t row, const wh_check_wafer_t *wafer);
bool wh_check_has_one_slot(const wh_schedule_state_t *check, int32_t station);
wh_check_door_t *wh_check_door_of(const wh_schedule_state_t *check, const wh_schedule_row_t *row);

/* ----------------------------------------------------------------------------------- routes: rules 15, 17 */
void wh_check_set_out(wh_schedule_state_t *check, int32_t wafer, int32_t place);
void wh_check_visit(wh_schedule_state_t *check, int32_t row, int32_t wafer);
void wh_check_finish_route(wh_schedule_state_t *check, int32_t wafer);
void wh_check_finish_routes(wh_schedule_state_t *check);

/* ------------------------------------------------------------------------------------- what was looked at */
void wh_check_guess_unit(wh_schedule_state_t *check);
void wh_check_judge(wh_schedule_state_t *check);

#endif
