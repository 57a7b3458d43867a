/* Others beside the hosts of `waferhand serve`: a tester at a port of its own, a program that waits until all
 * ports listen, and the addresses that may connect. */
#ifndef WH_APP_SERVE_BESIDE_H
#define WH_APP_SERVE_BESIDE_H

#include "../host/host.h"
#include "../text/options.h"

typedef struct {
    const char *control, *ready;
    wh_option_list_t allowed;
} wh_serve_beside_t;

/* --control, --ready and --allow, into a wh_serve_beside_t. */
extern const wh_option_t wh_serve_beside_options[];

/* Fills in who may connect. False, with a message: an address is none. */
bool wh_serve_beside_allow(const wh_serve_beside_t *beside, wh_allow_t *allow);

/* Opens the tester's port, if it is wanted, and says where it is. */
bool wh_serve_beside_open(const wh_serve_beside_t *beside, wh_host_t *host);

/* Says where a controller's port is, and who reaches it. */
void wh_serve_beside_tell(const wh_host_t *host, const wh_controller_t *controller, const char *what);

/* Removes such a file of an earlier run, before anything else can fail. False, with a message: it cannot. */
bool wh_serve_beside_forget(const wh_serve_beside_t *beside);

/* Writes the file that says that all ports listen. False, with a message: it cannot be written. */
bool wh_serve_beside_ready(const wh_serve_beside_t *beside, const wh_host_t *host);

#endif
