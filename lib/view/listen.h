/* The socket at which a page's server listens, and what a browser is told of it. */
#ifndef WH_VIEW_LISTEN_H
#define WH_VIEW_LISTEN_H

#include "../host/address.h"
#include "http.h"

/* Listens at an address for wh_address_read, or, if the text is empty, at the usual port of 127.0.0.1; at any
 * port there if another server has it. Returns the socket, which is the caller's, and `address` is where it
 * listens. Below 0: it cannot, and `problem` says why. */
int wh_listen_open(const char *text, wh_address_t *address, char problem[WH_HTTP_PROBLEM_BYTES]);

/* Writes the place as a browser finds it: 0.0.0.0, to which none goes, is 127.0.0.1, and [::] is [::1]. */
void wh_listen_name(const wh_address_t *place, char text[WH_HTTP_PLACE_BYTES]);

#endif
