/* What a number that changes from slice to slice will be: coder and decoder of a block foretell it the
 * same way, so that only the miss is to be written. lcm_types/README.md has the rule.
 *
 * Each of the polynomials of degree 0 to 6 through the last values tells one: axes are cubic in time,
 * poses are smooth. The one that was best of late is taken. Doubles go in and out as their bits.
 */
#ifndef WH_LINK_PREDICTION_H
#define WH_LINK_PREDICTION_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define WH_PREDICTION_ORDERS 7

/* A double's bits, and the double that has them. */
static inline uint64_t wh_prediction_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double wh_prediction_double(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Zero it to begin with. */
typedef struct {
    size_t seen;
    uint64_t last;
    double differences[WH_PREDICTION_ORDERS]; /* of order 0, the last value, to 6 */
    uint64_t guesses[WH_PREDICTION_ORDERS];   /* bits, by each order */
    uint32_t scores[WH_PREDICTION_ORDERS];    /* how badly each order has guessed of late */
} wh_prediction_t;

/* By how much the next value misses what was foretold: 0 or a small number if it was nearly right, one of 64
 * bits at worst. Then the value counts as seen. Cost: 20 ns. */
uint64_t wh_prediction_miss(wh_prediction_t *prediction, uint64_t bits);

/* The value that misses by so much. Then it counts as seen. Cost: 20 ns. */
uint64_t wh_prediction_mend(wh_prediction_t *prediction, uint64_t miss);

#endif
