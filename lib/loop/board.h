/* A controller's board in the loop of `waferhand sim --serial` or `--udp`: the file that the board compiles.
 *
 * For each slice the simulator sends one state frame, and the board answers with one command frame. The
 * simulator keeps the time: the board waits for a state, lets its firmware run once, and answers.
 *
 *     wh_board_init(&board, 4);
 *     for (;;) {
 *         switch (wh_board_take(&board, uart_get())) {
 *         case WH_BOARD_STATE:
 *             vacuum_switch = board.state.sensors & 1;
 *             firmware_tick();
 *             wh_board_answer(&board, axes, vacuum_on ? 1 : 0);
 *             uart_put(board.out, board.out_size);
 *             break;
 *         case WH_BOARD_REPEATED:
 *             uart_put(board.out, board.out_size);
 *             break;
 *         default:
 *             break;
 *         }
 *     }
 *
 * C99 and C++11, from libc memcpy, memmove, memset and memcmp alone, no heap, no static data, nothing else of
 * Waferhand: copy board.h and board.c. One wh_board_t is for one line; nothing is shared. lib/manual/board.md
 * describes each byte. The simulator reads frames by the same code.
 */
#ifndef WH_LOOP_BOARD_H
#define WH_LOOP_BOARD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most axes of a frame. A board may define fewer, at least as many as it has. */
#ifndef WH_BOARD_AXES
#define WH_BOARD_AXES 32
#endif

/* The frames, in bytes: what begins both, a state, a command, and room for either. */
#define WH_BOARD_HEAD 16
#define WH_BOARD_STATE_BYTES 28
#define WH_BOARD_COMMAND_BYTES(axes) (20U + 8U * (axes))
#define WH_BOARD_BYTES WH_BOARD_COMMAND_BYTES(WH_BOARD_AXES)

/* The first byte of a frame, the second of each kind, and the third. */
#define WH_BOARD_BEGIN 0xA5
#define WH_BOARD_KIND_STATE 'S'
#define WH_BOARD_KIND_COMMAND 'C'
#define WH_BOARD_VERSION 1

/* A command that answers no state has this number: "here I am". */
#define WH_BOARD_HELLO UINT32_C(0xFFFFFFFF)

/* A frame that is gathered byte by byte. Zero it to begin with. */
typedef struct {
    uint8_t bytes[WH_BOARD_BYTES];
    size_t count;
    size_t taken;     /* of them, those of the frame that was handed out */
    uint32_t damaged; /* frames with a wrong sum */
    uint32_t skipped; /* bytes that belong to no frame; those of damaged ones are among them */
} wh_board_gathered_t;

/* The simulator says this of a slice. */
typedef struct {
    uint32_t number;  /* of the slice; 0: the cell before its first slice */
    uint32_t sensors; /* bit g: the sensor of gripper g is on */
    uint16_t status;  /* 0, or the number of the error by which the last command was refused */
    uint16_t held;    /* slices until now without a command of their own; 65535 stands for all above */
    uint64_t hash;    /* of the cell's state */
} wh_board_state_t;

/* The result of a byte. */
typedef enum {
    WH_BOARD_NOTHING,
    WH_BOARD_STATE,   /* a new state: run the firmware once and answer */
    WH_BOARD_REPEATED /* the last state again: its answer was lost. Send `out` again, and run nothing */
} wh_board_news_t;

typedef struct {
    wh_board_state_t state; /* the last one */
    uint8_t axes;
    uint8_t has_state;
    uint8_t out[WH_BOARD_BYTES]; /* the frame to send */
    size_t out_size;             /* 0: none yet */
    uint32_t sent;               /* answers since wh_board_init */
    uint32_t others;             /* states of a cell with another number of axes, which are not taken */
    wh_board_gathered_t in;
} wh_board_t;

/* Begins, after each reset of the board. `axes`: as many as the layout's machine has, at most WH_BOARD_AXES;
 * `waferhand layout` lists them in their order. `out` is then a hello: send it over UDP until a state comes,
 * because the simulator cannot know the board's address before. A serial line needs none. */
void wh_board_init(wh_board_t *board, size_t axes);

/* Takes a byte of the line. Cost: a few instructions, about 3,000 at a frame's end. */
wh_board_news_t wh_board_take(wh_board_t *board, uint8_t byte);

/* Makes the answer to the last state, in `out`: where each axis stands, mm or degrees, and bit g of `valves`
 * for each gripper g whose vacuum is on, or whose plunger closes. */
void wh_board_answer(wh_board_t *board, const double axes[], uint32_t valves);

/* ------------------------------------------------------- of both sides: a board need not call these */

/* Takes a byte of a frame of this kind. Returns the frame's size once it is whole and its sum is right; the
 * frame stays in `bytes` until the next call. Otherwise 0. */
size_t wh_board_gather(wh_board_gathered_t *in, uint8_t kind, uint8_t byte);

/* CRC-32 (IEEE 802.3: reflected, 0xEDB88320, begins and ends with all ones). */
uint32_t wh_board_sum(const uint8_t bytes[], size_t size);

/* Little-endian numbers of 1 to 8 bytes. */
void wh_board_put(uint8_t bytes[], size_t size, uint64_t value);
uint64_t wh_board_get(const uint8_t bytes[], size_t size);

/* Writes begin, kind, version, axes and number; and the sum into the last four of `size` bytes. */
void wh_board_open(uint8_t bytes[], uint8_t kind, uint8_t axes, uint32_t number);
void wh_board_seal(uint8_t bytes[], size_t size);

#ifdef __cplusplus
}
#endif

#endif
