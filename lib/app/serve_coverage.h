/* `waferhand serve --coverage FILE`: how often hosts were shown each error. */
#ifndef WH_APP_SERVE_COVERAGE_H
#define WH_APP_SERVE_COVERAGE_H

#include "../host/host.h"

/* False, with a message: the file is there and holds something else. It is for before the first client: at
 * the end it would be too late. Null: no file is wanted. */
bool wh_serve_coverage_check(const char *path);

/* Adds the host's counts to those of the file, and writes it. False, with a message: it cannot. */
bool wh_serve_coverage_keep(const char *path, wh_host_t *host);

#endif
