/* The record of a run: what was commanded, what happened, what was expected. */
#ifndef WH_SCRIPT_RECORD_H
#define WH_SCRIPT_RECORD_H

#include "script/layout.h"

typedef struct {
    int line;              /* in the script; 0 when unknown */
    char *text;            /* as an operator would type it: GET A 1 */
    wh_status_t error;     /* WH_OK: it succeeded */
    char *message;         /* what the error said, or null */
    double begin_s, end_s; /* simulated */
} wh_command_record_t;

typedef struct {
    int64_t utime;
    int32_t command; /* index of the command during which it happened, or WH_NONE */
    wh_event_t event;
} wh_event_record_t;

typedef struct {
    int line;
    char *text; /* what was expected, with the value found when it was not met */
    bool ok;
} wh_expectation_record_t;

/* Where a wafer is at the end. */
typedef struct {
    wh_pose_t base_from_wafer;
    int32_t holder;
    wh_place_t place; /* place.station is WH_NONE when it lies in no slot */
} wh_wafer_record_t;

typedef struct {
    char *script;              /* path as given */
    const wh_layout_t *layout; /* null when the script named none; lives as long as the record */
    bool ok;       /* no command failed uncaught, every expectation was met, the cell had no complaint */
    char *failure; /* the uncaught error's message with file and line, or null */
    int64_t slices;
    int64_t missed; /* of them, those that a free-running run lost on the way to the simulator */
    double simulated_s, wall_s;
    uint64_t hash;
    wh_command_record_t *commands;
    size_t command_count, command_capacity;
    wh_event_record_t *events;
    size_t event_count, event_capacity;
    wh_expectation_record_t *expectations;
    size_t expectation_count, expectation_capacity;
    wh_wafer_record_t *wafers; /* layout->wafer_count of them */
    bool checked;              /* for collisions: then these are the smallest gaps */
    wh_clearance_t clearances[WH_CLEARANCES];
} wh_record_t;

/* Appending; texts are copied. A program that runs out of memory here aborts. */
wh_command_record_t *wh_record_add_command(wh_record_t *record, int line, const char *text, double begin_s);
void wh_record_add_event(wh_record_t *record, int64_t utime, int32_t command, const wh_event_t *event);
void wh_record_add_expectation(wh_record_t *record, int line, const char *text, bool ok);

/* Drops commands, events and expectations; script, layout and the sums stay. For sessions without an end. */
void wh_record_forget(wh_record_t *record);

/* Room for one more item of `size` bytes, by doubling. */
void *wh_record_grow(void *items, size_t count, size_t *capacity, size_t size);

/* A copy of the text, to be freed. */
char *wh_record_text(const char *text);

/* Frees everything that the record holds and zeroes it. */
void wh_record_free(wh_record_t *record);

#endif
