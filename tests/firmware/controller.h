/* An example: the firmware of a wafer robot's controller, as small as a controller with GET and PUT
 * can be. It knows registers, taught stations and time. Nothing in it depends on Waferhand: put
 * your own firmware in its place. */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include <stdbool.h>

enum { THETA, R, Z, YAW, AXES }; /* degrees, mm, mm, degrees */

/* The hardware. The firmware writes `axis` and `vacuum_on`, the machine writes `sensor`. */
typedef struct {
    double axis[AXES];
    bool vacuum_on;
    bool sensor; /* the vacuum switch under the blade */
} registers_t;

/* The taught station: slot 1, and how the blade goes in. */
typedef struct {
    double theta, reach, z; /* degrees, mm */
    int slots;
    double pitch, offset; /* mm; the blade goes in and comes out `offset` below or above the slot's plane */
} taught_t;

typedef enum {
    CONTROLLER_READY, /* the last command is done */
    CONTROLLER_BUSY,
    ERROR_NO_SUCH_SLOT,
    ERROR_BUSY,           /* the command came while another one ran, which goes on */
    ERROR_WAFER_ON_BLADE, /* before a GET: the switch is on */
    ERROR_NO_WAFER,       /* before a PUT: the switch is off */
    ERROR_NOT_TAKEN,      /* GET: the switch did not come on in time */
    ERROR_NOT_LEFT,       /* PUT: the switch did not go off in time */
    ERROR_WAFER_LOST      /* the switch went off on the way */
} answer_t;

/* The phase in which the controller is; the phases of a command follow each other in this order. */
typedef enum {
    IDLE,
    TURN,   /* to the station, at the height of entry */
    EXTEND, /* in */
    SWITCH, /* GET: vacuum on. PUT: down to the slot, vacuum off */
    STROKE, /* GET: up, with the wafer */
    WAIT,   /* for the vacuum switch */
    LEAVE,  /* PUT: down, without the wafer */
    RETRACT
} phase_t;

typedef struct {
    registers_t *registers;
    const taught_t *stations;
    int station_count;
    phase_t phase;
    bool is_put;
    double entry[AXES], reach; /* before the station, and how far in */
    double below, above;       /* the heights at both ends of the stroke */
    double switch_at;          /* the height at which a PUT switches the vacuum off */
    int waited;                /* ms */
    answer_t outcome;          /* what the answer will be when the running command is over */
    answer_t answer;
} controller_t;

#define RETRACTED 300.0 /* mm */
#define SENSOR_TIMEOUT_MS 250

/* The arm stands retracted, the vacuum is off. */
void controller_init(controller_t *controller, registers_t *registers, const taught_t *stations, int count);

/* Begins a command: returns CONTROLLER_BUSY, or why it does not begin. `station` counts from 0,
 * `slot` from 1. */
answer_t controller_get(controller_t *controller, int station, int slot);
answer_t controller_put(controller_t *controller, int station, int slot);

/* Call it each millisecond. */
void controller_tick(controller_t *controller);

#endif
