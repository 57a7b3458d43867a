#include "philox.h"

/* The published multipliers and Weyl increments. */
#define MULTIPLIER_0 UINT64_C(0xD2511F53)
#define MULTIPLIER_1 UINT64_C(0xCD9E8D57)
#define INCREMENT_0 UINT32_C(0x9E3779B9)
#define INCREMENT_1 UINT32_C(0xBB67AE85)
#define ROUNDS 10

wh_philox_t wh_philox(const uint32_t counter[4], const uint32_t key[2]) {
    wh_philox_t x = {{counter[0], counter[1], counter[2], counter[3]}};
    uint32_t key_0 = key[0];
    uint32_t key_1 = key[1];
    for (int round = 0; round < ROUNDS; ++round) {
        const uint64_t product_0 = MULTIPLIER_0 * x.words[0];
        const uint64_t product_1 = MULTIPLIER_1 * x.words[2];
        const wh_philox_t next = {{(uint32_t)(product_1 >> 32) ^ x.words[1] ^ key_0, (uint32_t)product_1,
                                   (uint32_t)(product_0 >> 32) ^ x.words[3] ^ key_1, (uint32_t)product_0}};
        x = next;
        key_0 += INCREMENT_0;
        key_1 += INCREMENT_1;
    }
    return x;
}
