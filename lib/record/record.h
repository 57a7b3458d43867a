/* The record of a run: commands, events and expectations. */
#ifndef WH_RECORD_RECORD_H
#define WH_RECORD_RECORD_H

#include "../flow/clock.h"
#include "../flow/figures.h"
#include "../flow/load_port.h"
#include "../layout/layout.h"
#include "activity.h"
#include "centrings.h"

typedef struct {
    int line;                  /* in the script; 0 when unknown */
    int32_t task;              /* the number of the script's task; 0: the script itself, or a prompt */
    char *text;                /* as an operator would type it: GET A 1 */
    wh_status_t error;         /* WH_OK: it succeeded */
    char *message;             /* the error's message, or null */
    double begin_s, end_s;     /* simulated time */
    int64_t shares[WH_SHARES]; /* its slices by share */
    size_t first_event;        /* the number of events before it */
    size_t number;             /* of commands that began before it */
    bool is_over;
    bool is_counted; /* some of its slices were left out */
} wh_command_record_t;

/* The place of a wafer that an edge grip has met: see record/seat.h. */
typedef struct {
    bool is_there; /* otherwise the event is of another kind */
    bool is_held;  /* false: the wafer is too large or too small for the window, and is let go there */
    double x, y;   /* mm, gripper's frame: the middle of the face towards the blade */
    double s;      /* of the plunger, mm */
} wh_seat_t;

typedef struct {
    int64_t utime;
    int32_t command; /* index of the command that was running, or WH_NONE */
    wh_event_t event;
    wh_seat_t seat;
} wh_event_record_t;

typedef struct {
    int line;
    char *text; /* the expectation's text; if it was not met, with the value found */
    bool ok;
    bool is_implied; /* a command or the end of the script implies it: nobody wrote it down */
    size_t name;     /* how much of the text is alike in all trials, bytes; 0: all of it */
} wh_expectation_record_t;

/* A wafer that was placed well: see record/throughput.h. */
typedef struct {
    int32_t wafer, station, slot;
    int64_t slice; /* at the end of the command */
} wh_put_record_t;

/* A wait of a script's task, or of the script itself. */
typedef struct {
    int32_t task;       /* its number; 0: the script itself */
    int32_t command;    /* index of the waiting command; WH_NONE: it awaited a signal or joined others */
    char *what;         /* the object of the wait: a station P, which task 2 has */
    int64_t begin, end; /* slices before; `end` is later, unless it is open */
    bool is_open;       /* the wait goes on */
} wh_wait_record_t;

/* Something that a station did by itself; of a load port with the step and the carrier. */
typedef struct {
    int32_t station;
    wh_clock_event_t event;
    wh_load_port_step_t step;
    char carrier[WH_NAME_SIZE]; /* its name; empty: none */
} wh_station_event_record_t;

/* A cycle that the script marked. */
typedef struct {
    int line;
    char *name;    /* "" without one */
    int64_t begin; /* slices before it */
    size_t wafers; /* done in it, of puts whose rows were dropped */
} wh_cycle_record_t;

/* The margin of an axis to the end of its travel, at a station. */
typedef struct {
    wh_real_t margin; /* mm or rad, at least 0 */
    wh_real_t at;     /* its position there */
    bool is_max;      /* the upper end */
    int32_t slot;     /* the slot that the arm then enters, from 1; 0: not rehearsed */
} wh_travel_margin_t;

typedef struct {
    wh_travel_margin_t axes[WH_AXES]; /* the robots' */
} wh_station_reach_t;

/* The place of a wafer at the end. */
typedef struct {
    wh_pose_t base_from_wafer;
    int32_t holder;
    wh_place_t place; /* place.station is WH_NONE if it lies in no slot */
} wh_wafer_record_t;

/* The verdict on a log of a run: the result of a replay (log/reading.h). */
typedef struct {
    const char *verdict; /* same, differs, incomplete, cut */
    const char *reason;  /* "" if it is the same */
    bool has_id;         /* it is a recording with an id: */
    uint64_t id;         /* common to all its parts */
    int32_t part;
    bool is_part;             /* other parts of the recording were not read */
    const char *const *notes; /* what the log lacks */
    size_t note_count;
} wh_record_log_t;

/* Slices that counted time left out: in all, and those of them in which something moved, so that collisions
 * and clearances were not looked for in them. */
typedef struct {
    bool is_wanted;
    int64_t left_out, moving;
    size_t commands;              /* that are over, and of which slices were left out */
    bool is_verified;             /* some stretches that could be left out were played and compared */
    uint64_t stretches, verified; /* all such stretches, and those of them */
} wh_counted_record_t;

/* A wafer's puts where puts count, of which there are no rows. */
typedef struct {
    bool is_put;
    size_t cycle; /* 1 + the last cycle in which it counted; 0: none */
} wh_dropped_puts_t;

/* Rows that were dropped, see dropped.h: their sums. All are 0 where rows are kept. */
typedef struct {
    bool is_wanted;
    size_t commands, errors;    /* commands that are over, and those of them that had an error */
    size_t expectations;        /* that were met */
    size_t complaints;          /* so many events at the list's front are complaints, which stay */
    size_t puts, wafers;        /* puts, and those of them that count */
    bool is_twice;              /* a wafer was put twice where puts count */
    wh_dropped_puts_t *puts_of; /* by wafer; null: none yet */
} wh_dropped_t;

typedef struct {
    char *script;              /* path as given */
    const wh_layout_t *layout; /* null when the script named none; lives as long as the record */
    bool ok;         /* no command failed uncaught, every expectation was met, the cell had no complaint */
    bool is_untold;  /* read from a log that does not show the run's end: `ok` is then false */
    bool is_partial; /* read from a log that does not have the complete run */
    const char *const *errors; /* the cell's errors, NAME.FIELD=VALUE; borrowed */
    size_t error_count;
    const wh_trial_t *trial;    /* the study's trial whose errors the cell has; null: none; borrowed */
    const wh_record_log_t *log; /* null: not read from a log; borrowed */
    char *failure;              /* the uncaught error's message with file and line, or null */
    int64_t slices;
    int64_t crowded; /* slices with more events than are told; the run then fails */
    int64_t missed;  /* slices that a free run lost on the way to the simulator */
    double simulated_s, wall_s;
    uint64_t hash;
    wh_command_record_t *commands;
    size_t command_count, command_capacity;
    wh_event_record_t *events;
    size_t event_count, event_capacity;
    wh_expectation_record_t *expectations;
    size_t expectation_count, expectation_capacity;
    /* Each implied expectation that was judged, in order. Those not met are in `expectations`, too; a run
     * tells no others, and studies count them all. */
    wh_expectation_record_t *implied;
    size_t implied_count, implied_capacity;
    wh_put_record_t *puts; /* in order */
    size_t put_count, put_capacity;
    wh_cycle_record_t *cycles; /* in order */
    size_t cycle_count, cycle_capacity;
    wh_wait_record_t *waits; /* in the order in which they began */
    size_t wait_count, wait_capacity;
    wh_station_event_record_t *station_events; /* in order */
    size_t station_event_count, station_event_capacity;
    wh_centring_record_t *centrings; /* in order */
    size_t centring_count, centring_capacity;
    size_t centrings_left_out; /* centrings after WH_RECORD_CENTRINGS */
    bool has_tasks;            /* several commands may have run at once */
    wh_activity_t activity;
    wh_station_reach_t *reach;   /* layout->station_count of them, from home; null: nothing was rehearsed */
    wh_wafer_record_t *wafers;   /* layout->wafer_count of them */
    const char *unlooked;        /* says what nobody looked for, a constant text; null: nothing */
    wh_counted_record_t counted; /* slices that were left out */
    wh_dropped_t dropped;
    char *times_alone; /* the robots beside those with axes at which nobody looked; null: none; owned */
    char *never_came;  /* the faults and errors on purpose that did not come; null: none; owned */
    bool checked;      /* for collisions; then these are the smallest gaps */
    wh_clearance_t clearances[WH_CLEARANCES];
    wh_flow_t *flow;     /* wafers through a tool of times alone; null: none; owned */
    wh_curves_t *curves; /* the gaps over time; null unless checked */
} wh_record_t;

/* In all, with those whose rows were dropped: commands, those of them that had an error, expectations. */
size_t wh_record_commands(const wh_record_t *record);
size_t wh_record_errors(const wh_record_t *record);
size_t wh_record_expectations(const wh_record_t *record);

/* Appending; texts are copied. */
wh_command_record_t *wh_record_add_command(wh_record_t *record, int line, const char *text, double begin_s);
void wh_record_add_event(wh_record_t *record, int64_t utime, int32_t command, const wh_event_t *event,
                         const wh_seat_t *seat);
void wh_record_add_expectation(wh_record_t *record, int line, const char *text, bool ok);

/* Adds an expectation that nobody wrote down. Behind "; " the text tells the findings. */
void wh_record_add_implied(wh_record_t *record, int line, const char *text, bool ok);

/* The two halves of it: what a study counts, met or not, and what a run tells, because it is not met. */
void wh_record_count_implied(wh_record_t *record, int line, const char *text, bool ok);
void wh_record_add_breach(wh_record_t *record, int line, const char *text);

/* The findings begin after so many bytes of the last expectation's text. */
void wh_record_name_expectation(wh_record_t *record, size_t bytes);

void wh_record_add_put(wh_record_t *record, const wh_put_record_t *put);
void wh_record_begin_reach(wh_record_t *record, size_t stations); /* once; later calls do nothing */
void wh_record_add_cycle(wh_record_t *record, int line, const char *name, int64_t begin);

void wh_record_add_station_event(wh_record_t *record, const wh_station_event_record_t *event);

/* True if the command of this number is a TEACH; WH_NONE: none. A TEACH seeks beams and puts the taken
 * wafer back; neither counts. */
bool wh_record_is_teaching(const wh_record_t *record, int32_t command);

/* Adds a centring unless it belongs to a TEACH. */
void wh_record_add_centring(wh_record_t *record, const wh_centring_record_t *centring);

/* Adds an open wait, from the end of slice `begin` on. */
void wh_record_add_wait(wh_record_t *record, int32_t task, int32_t command, const char *what, int64_t begin);

/* Drops commands, events, expectations, puts, cycles, waits, stations' events, centrings and intervals;
 * script, layout, reach and the sums stay. */
void wh_record_forget(wh_record_t *record);

/* Drops the same, except the last command that failed; it is for sessions without an end, which tell that
 * command in STATUS. No command may run. */
void wh_record_forget_old(wh_record_t *record);

/* True if the cell complains by this event: a wafer was let go where it should not have been, was pushed
 * through its slot, or lies beyond the layout's `placing`, something was hit or may have been, a gap is below
 * its limit, a wafer slipped, or an input was refused. */
bool wh_record_is_complaint(wh_event_kind_t kind);

/* True if by this event two parts touched, or came too near, or may have come too near; the event names
 * them and the place. */
bool wh_record_is_contact(wh_event_kind_t kind);

/* True if by this event a carrier brings or takes a wafer: no fault on purpose. */
bool wh_record_is_carried(const wh_event_t *event);

/* Writes why a run failed: the error, otherwise the first expectation, otherwise the first complaint. */
void wh_record_reason(const wh_record_t *record, char *reason, size_t size);

/* A run whose layout has no collision check says this. */
#define WH_RECORD_TIMES_ALONE "places, ways and collisions were not looked for: the robots are times alone"
#define WH_RECORD_SOME_ALONE "times alone, so that nobody looked at their places, ways and collisions"
#define WH_RECORD_COUNTED_UNLOOKED "collisions and clearances"
#define WH_RECORD_UNLOOKED "collisions were not looked for: the layout has no collision = true"

/* True if not one slice was played, and no wafer of a flow went anywhere. */
bool wh_record_played_nothing(const wh_record_t *record);

/* True if no robot moved in the slices that were played: waiting and switching valves are no motion. */
bool wh_record_kept_still(const wh_record_t *record);

/* True if all was well only because nothing happened: nothing was played, and no command came. */
bool wh_record_moved_nothing(const wh_record_t *record);

/* Why such a run is no good test, unless it expects something. */
#define WH_RECORD_IDLE "it moves nothing and expects nothing"

/* True if the cell is known, and its robots are times alone. */
bool wh_record_is_timed(const wh_record_t *record);

/* The catalogue's text for any status. It also has the statuses of motion control and the link, which
 * wh_status_text leaves out. It is never null. */
const char *wh_record_error_text(wh_status_t status);

/* Frees everything that the record holds and zeroes it. */
void wh_record_free(wh_record_t *record);

/* Names for the record's indices, from the layout; null for WH_NONE, an index out of range and a record
 * without a layout. */
const char *wh_record_wafer_name(const wh_record_t *record, int32_t wafer);
const char *wh_record_gripper_name(const wh_record_t *record, int32_t gripper);
const char *wh_record_station_name(const wh_record_t *record, int32_t station);

/* The robot, of several, that carries the command out, as its text says; WH_NONE: none of them, or there is
 * only one robot. Cost: linear in robots. */
int32_t wh_record_robot(const wh_record_t *record, const wh_command_record_t *command);

#endif
