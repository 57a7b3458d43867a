/* A field log, played against a cell: its axes and valves drive the cell slice by slice, its sensors are
 * held against the cell's.
 *
 * The log's first row is slice 1. Each slice after it has a time. Between two rows axes go straight from
 * one to the other and valves stay as in the first of them. A row within a thousandth of a slice of a
 * slice's time is that slice, to the bit. Nothing is allocated while it plays. */
#ifndef WH_LOOP_FIELD_RUN_H
#define WH_LOOP_FIELD_RUN_H

#include "field.h"
#include "field_moves.h"
#include "plant.h"

/* Where a sensor of the log is not as the cell's for the first time. */
typedef struct {
    uint64_t rows; /* in which they differ */
    bool is_there; /* they differ for longer than they may */
    size_t line;   /* where that began */
    double time_s;
    bool logged;  /* on, by the log; the cell says otherwise */
    bool is_open; /* they differ now, since: */
    size_t open_line;
    double open_s;
    bool open_logged;
} wh_field_sensor_t;

/* Options of a run. */
typedef struct {
    double gap_s;    /* rows farther apart leave a hole: nobody knows what was between */
    double within_s; /* a sensor may differ for so long */
} wh_field_options_t;

typedef struct {
    wh_field_options_t options;
    wh_field_log_t *field;
    wh_plant_t *plant;
    wh_field_moves_t *moves; /* null: nobody asks for them */
    /* Takes each slice that the cell has taken, by the row towards which it goes; may be null. */
    void (*stepped)(void *user, const wh_command_t *command, size_t line);
    void *stepped_user;
    uint64_t rows, between; /* read; and of them, those between two slices, whose axes no slice had */
    double first_s, last_s;
    uint64_t holes;
    double longest_s; /* between two rows, before the line: */
    size_t longest_line;
    wh_field_sensor_t sensors[WH_GRIPPERS];
    size_t refused_line, jumped_line; /* of the first refused row, and the first jump; 0: none */
    char refused[WH_PLANT_TEXT], jumped[WH_PLANT_TEXT];
    wh_status_t status; /* by which the cell took no more; WH_OK: it took all */
} wh_field_run_t;

/* Plays the whole log. False if a row is refused by the reader, with the field's message, or by the cell. All
 * three must be open; `run` is filled in from `options` to `stepped_user`. */
bool wh_field_play(wh_field_run_t *run);

/* The log's time of the plant's last slice. */
double wh_field_time(const wh_field_run_t *run);

/* The gripper whose sensor differs first; gripper_count: none does. */
size_t wh_field_first_sensor(const wh_field_run_t *run);

#endif
