/* An example to copy: the controller of controller.h on its board, in the loop of `waferhand sim --serial`. It
 * carries a wafer from station 0 to station 1 and back, again and again. This file runs on a Cortex-M
 * (tests/target/board.c) and as a process (tests/end_to_end/tools/board.c): only the line differs. */
#ifndef FIRMWARE_BOARD_H
#define FIRMWARE_BOARD_H

#include "controller.h"
#include "loop/board.h"

static const taught_t board_taught[] = {{0, 700, 900, 3, 10, 3}, {90, 700, 900, 3, 10, 3}};
static registers_t board_registers;
static controller_t board_controller;
static wh_board_t board;
static int board_step; /* of the tour: GET, PUT, GET, PUT */

static inline void board_begin(void) {
    controller_init(&board_controller, &board_registers, board_taught, 2);
    board_step = 0;
    wh_board_init(&board, AXES);
}

/* A controller that failed stays as it is: it does nothing more. */
static inline void board_command(void) {
    static const struct {
        bool is_put;
        int station;
    } tour[] = {{false, 0}, {true, 1}, {false, 1}, {true, 0}};
    if (board_controller.answer == CONTROLLER_READY) {
        const int at = board_step++ % 4;
        (void)(tour[at].is_put ? controller_put : controller_get)(&board_controller, tour[at].station, 1);
    }
}

/* Takes a byte of the line; true if `board.out` is to be sent. */
static inline bool board_take(uint8_t byte) {
    const wh_board_news_t news = wh_board_take(&board, byte);
    if (news == WH_BOARD_STATE) {
        board_registers.sensor = (board.state.sensors & 1U) != 0;
        board_command();
        controller_tick(&board_controller);
        wh_board_answer(&board, board_registers.axis, board_registers.vacuum_on ? 1 : 0);
    }
    return news != WH_BOARD_NOTHING;
}

#endif
