/* The board of tests/firmware/board.h on a Cortex-M3, QEMU's lm3s6965evb: its line is UART 0, whose 16 bytes of
 * queue let an emulator keep up with a kilohertz. Between two frames the processor sleeps. */
#include "firmware/board.h"

enum {
    UART = 0x4000C000, /* a PL011 */
    DATA = 0x00,
    FLAGS = 0x18,
    FORMAT = 0x2C,
    CONTROL = 0x30,
    INTERRUPTS = 0x38,
    CLEARED = 0x44,
    NOTHING_CAME = 1 << 4,
    SEND_FULL = 1 << 5,
    EIGHT_BITS_QUEUED = 0x70,
    ON = 0x301,
    CAME = 1 << 4,
    UART_INTERRUPT = 1 << 5 /* of the processor's interrupts */
};

static volatile uint32_t *at(uint32_t address) {
    return (volatile uint32_t *)(uintptr_t)address;
}

static void send(const uint8_t bytes[], size_t size) {
    for (size_t i = 0; i < size; ++i) {
        while ((*at(UART + FLAGS) & SEND_FULL) != 0) {
        }
        *at(UART + DATA) = bytes[i];
    }
}

/* An interrupt that is pending ends the sleep, though no handler runs. */
static void sleep_until_byte(void) {
    __asm volatile("wfi");
    *at(UART + CLEARED) = CAME;
    *at(0xE000E280) = UART_INTERRUPT;
}

int main(void) {
    __asm volatile("cpsid i");
    board_begin();
    *at(UART + FORMAT) = EIGHT_BITS_QUEUED;
    *at(UART + CONTROL) = ON;
    *at(UART + INTERRUPTS) = CAME;
    *at(0xE000E100) = UART_INTERRUPT;
    for (;;) {
        if ((*at(UART + FLAGS) & NOTHING_CAME) == 0) {
            if (board_take((uint8_t)*at(UART + DATA))) {
                send(board.out, board.out_size);
            }
        } else if (board.in.count == board.in.taken) {
            sleep_until_byte();
        }
    }
}
