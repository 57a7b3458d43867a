#include "serve_ports.h"

#include <stdio.h>

#include "serve_beside.h"

const wh_option_t wh_serve_ports_options[] = {
    {"dialect", 0, "FILE", "How the next port's controller talks: a Lua file, see lua/dialects/README.md",
     WH_OPTION_LIST, .variable = offsetof(wh_serve_ports_t, dialects)},
    {"mechanism", 0, "NAME",
     "The dialect before it speaks for this: a robot or a station of the layout, such as an "
     "aligner (default: what its dialect says, else the whole cell)",
     WH_OPTION_LIST, .variable = offsetof(wh_serve_ports_t, mechanisms)},
    {"unit", 0, "ADDRESS",
     "The dialect before it is the unit of this address on its line; without a port of its own on the line "
     "of "
     "the dialect before that",
     WH_OPTION_LIST, .variable = offsetof(wh_serve_ports_t, units)},
    {"tcp", 0, "ADDRESS:PORT",
     "A dialect's port: listen there; without an address at 127.0.0.1, 0 is any port", WH_OPTION_LIST,
     .variable = offsetof(wh_serve_ports_t, tcp)},
    {"pty", 0, "LINK", "A dialect's port: a serial line, to which this link leads", WH_OPTION_LIST,
     .variable = offsetof(wh_serve_ports_t, pty)},
    {0}};

void wh_serve_ports_check(const void *filled, struct argp_state *state) {
    const wh_serve_ports_t *arguments = filled;
    const size_t ports = arguments->tcp.count + arguments->pty.count;
    if (arguments->dialects.count == 0) {
        argp_error(state, "which --dialect?");
    }
    if (ports + arguments->units.count < arguments->dialects.count || ports == 0 || ports > WH_HOST_PORTS ||
        arguments->dialects.count > WH_HOST_PORTS) {
        argp_error(state,
                   "%zu --dialect, %zu --tcp and --pty (expected one port for each dialect, at most %d)",
                   arguments->dialects.count, ports, WH_HOST_PORTS);
    }
}

/* ------------------------------------------------------------------------------------ on the command line */

/* The argument of the command line that it is, or belongs to. */
static int place_of(int argc, char **argv, const char *item) {
    for (int i = 0; i < argc; ++i) {
        for (const char *c = argv[i];; ++c) {
            if (c == item) {
                return i;
            }
            if (*c == '\0') {
                break;
            }
        }
    }
    return argc;
}

static bool open_port(wh_host_t *host, const wh_host_port_t *port) {
    const size_t first = host->count;
    if (!(port->dialect ? wh_host_add : wh_host_add_port)(host, port)) {
        fprintf(stderr, "%s\n", host->controllers[host->count - 1]->dialect->message);
        return false;
    }
    wh_serve_beside_tell(host, host->controllers[first], host->controllers[first]->dialect->name);
    return true;
}

/* The next port of the command line, of either kind. */
typedef struct {
    const wh_serve_ports_t *arguments;
    int argc;
    char **argv;
    size_t tcp, pty; /* taken so far */
} addresses_t;

/* The option of this list between this dialect and the next one, such as its mechanism; null: there is
 * none. */
static const char *option_of(const addresses_t *at, size_t dialect, const wh_option_list_t *list) {
    const wh_option_list_t *dialects = &at->arguments->dialects;
    const int begin = place_of(at->argc, at->argv, dialects->items[dialect]);
    const int end =
        dialect + 1 < dialects->count ? place_of(at->argc, at->argv, dialects->items[dialect + 1]) : at->argc;
    const char *found = NULL;
    for (size_t i = 0; i < list->count && !found; ++i) {
        const int place = place_of(at->argc, at->argv, list->items[i]);
        found = place > begin && place < end ? list->items[i] : NULL;
    }
    return found;
}

/* False: none is left. */
static bool take_address(addresses_t *at, wh_host_port_t *port) {
    const wh_serve_ports_t *arguments = at->arguments;
    const bool has_tcp = at->tcp < arguments->tcp.count;
    const bool has_pty = at->pty < arguments->pty.count;
    const int tcp = has_tcp ? place_of(at->argc, at->argv, arguments->tcp.items[at->tcp]) : at->argc;
    const int pty = has_pty ? place_of(at->argc, at->argv, arguments->pty.items[at->pty]) : at->argc;
    port->is_pty = pty < tcp;
    if (has_tcp || has_pty) {
        port->address = port->is_pty ? arguments->pty.items[at->pty++] : arguments->tcp.items[at->tcp++];
    }
    return has_tcp || has_pty;
}

static bool refuse_count(const wh_host_t *host, const addresses_t *at) {
    const size_t given = at->arguments->tcp.count + at->arguments->pty.count;
    const wh_dialect_t *dialect = host->count > 0 ? host->controllers[host->count - 1]->dialect : NULL;
    if (dialect && wh_host_needs_port(host)) {
        fprintf(stderr, "%s: %zu --tcp and --pty (expected one for each of the %zu ports that it names)\n",
                dialect->path, given, dialect->clients.port_count);
    } else {
        fprintf(stderr, "%zu --tcp and --pty (expected %zu, one for each dialect or port that it names)\n",
                given, at->tcp + at->pty);
    }
    return false;
}

/* Opens a dialect with all of its ports, each at the next address. */
static bool open_dialect(wh_host_t *host, addresses_t *at, size_t i) {
    const wh_serve_ports_t *arguments = at->arguments;
    wh_host_port_t port = {.dialect = arguments->dialects.items[i],
                           .mechanism = option_of(at, i, &arguments->mechanisms),
                           .unit = option_of(at, i, &arguments->units)};
    port.shares_line = port.unit && !option_of(at, i, &arguments->tcp) && !option_of(at, i, &arguments->pty);
    if (port.shares_line) {
        return open_port(host, &port);
    }
    bool good = (take_address(at, &port) || refuse_count(host, at)) && open_port(host, &port);
    while (good && wh_host_needs_port(host)) {
        port.dialect = NULL;
        good = (take_address(at, &port) || refuse_count(host, at)) && open_port(host, &port);
    }
    return good;
}

/* False if an option that belongs to a dialect stands before all of them, or twice behind one. */
static bool are_placed(const addresses_t *at, const char *option, const wh_option_list_t *list) {
    size_t placed = 0;
    for (size_t i = 0; i < at->arguments->dialects.count; ++i) {
        placed += option_of(at, i, list) ? 1 : 0;
    }
    if (placed < list->count) {
        fprintf(stderr, "%s: %zu of %zu (expected one behind each --dialect at most)\n", option, placed,
                list->count);
    }
    return placed == list->count;
}

bool wh_serve_ports_open(const wh_serve_ports_t *arguments, wh_host_t *host, int argc, char **argv) {
    addresses_t at = {.arguments = arguments, .argc = argc, .argv = argv};
    for (size_t i = 0; i < arguments->dialects.count; ++i) {
        if (!open_dialect(host, &at, i)) {
            return false;
        }
    }
    if (at.tcp + at.pty < arguments->tcp.count + arguments->pty.count) {
        return refuse_count(host, &at);
    }
    return are_placed(&at, "--mechanism", &arguments->mechanisms) &&
           are_placed(&at, "--unit", &arguments->units);
}

void wh_serve_ports_free(wh_serve_ports_t *arguments) {
    wh_option_list_free(&arguments->dialects);
    wh_option_list_free(&arguments->mechanisms);
    wh_option_list_free(&arguments->units);
    wh_option_list_free(&arguments->tcp);
    wh_option_list_free(&arguments->pty);
}
