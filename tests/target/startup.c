/* The code that a Cortex-M of QEMU's mps2 boards needs before newlib's own start: vectors, and the
 * floating-point unit. Host files, arguments and the exit status come by semihosting
 * (rdimon.specs). */
#include <stdint.h>
#include <stdlib.h>

extern uint32_t stack_top;
void _start(void);
void reset(void);
void fault(void);

void reset(void) {
    volatile uint32_t *const coprocessor_access = (volatile uint32_t *)0xe000ed88;
    *coprocessor_access |= 0xfU << 20;
    __asm volatile("dsb\n\tisb");
    _start();
}

/* Any exception ends the run, so that a test cannot hang in one. */
void fault(void) {
    _Exit(99);
}

typedef union {
    uint32_t *stack;
    void (*handler)(void);
} vector_t;

__attribute__((section(".vectors"), used)) static const vector_t vectors[16] = {
    {.stack = &stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},    {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},    {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},    {.handler = fault}, {.handler = fault}, {.handler = fault}};
