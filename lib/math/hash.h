/* A 64-bit hash of words in a fixed order, equal on machines of either byte order. It is not
 * cryptographic. */
#ifndef WH_MATH_HASH_H
#define WH_MATH_HASH_H

#include <string.h>

#include "pose.h"

WH_HEADER_BEGIN

#define WH_HASH_START UINT64_C(0x6a09e667f3bcc908)

/* The shift brings high bits down; with a product alone two flipped signs would cancel each other. */
static inline uint64_t wh_hash_word(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ (hash >> 32);
}

static inline uint64_t wh_hash_int(uint64_t hash, int32_t value) {
    return wh_hash_word(hash, (uint64_t)(int64_t)value);
}

/* It uses the bits, so -0 and 0 differ. */
static inline uint64_t wh_hash_real(uint64_t hash, wh_real_t value) {
    wh_real_bits_t bits;
    memcpy(&bits, &value, sizeof bits);
    return wh_hash_word(hash, bits);
}

/* A double's bits as a word, also where wh_real_t is float. NaNs that an operation gives differ from
 * machine to machine. */
static inline uint64_t wh_double_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline uint64_t wh_hash_doubles(uint64_t hash, const double values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = wh_hash_word(hash, wh_double_bits(values[i]));
    }
    return hash;
}

static inline uint64_t wh_hash_ints(uint64_t hash, const int32_t values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = wh_hash_int(hash, values[i]);
    }
    return hash;
}

/* The bytes of a text, and its end: neighbours in a list of texts cannot run into each other. */
static inline uint64_t wh_hash_text(uint64_t hash, const char *text) {
    for (const char *c = text; *c; ++c) {
        hash = wh_hash_word(hash, (unsigned char)*c);
    }
    return wh_hash_word(hash, 0);
}

static inline uint64_t wh_hash_vec3(uint64_t hash, const wh_vec3_t *v) {
    hash = wh_hash_real(hash, v->x);
    hash = wh_hash_real(hash, v->y);
    return wh_hash_real(hash, v->z);
}

static inline uint64_t wh_hash_pose(uint64_t hash, const wh_pose_t *pose) {
    for (size_t row = 0; row < 3; ++row) {
        for (size_t column = 0; column < 3; ++column) {
            hash = wh_hash_real(hash, pose->R.m[row][column]);
        }
    }
    return wh_hash_vec3(hash, &pose->r);
}

WH_HEADER_END

#endif
