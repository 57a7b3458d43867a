#include "load_port.h"

#include <math.h>
#include <string.h>

const char *const wh_load_port_state_names[WH_LOAD_PORT_STATES + 1] = {
    "absent", "placed", "clamped", "docked", "open", "mapped", NULL};

const char *wh_load_port_state_name(wh_load_port_state_t state) {
    return wh_load_port_state_names[state];
}

const char *wh_load_port_step_name(wh_load_port_step_t step) {
    static const char *const names[WH_LOAD_PORT_STEPS] = {"stands", "TP1",   "TP2",    "TP3",    "TP4",
                                                          "TP5",    "place", "remove", "clamp",  "dock",
                                                          "open",   "map",   "close",  "undock", "unclamp"};
    return (unsigned)step < WH_LOAD_PORT_STEPS ? names[step] : "unknown";
}

void wh_load_port_start(const wh_load_port_of_t *of, wh_load_port_t *port) {
    memset(port, 0, sizeof *port);
    port->is = port->to = of->begins;
}

static bool is_of_handshake(wh_load_port_step_t step) {
    return step >= WH_LOAD_PORT_TP1 && step <= WH_LOAD_PORT_TP5;
}

bool wh_load_port_has(const wh_load_port_of_t *of, wh_load_port_step_t step) {
    const bool by_hand = step == WH_LOAD_PORT_PLACE || step == WH_LOAD_PORT_REMOVE;
    const bool is_there = is_of_handshake(step) ? of->is_e84 : !by_hand || !of->is_e84;
    return is_there && of->us[step] > 0;
}

static void tell(const wh_load_port_teller_t *teller, wh_load_port_kind_t kind, wh_load_port_step_t step,
                 int64_t at_us, int64_t us) {
    const wh_load_port_event_t event = {kind, step, at_us, us};
    if (teller->tell) {
        teller->tell(teller->user, &event);
    }
}

/* ------------------------------------------------------------------------------------------------- steps */

/* The steps to each state and out of it. */
static const struct {
    wh_load_port_step_t up, down; /* to the state, and out of it */
    wh_load_port_state_t below;   /* where `down` leads */
} ways[WH_LOAD_PORT_STATES] = {
    [WH_LOAD_PORT_CLAMPED] = {WH_LOAD_PORT_CLAMP, WH_LOAD_PORT_UNCLAMP, WH_LOAD_PORT_PLACED},
    [WH_LOAD_PORT_DOCKED] = {WH_LOAD_PORT_DOCK, WH_LOAD_PORT_UNDOCK, WH_LOAD_PORT_CLAMPED},
    [WH_LOAD_PORT_OPEN] = {WH_LOAD_PORT_OPENS, WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_DOCKED},
    [WH_LOAD_PORT_MAPPED] = {WH_LOAD_PORT_MAP, WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_DOCKED},
};

/* Only closing forgets a map: a port that is mapped and is to be open stands. */
static wh_load_port_step_t next_step(const wh_load_port_of_t *of, const wh_load_port_t *port) {
    const bool is_there =
        port->is == port->to || (port->is == WH_LOAD_PORT_MAPPED && port->to == WH_LOAD_PORT_OPEN);
    if (is_there || port->is == WH_LOAD_PORT_ABSENT) {
        return WH_LOAD_PORT_STANDS;
    } else if (port->to > port->is) {
        return ways[port->is + 1].up;
    } else if (port->is > WH_LOAD_PORT_PLACED) {
        return ways[port->is].down;
    }
    return of->is_e84 ? WH_LOAD_PORT_TP1 : WH_LOAD_PORT_REMOVE;
}

static void begin_step(const wh_load_port_of_t *of, wh_load_port_t *port, wh_load_port_step_t step,
                       int64_t now_us, const wh_load_port_teller_t *teller) {
    port->step = step;
    port->left_us = step == WH_LOAD_PORT_STANDS ? 0 : (double)of->us[step];
    port->taken_us = 0;
    port->is_late = false;
    port->begun_us = now_us;
    if (step != WH_LOAD_PORT_STANDS) {
        tell(teller, WH_LOAD_PORT_BEGINS, step, now_us, of->us[step]);
    }
}

/* From a state in which nothing runs. */
static void go_on(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                  const wh_load_port_teller_t *teller) {
    const wh_load_port_step_t step = next_step(of, port);
    port->leaves = step == WH_LOAD_PORT_TP1 || step == WH_LOAD_PORT_REMOVE;
    begin_step(of, port, step, now_us, teller);
}

/* The carrier has come, or is gone. */
static void hand_over(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                      const wh_load_port_teller_t *teller) {
    port->is = port->leaves ? WH_LOAD_PORT_ABSENT : WH_LOAD_PORT_PLACED;
    port->to = port->leaves ? WH_LOAD_PORT_ABSENT : of->goes_to;
    tell(teller, port->leaves ? WH_LOAD_PORT_WENT : WH_LOAD_PORT_CAME, port->step, now_us, 0);
}

static void end_step(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                     const wh_load_port_teller_t *teller) {
    const wh_load_port_step_t step = port->step;
    tell(teller, WH_LOAD_PORT_ENDS, step, now_us, now_us - port->begun_us);
    if (step == WH_LOAD_PORT_TP3 || step == WH_LOAD_PORT_PLACE || step == WH_LOAD_PORT_REMOVE) {
        hand_over(of, port, now_us, teller);
    }
    if (step >= WH_LOAD_PORT_TP1 && step < WH_LOAD_PORT_TP5) {
        begin_step(of, port, (wh_load_port_step_t)(step + 1), now_us, teller);
        return;
    }
    for (int state = WH_LOAD_PORT_CLAMPED; state <= WH_LOAD_PORT_MAPPED; ++state) {
        if (ways[state].up == step) {
            port->is = (wh_load_port_state_t)state;
        } else if (ways[state].down == step) {
            port->is = ways[state].below;
        }
    }
    go_on(of, port, now_us, teller);
}

/* The carrier is where it is, and the port waits to be told what to do with it. */
static void run_out(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                    const wh_load_port_teller_t *teller) {
    tell(teller, WH_LOAD_PORT_TIMEOUT, port->step, now_us, of->limit_us[port->step]);
    port->failed = port->step;
    port->to = port->is;
    begin_step(of, port, WH_LOAD_PORT_STANDS, now_us, teller);
}

void wh_load_port_bring(const wh_load_port_of_t *of, wh_load_port_t *port, int64_t now_us,
                        const wh_load_port_teller_t *teller) {
    port->failed = WH_LOAD_PORT_STANDS;
    port->leaves = false;
    begin_step(of, port, of->is_e84 ? WH_LOAD_PORT_TP1 : WH_LOAD_PORT_PLACE, now_us, teller);
}

bool wh_load_port_hands_over(const wh_load_port_t *port) {
    return is_of_handshake(port->step) || port->step == WH_LOAD_PORT_PLACE ||
           port->step == WH_LOAD_PORT_REMOVE;
}

bool wh_load_port_go(const wh_load_port_of_t *of, wh_load_port_t *port, wh_load_port_state_t to,
                     int64_t now_us, const wh_load_port_teller_t *teller) {
    if (port->is == WH_LOAD_PORT_ABSENT || wh_load_port_hands_over(port)) {
        return false;
    }
    port->to = to;
    port->failed = WH_LOAD_PORT_STANDS;
    if (port->step == WH_LOAD_PORT_STANDS) {
        go_on(of, port, now_us, teller);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------- time */

/* us: sums of slices at a rate are as exact as this. */
#define ROUNDING 1e-3

void wh_load_port_pass(const wh_load_port_of_t *of, wh_load_port_t *port, const wh_load_port_time_t *time,
                       const wh_load_port_teller_t *teller) {
    if (port->step == WH_LOAD_PORT_STANDS) {
        return;
    }
    if (time->late_us > 0 && !port->is_late) {
        port->is_late = true;
        port->left_us += time->late_us;
    }
    port->left_us -= time->us * time->rate;
    port->taken_us += time->us;
    const bool is_limited = is_of_handshake(port->step);
    if (port->left_us <= ROUNDING) {
        end_step(of, port, time->now_us, teller);
    } else if (is_limited && port->taken_us >= (double)of->limit_us[port->step]) {
        run_out(of, port, time->now_us, teller);
    }
}

double wh_load_port_quiet_us(const wh_load_port_of_t *of, const wh_load_port_t *port) {
    if (port->step == WH_LOAD_PORT_STANDS) {
        return (double)INFINITY;
    }
    const double limit_us =
        is_of_handshake(port->step) ? (double)of->limit_us[port->step] - port->taken_us : (double)INFINITY;
    return fmin(port->left_us, limit_us);
}

double wh_load_port_left_us(const wh_load_port_of_t *of, const wh_load_port_t *port) {
    static const wh_load_port_teller_t nobody = {NULL, NULL};
    double left_us = 0;
    wh_load_port_t next = *port;
    while (next.step != WH_LOAD_PORT_STANDS) {
        left_us += next.left_us;
        next.left_us = 0;
        const wh_load_port_time_t none = {0, 1, 0, 0};
        wh_load_port_pass(of, &next, &none, &nobody);
    }
    return left_us;
}

bool wh_load_port_is_open(const wh_load_port_t *port) {
    return (port->is == WH_LOAD_PORT_OPEN || port->is == WH_LOAD_PORT_MAPPED) &&
           port->step == WH_LOAD_PORT_STANDS;
}
