/* The record of a run: what was commanded, what happened, what was expected. */
#ifndef WH_RECORD_RECORD_H
#define WH_RECORD_RECORD_H

#include "../layout/layout.h"
#include "activity.h"
#include "centrings.h"

typedef struct {
    int line;                  /* in the script; 0 when unknown */
    int32_t task;              /* of the script, its number; 0: the script itself, or a prompt */
    char *text;                /* as an operator would type it: GET A 1 */
    wh_status_t error;         /* WH_OK: it succeeded */
    char *message;             /* what the error said, or null */
    double begin_s, end_s;     /* simulated */
    int64_t shares[WH_SHARES]; /* slices of it by what they go into */
    size_t first_event;        /* the number of events before it */
} wh_command_record_t;

/* Where a wafer comes to lie that an edge grip has met: see record/seat.h. */
typedef struct {
    bool is_there; /* else the event is no such */
    bool is_held;  /* false: it is too large or too small for the window, and let go there */
    double x, y;   /* mm, gripper's frame: the middle of the face that looks at the blade */
    double s;      /* of the plunger, mm */
} wh_seat_t;

typedef struct {
    int64_t utime;
    int32_t command; /* index of the command during which it happened, or WH_NONE */
    wh_event_t event;
    wh_seat_t seat;
} wh_event_record_t;

typedef struct {
    int line;
    char *text; /* what was expected; if it was not met, with the value found */
    bool ok;
} wh_expectation_record_t;

/* A wafer that was set down well: see record/throughput.h. */
typedef struct {
    int32_t wafer, station, slot;
    int64_t slice; /* at the end of the command */
} wh_put_record_t;

/* A task of a script waited, or the script itself. */
typedef struct {
    int32_t task;       /* its number; 0: the script itself */
    int32_t command;    /* index of its command that waited; WH_NONE: it awaited a signal or joined others */
    char *what;         /* for what: a station P, which task 2 has */
    int64_t begin, end; /* slices before; `end` is later, unless it is open */
    bool is_open;       /* it waits still */
} wh_wait_record_t;

/* A cycle that the script marked. */
typedef struct {
    int line;
    char *name;    /* "" without one */
    int64_t begin; /* slices before it */
} wh_cycle_record_t;

/* How near an axis comes to an end of its travel at a station. */
typedef struct {
    wh_real_t margin; /* mm or rad, at least 0 */
    wh_real_t at;     /* where it then stands */
    bool is_max;      /* the upper end */
    int32_t slot;     /* where the arm then goes in, from 1; 0: not rehearsed */
} wh_travel_margin_t;

typedef struct {
    wh_travel_margin_t axes[WH_AXES]; /* the robots' */
} wh_station_reach_t;

/* Where a wafer is at the end. */
typedef struct {
    wh_pose_t base_from_wafer;
    int32_t holder;
    wh_place_t place; /* place.station is WH_NONE if it lies in no slot */
} wh_wafer_record_t;

/* What a log of a run is worth: what a replay of it says (log/reading.h). */
typedef struct {
    const char *verdict; /* same, differs, incomplete, cut */
    const char *reason;  /* "" if it is the same */
    bool has_id;         /* it is a recording that tells: */
    uint64_t id;         /* all its parts have it */
    int32_t part;
    const char *const *notes; /* what the log lacks */
    size_t note_count;
} wh_record_log_t;

typedef struct {
    char *script;              /* path as given */
    const wh_layout_t *layout; /* null when the script named none; lives as long as the record */
    bool ok;         /* no command failed uncaught, every expectation was met, the cell had no complaint */
    bool is_untold;  /* read from a log that does not show how the run ended: `ok` is then false */
    bool is_partial; /* read from a log that has not the whole run as it was */
    const char *const *errors; /* that the cell was given, NAME.FIELD=VALUE; borrowed */
    size_t error_count;
    const wh_trial_t *trial;    /* of a study, whose errors the cell was given; null: none; borrowed */
    const wh_record_log_t *log; /* null: not read from a log; borrowed */
    char *failure;              /* the uncaught error's message with file and line, or null */
    int64_t slices;
    int64_t crowded; /* slices that had more events than are told, which fails the run */
    int64_t missed;  /* of them, those that a free-running run lost on the way to the simulator */
    double simulated_s, wall_s;
    uint64_t hash;
    wh_command_record_t *commands;
    size_t command_count, command_capacity;
    wh_event_record_t *events;
    size_t event_count, event_capacity;
    wh_expectation_record_t *expectations;
    size_t expectation_count, expectation_capacity;
    wh_put_record_t *puts; /* in order */
    size_t put_count, put_capacity;
    wh_cycle_record_t *cycles; /* in order */
    size_t cycle_count, cycle_capacity;
    wh_wait_record_t *waits; /* in the order in which they began */
    size_t wait_count, wait_capacity;
    wh_centring_record_t *centrings; /* in order */
    size_t centring_count, centring_capacity;
    size_t centrings_left_out; /* later ones, beyond WH_RECORD_CENTRINGS */
    bool has_tasks;            /* several commands may have run at once */
    wh_activity_t activity;
    wh_station_reach_t *reach; /* layout->station_count of them, from home; null: nothing was rehearsed */
    wh_wafer_record_t *wafers; /* layout->wafer_count of them */
    bool checked;              /* for collisions: then these are the smallest gaps */
    wh_clearance_t clearances[WH_CLEARANCES];
    wh_curves_t *curves; /* and how they went over time; null unless checked */
} wh_record_t;

/* Appending; texts are copied. */
wh_command_record_t *wh_record_add_command(wh_record_t *record, int line, const char *text, double begin_s);
void wh_record_add_event(wh_record_t *record, int64_t utime, int32_t command, const wh_event_t *event,
                         const wh_seat_t *seat);
void wh_record_add_expectation(wh_record_t *record, int line, const char *text, bool ok);
void wh_record_add_put(wh_record_t *record, const wh_put_record_t *put);
void wh_record_begin_reach(wh_record_t *record, size_t stations); /* once; then nothing */
void wh_record_add_cycle(wh_record_t *record, int line, const char *name, int64_t begin);

/* By the command's number, WH_NONE: none. A TEACH seeks beams and puts back the wafer that it took: neither
 * counts. */
bool wh_record_is_teaching(const wh_record_t *record, int32_t command);

/* Not one of a TEACH. */
void wh_record_add_centring(wh_record_t *record, const wh_centring_record_t *centring);

/* An open wait, from the end of slice `begin` on. */
void wh_record_add_wait(wh_record_t *record, int32_t task, int32_t command, const char *what, int64_t begin);

/* Drops commands, events, expectations, puts, cycles, waits, centrings and intervals; script, layout, reach
 * and the sums stay. */
void wh_record_forget(wh_record_t *record);

/* The same, but the last command that failed stays: for sessions without an end, which tell it in STATUS.
 * None may run. */
void wh_record_forget_old(wh_record_t *record);

/* True if the cell complains by this event: a wafer was let go where it should not have been, or lies beyond
 * the layout's `placing`, something was hit or may have been, a gap is below its limit, a wafer slipped, or
 * an input was refused. */
bool wh_record_is_complaint(wh_event_kind_t kind);

/* True if by this event two parts touched, or came or may have come too near: it names them and the place. */
bool wh_record_is_contact(wh_event_kind_t kind);

/* Why a run failed: the error, else the first expectation, else the first complaint. */
void wh_record_reason(const wh_record_t *record, char *reason, size_t size);

/* True if all was well because there was nothing: the cell stood, and no command came. */
bool wh_record_moved_nothing(const wh_record_t *record);

/* The catalogue's text for any status: what motion control and the link answer stands in it too, which
 * wh_status_text leaves out. Never null. */
const char *wh_record_error_text(wh_status_t status);

/* Frees everything that the record holds and zeroes it. */
void wh_record_free(wh_record_t *record);

/* Names for the record's indices, the layout's own; null for WH_NONE, an index out of range and a record
 * without a layout. */
const char *wh_record_wafer_name(const wh_record_t *record, int32_t wafer);
const char *wh_record_gripper_name(const wh_record_t *record, int32_t gripper);
const char *wh_record_station_name(const wh_record_t *record, int32_t station);

/* Of several robots the one that carries the command out, as its text says; WH_NONE: none of them, or there
 * is one robot. Cost: linear in robots. */
int32_t wh_record_robot(const wh_record_t *record, const wh_command_record_t *command);

#endif
