/* The addresses that may connect to a port that other machines reach, and the bits of them that count. This
 * machine itself always may.
 *
 * Constant once it is filled in: any thread may use it. */
#ifndef WH_HOST_ALLOW_H
#define WH_HOST_ALLOW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WH_ALLOW_MOST 16

/* The first `bits` of an address; IPv4 stands in its form of 16 bytes. */
typedef struct {
    uint8_t bytes[16];
    unsigned bits; /* 0 to 128 */
} wh_allowed_t;

/* Zero: only this machine. */
typedef struct {
    size_t count;
    wh_allowed_t of[WH_ALLOW_MOST];
} wh_allow_t;

struct sockaddr;

/* Adds "192.168.0.7", "192.168.0.0/24", "fe80::1" or "fe80::/10". False: it is no such text, or there are
 * WH_ALLOW_MOST. */
bool wh_allow_add(wh_allow_t *allow, const char *text);

bool wh_allow_has(const wh_allow_t *allow, const struct sockaddr *from);

#endif
