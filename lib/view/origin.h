/* Tells the requests of a page itself, which its server answers, from all others.
 *
 * Any web site can make a browser send requests to this machine. Two headers tell it apart, which no site
 * can forge. `Host` names the server that the browser believes to ask: after a change of its DNS entry
 * (rebinding) a hostile site has a name of its own there, and a page of ours has the address. `Origin` names
 * the site whose script asks.
 */
#ifndef WH_VIEW_ORIGIN_H
#define WH_VIEW_ORIGIN_H

#include <stdbool.h>
#include <stdint.h>

#include "../host/address.h"

/* The headers of a request; null: it has none. */
typedef struct {
    const char *host, *origin;
    const char *site; /* Sec-Fetch-Site */
    const char *mode; /* Sec-Fetch-Mode */
} wh_origin_headers_t;

/* Null if the server that listens at `place` may answer, else the reason in words. A host is accepted if it
 * is the place's address and port; of a place on this machine alone also "localhost" and the other loopback
 * addresses; of 0.0.0.0 and [::] any address in numbers, for a name is what rebinding needs. `is_page`: the
 * page itself is asked for, which other sites may link to. */
const char *wh_origin_refusal(const wh_address_t *place, const wh_origin_headers_t *headers, bool is_page);

#endif
