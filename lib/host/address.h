/* Where a server listens: ADDRESS:PORT in numbers; no names are looked up. */
#ifndef WH_HOST_ADDRESS_H
#define WH_HOST_ADDRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/socket.h>

/* Says what a text for wh_address_read looks like. */
#define WH_ADDRESS_EXPECTED "ADDRESS:PORT in numbers, such as 127.0.0.1:5000, or PORT from 0 to 65535"

/* An address with its port, IPv4 or IPv6. */
typedef struct {
    struct sockaddr_storage bytes;
    socklen_t size;
} wh_address_t;

/* Reads "ADDRESS:PORT", "[ADDRESS]:PORT", or "PORT", which is at 127.0.0.1. False if the text is none. */
bool wh_address_read(const char *text, wh_address_t *address);

/* Writes "127.0.0.1:5000" or "[::1]:5000". */
void wh_address_write(const wh_address_t *address, char *text, size_t size);

/* True for a loopback address, which nobody reaches from another machine. */
bool wh_address_is_local(const wh_address_t *address);

/* True for the address that stands for all of this machine's: 0.0.0.0 or [::]. */
bool wh_address_is_any(const wh_address_t *address);

#endif
