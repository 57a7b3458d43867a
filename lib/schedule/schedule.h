/* A schedule: who does what to which wafer, where and when. Its rows are in any order.
 *
 * * Names are numbered in the order in which they come. Times are whole microseconds. A place is one slot
 * of one station. */
#ifndef WH_SCHEDULE_SCHEDULE_H
#define WH_SCHEDULE_SCHEDULE_H

#include "../flow/tool.h"

/* The longest name, without its terminator. */
#define WH_SCHEDULE_NAME 127

/* Times within 100 us of each other are the same instant. */
#define WH_SCHEDULE_INSTANT_US 100

typedef enum {
    WH_SCHEDULE_START, /* the wafer lies there from its begin on */
    WH_SCHEDULE_PICK,
    WH_SCHEDULE_PLACE,
    WH_SCHEDULE_SWAP, /* wafer goes in, wafer2 comes out */
    WH_SCHEDULE_MOVE, /* from station to `to` */
    WH_SCHEDULE_PROCESS,
    WH_SCHEDULE_CLEAN,
    WH_SCHEDULE_PUMP, /* to the side that is its value */
    WH_SCHEDULE_OPEN,
    WH_SCHEDULE_CLOSE,
    WH_SCHEDULE_LEAVE, /* the wafer is gone with its carrier from its begin on */
    WH_SCHEDULE_ACTIONS
} wh_schedule_action_t;

/* The words of files, and what people say: "picks". */
extern const char *const wh_schedule_words[WH_SCHEDULE_ACTIONS + 1];

/* The columns of files, up to a null. */
typedef enum {
    WH_SCHEDULE_ROBOT,
    WH_SCHEDULE_ACTION,
    WH_SCHEDULE_WAFER,
    WH_SCHEDULE_STATION,
    WH_SCHEDULE_SLOT,
    WH_SCHEDULE_BEGIN,
    WH_SCHEDULE_END,
    WH_SCHEDULE_ARM,
    WH_SCHEDULE_WAFER2,
    WH_SCHEDULE_TO,
    WH_SCHEDULE_VALUE,
    WH_SCHEDULE_COLUMNS
} wh_schedule_column_t;

extern const char *const wh_schedule_columns[WH_SCHEDULE_COLUMNS + 1];

typedef struct {
    int64_t begin_us, end_us;
    size_t line; /* of the file, from 1 */
    wh_schedule_action_t action;
    int32_t robot, wafer, wafer2, station, to; /* names' numbers, or WH_FLOW_NONE */
    int32_t slot;                              /* from 1 */
    int32_t arm;                               /* from 1; 0: not told */
    int32_t place;                             /* of station and slot; see wh_schedule_finish */
    int32_t recipe;      /* of a start's wafer, or of a process: its name's number, from 1; 0: none */
    wh_flow_side_t side; /* of a pump or a door; WH_FLOW_BOTH: not told */
} wh_schedule_row_t;

/* Names by number, and numbers by name. Zero it at the beginning. */
typedef struct {
    char **texts;
    size_t count, capacity;
    int32_t *slots; /* open addressing; WH_FLOW_NONE is free */
    size_t slot_count;
} wh_schedule_names_t;

/* The number of a name, which is added if it is new. */
int32_t wh_schedule_name(wh_schedule_names_t *names, const char *text);

typedef struct {
    int32_t station, slot;
} wh_schedule_place_t;

/* Zero it at the beginning. */
typedef struct {
    char *path;
    wh_schedule_row_t *rows;
    size_t count, capacity;
    wh_schedule_names_t robots, wafers, stations, recipes;
    wh_schedule_names_t unused;  /* columns of the file whose cells no row needs */
    wh_schedule_place_t *places; /* by station, then by slot */
    size_t place_count;
    bool ends_whole; /* the file's last line has a line end */
} wh_schedule_t;

/* To be called once when all rows are there: numbers the places. Cost: a sort. */
void wh_schedule_finish(wh_schedule_t *schedule);
void wh_schedule_close(wh_schedule_t *schedule);

/* True for a row that is an instant: it needs no end. */
static inline bool wh_schedule_is_instant(wh_schedule_action_t action) {
    return action == WH_SCHEDULE_START || action == WH_SCHEDULE_LEAVE;
}

/* True for what a robot does alone: pick, place, swap. */
static inline bool wh_schedule_is_access(wh_schedule_action_t action) {
    return action == WH_SCHEDULE_PICK || action == WH_SCHEDULE_PLACE || action == WH_SCHEDULE_SWAP;
}

/* "a" or "an", before the action's word. */
static inline const char *wh_schedule_article(wh_schedule_action_t action) {
    return action == WH_SCHEDULE_OPEN ? "an" : "a";
}

/* A robot's name, and so on; "" for WH_FLOW_NONE. */
const char *wh_schedule_text(const wh_schedule_names_t *names, int32_t number);

#endif
