#include "edge_gripper.h"

/* The plunger passes the window in 40 ms; a wafer is gripped if it stays there for longer. */
enum { STANDS_MS = 80, MOST_MS = 600 };

void gripper_init(edge_gripper_t *gripper, gripper_registers_t *registers) {
    const edge_gripper_t fresh = {registers, GRIPPER_READY, 0, 0};
    *gripper = fresh;
    registers->closes = false;
}

static void begin(edge_gripper_t *gripper, bool closes) {
    gripper->registers->closes = closes;
    gripper->answer = GRIPPER_BUSY;
    gripper->ms = 0;
    gripper->gripped_ms = 0;
}

void gripper_close(edge_gripper_t *gripper) {
    begin(gripper, true);
}

void gripper_open(edge_gripper_t *gripper) {
    begin(gripper, false);
}

static gripper_answer_t judge_closing(const edge_gripper_t *gripper) {
    if (gripper->registers->overtravel) {
        return GRIPPER_MISSED;
    }
    if (gripper->gripped_ms > STANDS_MS) {
        return GRIPPER_READY;
    }
    return gripper->ms > MOST_MS ? GRIPPER_JAMMED : GRIPPER_BUSY;
}

static gripper_answer_t judge_opening(const edge_gripper_t *gripper) {
    if (gripper->registers->retracted) {
        return GRIPPER_READY;
    }
    return gripper->ms > MOST_MS ? GRIPPER_NOT_OPEN : GRIPPER_BUSY;
}

void gripper_tick(edge_gripper_t *gripper) {
    if (gripper->answer != GRIPPER_BUSY) {
        return;
    }
    ++gripper->ms;
    gripper->gripped_ms = gripper->registers->gripped ? gripper->gripped_ms + 1 : 0;
    gripper->answer = gripper->registers->closes ? judge_closing(gripper) : judge_opening(gripper);
}
