/* The check at the end of commands and states: a datagram in which a bit has flipped is no message.
 *
 * h = 0x6a09e667f3bcc908; for each eight bytes of the encoded message but the last eight, as a big-endian word w, the last of
 * them filled up with zeros:  h = (h ^ w) * 0x9e3779b97f4a7c15;  h = h ^ (h >> 32).  A result of 0 is written as 1: 0 says
 * that the sender makes no checks.
 */
#ifndef WH_LINK_CHECKSUM_H
#define WH_LINK_CHECKSUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Writes the check over the last eight of `size` bytes. Nothing happens to less than eight. Cost: about 2 ns a word. */
void wh_link_seal(uint8_t *bytes, size_t size);

/* Whether the check is right, or 0. */
bool wh_link_is_intact(const void *data, size_t size);

#endif
