#include "prediction.h"

#include <string.h>

#define ORDERS WH_PREDICTION_ORDERS
#define SIGN (UINT64_C(1) << 63)

/* The bits as a number that grows with the value, so that neighbouring values differ by little. Done
 * twice, it is undone. */
static uint64_t rank_of(uint64_t bits) {
    return (bits & SIGN) != 0 ? bits ^ (SIGN - 1) : bits;
}

/* A difference of either sign as a number that is small if the difference is. */
static uint64_t fold(uint64_t difference) {
    return difference << 1 ^ ((difference & SIGN) != 0 ? UINT64_MAX : 0);
}

static uint64_t unfold(uint64_t folded) {
    return folded >> 1 ^ ((folded & 1) != 0 ? UINT64_MAX : 0);
}

static size_t best_order(const wh_prediction_t *prediction) {
    const size_t most = prediction->seen < ORDERS ? prediction->seen : ORDERS;
    size_t best = 0;
    for (size_t order = 1; order < most; ++order) {
        best = prediction->scores[order] < prediction->scores[best] ? order : best;
    }
    return best;
}

/* The rank of the next value, as far as one can tell. */
static uint64_t predict(wh_prediction_t *prediction) {
    double sum = 0;
    prediction->guesses[0] = prediction->last;
    for (size_t order = 1; order < ORDERS; ++order) {
        sum += prediction->differences[order];
        const double guess = prediction->differences[0] + sum;
        /* Which of many bits a sum that is no number has, differs from machine to machine. */
        prediction->guesses[order] = guess == guess ? wh_prediction_bits(guess) : prediction->last;
    }
    return rank_of(prediction->guesses[best_order(prediction)]);
}

static uint32_t length_of(uint64_t folded) {
    return 64U - (uint32_t)__builtin_clzll(folded | 1);
}

static void learn(wh_prediction_t *prediction, uint64_t bits) {
    double difference = wh_prediction_double(bits);
    for (size_t order = 0; prediction->seen > 0 && order < ORDERS; ++order) {
        const uint64_t miss = fold(rank_of(bits) - rank_of(prediction->guesses[order]));
        prediction->scores[order] = prediction->scores[order] / 2 + 8 * length_of(miss);
    }
    for (size_t order = 0; order < ORDERS; ++order) {
        const double next = difference - prediction->differences[order];
        prediction->differences[order] = difference;
        difference = next;
    }
    prediction->last = bits;
    ++prediction->seen;
}

uint64_t wh_prediction_miss(wh_prediction_t *prediction, uint64_t bits) {
    const uint64_t miss = fold(rank_of(bits) - predict(prediction));
    learn(prediction, bits);
    return miss;
}

uint64_t wh_prediction_mend(wh_prediction_t *prediction, uint64_t miss) {
    const uint64_t bits = rank_of(predict(prediction) + unfold(miss));
    learn(prediction, bits);
    return bits;
}
