/* The clockwork of one load port: its carrier comes, is clamped, docked, opened and mapped, and goes the same
 * way back.
 *
 * Each step takes its time and ends with the first slice that ends so long after its begin, or later. The
 * next one begins at once, until the port is where it is to go. A port that is told otherwise during a step
 * ends that step first.
 *
 * A carrier is placed and taken away by hand, which is one step, or by a vehicle with the handshake of SEMI
 * E84. The handshake has five steps, which its timers TP1 to TP5 limit:
 *   TP1  L_REQ or U_REQ is on, until TR_REQ is
 *   TP2  READY is on, until BUSY is
 *   TP3  BUSY is on, until the carrier is there, or gone
 *   TP4  L_REQ or U_REQ is off, until BUSY is
 *   TP5  READY is off, until VALID is
 * A step that has not ended when its timer has run out ends the handshake: the carrier is then where it is,
 * and the port stands.
 *
 * It allocates nothing. All that it depends on is in wh_load_port_t, which is plain data. */
#ifndef WH_FLOW_LOAD_PORT_H
#define WH_FLOW_LOAD_PORT_H

#include <stdbool.h>
#include <stdint.h>

/* The states, from the one in which no carrier is there to the one in which its wafers are known. */
typedef enum {
    WH_LOAD_PORT_ABSENT,
    WH_LOAD_PORT_PLACED,
    WH_LOAD_PORT_CLAMPED,
    WH_LOAD_PORT_DOCKED,
    WH_LOAD_PORT_OPEN,
    WH_LOAD_PORT_MAPPED
} wh_load_port_state_t;

#define WH_LOAD_PORT_STATES 6

typedef enum {
    WH_LOAD_PORT_STANDS, /* no step runs */
    WH_LOAD_PORT_TP1,    /* of the handshake, by the timers that limit them */
    WH_LOAD_PORT_TP2,
    WH_LOAD_PORT_TP3,
    WH_LOAD_PORT_TP4,
    WH_LOAD_PORT_TP5,
    WH_LOAD_PORT_PLACE, /* by hand */
    WH_LOAD_PORT_REMOVE,
    WH_LOAD_PORT_CLAMP,
    WH_LOAD_PORT_DOCK,
    WH_LOAD_PORT_OPENS,
    WH_LOAD_PORT_MAP,
    WH_LOAD_PORT_CLOSE,
    WH_LOAD_PORT_UNDOCK,
    WH_LOAD_PORT_UNCLAMP
} wh_load_port_step_t;

#define WH_LOAD_PORT_STEPS 15

/* The number of steps of a handshake: WH_LOAD_PORT_TP1 to WH_LOAD_PORT_TP5. */
#define WH_LOAD_PORT_TIMERS 5

/* The description of a load port. */
typedef struct {
    bool is_e84;                               /* a vehicle brings and takes carriers */
    int64_t us[WH_LOAD_PORT_STEPS];            /* by step: how long it takes by itself */
    int64_t limit_us[WH_LOAD_PORT_TIMERS + 1]; /* by step of the handshake: the longest time */
    wh_load_port_state_t goes_to;              /* by itself, once a carrier is placed */
    wh_load_port_state_t begins;               /* when a run begins */
} wh_load_port_of_t;

typedef struct {
    wh_load_port_state_t is; /* the state that was reached last */
    wh_load_port_state_t to; /* where it goes, step by step */
    wh_load_port_step_t step;
    bool leaves;                /* of a handshake: the carrier is taken away */
    bool is_late;               /* this step was made longer: see wh_load_port_pass */
    wh_load_port_step_t failed; /* the step that ended the last handshake, or WH_LOAD_PORT_STANDS */
    double left_us;             /* of the step */
    double taken_us;            /* since its begin */
    int64_t begun_us;
} wh_load_port_t;

typedef enum {
    WH_LOAD_PORT_BEGINS,  /* a step; `us` is how long it takes by itself */
    WH_LOAD_PORT_ENDS,    /* a step; `us` is how long it took */
    WH_LOAD_PORT_TIMEOUT, /* a step of the handshake ran out of its time, `us` */
    WH_LOAD_PORT_CAME,    /* the carrier is there */
    WH_LOAD_PORT_WENT     /* the carrier is gone */
} wh_load_port_kind_t;

typedef struct {
    wh_load_port_kind_t kind;
    wh_load_port_step_t step;
    int64_t at_us, us;
} wh_load_port_event_t;

/* Hears events; a null function hears none. */
typedef struct {
    void (*tell)(void *user, const wh_load_port_event_t *event);
    void *user;
} wh_load_port_teller_t;

/* How time passes at a port. */
typedef struct {
    double us;      /* that have passed */
    double rate;    /* of what runs: 1 as described, 0 stands */
    double late_us; /* by which the running step is longer; counts once a step */
    int64_t now_us;
} wh_load_port_time_t;

/* "absent", "placed", "clamped", "docked", "open" or "mapped". */
const char *wh_load_port_state_name(wh_load_port_state_t state);

/* "TP1" to "TP5", "place", "remove", "clamp" and so on; of WH_LOAD_PORT_STANDS "stands". */
const char *wh_load_port_step_name(wh_load_port_step_t step);

/* All names of states; a null ends them. */
extern const char *const wh_load_port_state_names[WH_LOAD_PORT_STATES + 1];

/* True if this port has the step, and the step takes any time. */
bool wh_load_port_has(const wh_load_port_of_t *of, wh_load_port_step_t step);

/* At time 0, in the state `of->begins`. */
void wh_load_port_start(const wh_load_port_of_t *of, wh_load_port_t *port);

/* A carrier comes: call it only while the port is absent and stands. It then goes on to `of->goes_to`. */
void wh_load_port_bring(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                        const wh_load_port_teller_t *teller);

/* From now on it goes to this state, WH_LOAD_PORT_ABSENT: until its carrier is gone. False, and nothing
 * changes, while there is no carrier, or one comes or goes. */
bool wh_load_port_go(const wh_load_port_of_t *of, wh_load_port_t *port, wh_load_port_state_t to,
                     int64_t now_us, const wh_load_port_teller_t *teller);

/* Time passes: what runs goes on, and may end. */
void wh_load_port_pass(const wh_load_port_of_t *of, wh_load_port_t *port, const wh_load_port_time_t *time,
                       const wh_load_port_teller_t *teller);

/* How long nothing ends in it at rate 1; INFINITY: nothing runs. */
double wh_load_port_quiet_us(const wh_load_port_of_t *of, const wh_load_port_t *port);

/* How long it goes on by itself, without faults. 0: it stands. */
double wh_load_port_left_us(const wh_load_port_of_t *of, const wh_load_port_t *port);

/* True if a blade may enter: it is open or mapped, and stands. */
bool wh_load_port_is_open(const wh_load_port_t *port);

/* True while a carrier comes, or is taken away. */
bool wh_load_port_hands_over(const wh_load_port_t *port);

#endif
