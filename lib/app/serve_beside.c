#include "serve_beside.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/json.h"
#include "apart.h"

const wh_option_t wh_serve_beside_options[] = {
    {"control", 0, "ADDRESS:PORT",
     "Listen there for a tester beside the hosts: JSON lines, see lua/dialects/serving.md", WH_OPTION_TEXT,
     .variable = offsetof(wh_serve_beside_t, control)},
    {"ready", 0, "FILE", "Write this file, with all ports as JSON, once they listen", WH_OPTION_TEXT,
     .variable = offsetof(wh_serve_beside_t, ready)},
    {"allow", 0, "ADDRESS[/BITS]",
     "Let only this machine and these addresses connect; may be given more than once", WH_OPTION_LIST,
     .variable = offsetof(wh_serve_beside_t, allowed)},
    {0}};

bool wh_serve_beside_allow(const wh_serve_beside_t *beside, wh_allow_t *allow) {
    for (size_t i = 0; i < beside->allowed.count; ++i) {
        if (!wh_allow_add(allow, beside->allowed.items[i])) {
            fprintf(
                stderr,
                "--allow %s: no address (expected one in numbers, such as 192.168.0.7 or 192.168.0.0/24, at "
                "most %d of them)\n",
                beside->allowed.items[i], WH_ALLOW_MOST);
            return false;
        }
    }
    return true;
}

void wh_serve_beside_tell(const wh_host_t *host, const wh_controller_t *controller, const char *what) {
    const char *warning = "";
    const wh_port_t *port = &controller->carrier->line.port;
    if (!port->is_local) {
        warning = host->allow ? ": the allowed addresses can command it"
                              : ": whoever reaches this machine can command it";
    }
    fprintf(stderr, "serve: %s, %s, at %s%s%s%s\n", controller->name, what, port->place,
            controller->unit ? " as unit " : "", controller->unit ? controller->unit : "", warning);
}

bool wh_serve_beside_open(const wh_serve_beside_t *beside, wh_host_t *host) {
    if (!beside->control) {
        return true;
    }
    const size_t first = host->count;
    if (!wh_host_add_control(host, beside->control)) {
        fprintf(stderr, "--control %s\n", host->controllers[host->count - 1]->dialect->message);
        return false;
    }
    wh_serve_beside_tell(host, host->controllers[first], host->controllers[first]->dialect->name);
    return true;
}

static json_t *describe_port(const wh_controller_t *controller) {
    const char *place = controller->carrier->line.port.place;
    const char *colon = strrchr(place, ':');
    json_t *port = json_object();
    wh_json_put(port, "name", wh_json_text(controller->name));
    wh_json_put(port, "dialect", wh_json_text(controller->dialect->path));
    if (controller->unit) {
        wh_json_put(port, "unit", wh_json_text(controller->unit));
    }
    if (colon && strchr(place, '/') == NULL) {
        char host[WH_PORT_PLACE_BYTES];
        const bool has_brackets = place[0] == '[';
        const size_t length = (size_t)(colon - place) - (has_brackets ? 2 : 0);
        memcpy(host, place + (has_brackets ? 1 : 0), length);
        host[length] = '\0';
        wh_json_put(port, "address", wh_json_text(host));
        wh_json_put(port, "number", json_integer(strtol(colon + 1, NULL, 10)));
    } else {
        wh_json_put(port, "pty", wh_json_text(place));
    }
    return port;
}

static bool write_ready(void *user, FILE *out) {
    const wh_host_t *host = user;
    json_t *ready = json_object();
    json_t *ports = json_array();
    wh_json_put(ready, "pid", json_integer(getpid()));
    for (size_t i = 0; i < host->count; ++i) {
        if (wh_host_is_first_of_port(host, i) && host->controllers[i]->leader->is_tester) {
            wh_json_put(ready, "control", describe_port(host->controllers[i]));
        } else if (wh_host_is_first_of_port(host, i)) {
            wh_json_append(ports, describe_port(host->controllers[i]));
        }
    }
    wh_json_put(ready, "ports", ports);
    return wh_json_print(ready, out) == 0;
}

bool wh_serve_beside_forget(const wh_serve_beside_t *beside) {
    struct stat found;
    const bool is_old = beside->ready && stat(beside->ready, &found) == 0 && S_ISREG(found.st_mode);
    if (is_old && unlink(beside->ready) != 0) {
        fprintf(stderr, "--ready %s: the old file cannot be removed: %s\n", beside->ready, strerror(errno));
        return false;
    }
    return true;
}

bool wh_serve_beside_ready(const wh_serve_beside_t *beside, const wh_host_t *host) {
    union {
        const wh_host_t *host;
        void *user;
    } told = {host};
    return !beside->ready || wh_file_write("--ready", beside->ready, write_ready, told.user, NULL);
}
