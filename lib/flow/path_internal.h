/* Within the critical path: path.c goes back along it; path_causes.c finds why each event began. */
#ifndef WH_FLOW_PATH_INTERNAL_H
#define WH_FLOW_PATH_INTERNAL_H

#include "path.h"

typedef struct {
    const wh_flow_event_t *event;
} wh_flow_begin_t;

/* The log's events by their begins; null until somebody asks. */
typedef struct {
    wh_flow_begin_t *of;
} wh_flow_begins_t;

typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    const wh_flow_log_t *log;
    wh_flow_begins_t *begins;
    int64_t longest_shutting_us;
    wh_flow_part_t *parts;
    size_t count, capacity;
} wh_flow_path_t;

/* The rank of a cause that nobody knows: nothing ended. */
#define WH_FLOW_CAUSE_UNKNOWN 6

/* Why something began at an instant. */
typedef struct {
    int rank;                     /* 0 is best; WH_FLOW_CAUSE_UNKNOWN: nothing ended */
    wh_flow_path_word_t word;     /* of the time up to the instant, if it is not the event's own */
    int32_t station;              /* likewise */
    const wh_flow_event_t *event; /* before it; null: nothing, the time is from the beginning on */
    bool is_from_begin;           /* the time is from the event's begin on, not from its end */
} wh_flow_cause_t;

wh_flow_cause_t wh_flow_cause_of(const wh_flow_path_t *path, const wh_flow_event_t *event);

/* The log's first event that ends at this time or later, which is looked for from the event `near` on. */
size_t wh_flow_first_ending(const wh_flow_log_t *log, int64_t us, const wh_flow_event_t *near);

/* The log's events by their begins; of one instant in the order of the log. */
const wh_flow_begin_t *wh_flow_begins(const wh_flow_path_t *path);

#endif
