#include "controller.h"

#define TICK_S 0.001

/* mm/s and degrees/s; strokes are slow, so that the wafer is not pushed. */
static const double speeds[AXES] = {180, 1000, 300, 180};
#define STROKE_SPEED 20.0

/* A PUT releases the wafer this far above the slot's plane. */
#define RELEASE_HEIGHT 0.25

void controller_init(controller_t *controller, registers_t *registers, const taught_t *stations, int count) {
    controller->registers = registers;
    controller->stations = stations;
    controller->station_count = count;
    controller->phase = IDLE;
    controller->answer = CONTROLLER_READY;
    registers->axis[THETA] = registers->axis[YAW] = 0;
    registers->axis[R] = RETRACTED;
    registers->axis[Z] = 850;
    registers->vacuum_on = false;
}

/* ----------------------------------------------------------------------------------------------- commands */

static bool is_slot(const controller_t *c, int station, int slot) {
    return station >= 0 && station < c->station_count && slot >= 1 && slot <= c->stations[station].slots;
}

/* A GET goes in below the wafer and lifts it out of the slot; a PUT does the reverse. */
static void plan(controller_t *c, int station, int slot) {
    const taught_t *taught = &c->stations[station];
    const double plane = taught->z + (slot - 1) * taught->pitch;
    c->below = plane - taught->offset;
    c->above = plane + taught->offset;
    c->switch_at = plane + RELEASE_HEIGHT;
    c->entry[THETA] = taught->theta;
    c->entry[R] = RETRACTED;
    c->entry[Z] = c->is_put ? c->above : c->below;
    c->entry[YAW] = 0;
    c->reach = taught->reach;
}

static answer_t begin(controller_t *c, bool is_put, int station, int slot) {
    if (c->phase != IDLE) {
        return ERROR_BUSY;
    }
    if (!is_slot(c, station, slot)) {
        return ERROR_NO_SUCH_SLOT;
    }
    if (c->registers->sensor != is_put) {
        return is_put ? ERROR_NO_WAFER : ERROR_WAFER_ON_BLADE;
    }
    c->is_put = is_put;
    plan(c, station, slot);
    c->phase = TURN;
    c->outcome = CONTROLLER_READY;
    c->answer = CONTROLLER_BUSY;
    return c->answer;
}

answer_t controller_get(controller_t *controller, int station, int slot) {
    return begin(controller, false, station, slot);
}

answer_t controller_put(controller_t *controller, int station, int slot) {
    return begin(controller, true, station, slot);
}

/* ------------------------------------------------------------------------------------------------- motion */

/* Moves one axis for a tick; true if it was already there. */
static bool move(controller_t *c, int axis, double target, double speed) {
    const double left = target - c->registers->axis[axis];
    const double step = speed * TICK_S;
    if (left > step) {
        c->registers->axis[axis] += step;
    } else if (left < -step) {
        c->registers->axis[axis] -= step;
    } else {
        c->registers->axis[axis] = target;
    }
    return left == 0;
}

static bool turn(controller_t *c) {
    bool there = true;
    for (int axis = 0; axis < AXES; ++axis) {
        there = move(c, axis, c->entry[axis], speeds[axis]) && there;
    }
    return there;
}

/* A GET opens the vacuum valve below the wafer; a PUT shuts it just above the slot. */
static bool reach_switch(controller_t *c) {
    if (c->is_put && !move(c, Z, c->switch_at, STROKE_SPEED)) {
        return false;
    }
    c->registers->vacuum_on = !c->is_put;
    return true;
}

/* ------------------------------------------------------------------------------------------------- phases */

static void end(controller_t *c, answer_t answer) {
    c->phase = IDLE;
    c->answer = answer;
}

/* A wafer that lies on the blade without vacuum goes back into its slot: the rest of the GET is a PUT. */
static void put_back(controller_t *c) {
    c->outcome = ERROR_NOT_TAKEN;
    c->is_put = true;
    c->phase = SWITCH;
}

static void wait_for_sensor(controller_t *c) {
    const bool wanted = !c->is_put;
    if (c->registers->sensor == wanted) {
        c->phase = c->is_put ? LEAVE : RETRACT;
    } else if (c->waited >= SENSOR_TIMEOUT_MS && c->is_put) {
        end(c, ERROR_NOT_LEFT); /* the wafer may hang on the blade: the arm stays where it is */
    } else if (c->waited >= SENSOR_TIMEOUT_MS) {
        put_back(c);
    }
    ++c->waited;
}

/* True if the phase is over and the next one is to begin. */
static bool run_phase(controller_t *c) {
    switch (c->phase) {
    case TURN:
        return turn(c);
    case EXTEND:
        return move(c, R, c->reach, speeds[R]);
    case SWITCH:
        return reach_switch(c);
    case STROKE:
        return move(c, Z, c->above, STROKE_SPEED);
    case WAIT:
        wait_for_sensor(c);
        return false;
    case LEAVE:
        return move(c, Z, c->below, STROKE_SPEED);
    case RETRACT:
        return move(c, R, RETRACTED, speeds[R]);
    case IDLE:
        break;
    }
    return false;
}

static void begin_next(controller_t *c) {
    if (c->phase == RETRACT) {
        end(c, c->outcome);
    } else if (c->phase == SWITCH) {
        c->phase = c->is_put ? WAIT : STROKE;
    } else if (c->phase == LEAVE) {
        c->phase = RETRACT;
    } else {
        c->phase = (phase_t)(c->phase + 1);
    }
    c->waited = 0;
}

/* According to the command the arm carries a wafer, but the switch is off. */
static bool is_lost(const controller_t *c) {
    const bool carries = c->is_put ? c->phase == TURN || c->phase == EXTEND : c->phase == RETRACT;
    return carries && c->outcome == CONTROLLER_READY && !c->registers->sensor;
}

void controller_tick(controller_t *controller) {
    if (is_lost(controller)) {
        end(controller, ERROR_WAFER_LOST);
    } else if (run_phase(controller)) {
        begin_next(controller);
    }
}
