/* Philox4x32-10: a counter-based generator of random bits.
 *
 * Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3", SC11, section 3.3. Ten rounds
 * of two 32-bit products mix a 128-bit counter under a 64-bit key. Equal counter and key give equal bits on
 * every machine, and there is no state: numbered draws need no order.
 */
#ifndef WH_MATH_PHILOX_H
#define WH_MATH_PHILOX_H

#include "config.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(philox);

typedef struct {
    uint32_t words[4];
} wh_philox_t;

/* The 128 bits of a counter under a key. It has no state and cannot fail. Cost: about 15 ns. */
wh_philox_t wh_philox(const uint32_t counter[4], const uint32_t key[2]) WH_SYMBOL(wh_philox);

WH_HEADER_END

#endif
