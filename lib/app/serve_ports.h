/* The ports of `waferhand serve`: each dialect with its mechanism, and where its ports listen, in the order
 * of the command line. */
#ifndef WH_APP_SERVE_PORTS_H
#define WH_APP_SERVE_PORTS_H

#include "../host/host.h"
#include "../text/options.h"

/* Zero it to begin with. */
typedef struct {
    wh_option_list_t dialects, mechanisms, units, tcp, pty;
} wh_serve_ports_t;

/* --dialect, --mechanism, --unit, --tcp and --pty, into a wh_serve_ports_t; the check of their table. */
extern const wh_option_t wh_serve_ports_options[];
void wh_serve_ports_check(const void *filled, struct argp_state *state);

/* Opens all of them, and says on standard error where each is, or what is wrong: then it is false. */
bool wh_serve_ports_open(const wh_serve_ports_t *arguments, wh_host_t *host, int argc, char **argv);

void wh_serve_ports_free(wh_serve_ports_t *arguments);

#endif
