#include "origin.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* "http://", the longest address in numbers and its port. */
#define PLACE_BYTES 80

static const char *port_of(const wh_address_t *place, char text[PLACE_BYTES]) {
    wh_address_write(place, text, PLACE_BYTES);
    return strrchr(text, ':') + 1;
}

/* Browsers leave out the port 80. */
static bool has_port(const char *host, const char *port) {
    const char *colon = strrchr(host, ':');
    const bool has_none = !colon || strchr(colon, ']');
    return has_none ? strcmp(port, "80") == 0 : strcmp(colon + 1, port) == 0;
}

/* The host's address, read with any port; false if it is a name. */
static bool read_host(const char *host, wh_address_t *address) {
    char text[PLACE_BYTES];
    const char *colon = strrchr(host, ':');
    const bool has_none = !colon || strchr(colon, ']');
    const int length = snprintf(text, sizeof text, "%s%s", host, has_none ? ":80" : "");
    return length > 0 && (size_t)length < sizeof text && wh_address_read(text, address);
}

static bool is_localhost(const char *host) {
    return strncasecmp(host, "localhost", 9) == 0 && (host[9] == ':' || host[9] == '\0');
}

static bool is_same(const wh_address_t *a, const wh_address_t *b) {
    char left[PLACE_BYTES];
    char right[PLACE_BYTES];
    wh_address_write(a, left, sizeof left);
    wh_address_write(b, right, sizeof right);
    return strcmp(left, right) == 0;
}

static bool is_ours(const wh_address_t *place, const char *host) {
    char text[PLACE_BYTES];
    wh_address_t asked;
    const bool is_open = wh_address_is_local(place) || wh_address_is_any(place);
    if (!has_port(host, port_of(place, text))) {
        return false;
    }
    if (is_localhost(host)) {
        return is_open;
    }
    if (!read_host(host, &asked)) {
        return false;
    }
    return wh_address_is_any(place) || is_same(place, &asked) ||
           (wh_address_is_local(place) && wh_address_is_local(&asked));
}

/* False for a script of another site. */
static bool is_own_origin(const wh_origin_headers_t *headers) {
    return !headers->origin || (strncmp(headers->origin, "http://", 7) == 0 &&
                                strcasecmp(headers->origin + 7, headers->host) == 0);
}

/* False for a request that another site has caused, unless a person follows its link to the page. */
static bool is_own_site(const wh_origin_headers_t *headers, bool is_page) {
    const bool is_own =
        !headers->site || strcmp(headers->site, "same-origin") == 0 || strcmp(headers->site, "none") == 0;
    return is_own || (is_page && headers->mode && strcmp(headers->mode, "navigate") == 0);
}

const char *wh_origin_refusal(const wh_address_t *place, const wh_origin_headers_t *headers, bool is_page) {
    if (!headers->host) {
        return "the request names no Host";
    }
    if (!is_ours(place, headers->host)) {
        return "the Host is not this server (expected its address and port in numbers)";
    }
    if (!is_own_origin(headers)) {
        return "the Origin is another site (expected this server's own page)";
    }
    return is_own_site(headers, is_page) ? NULL : "another site asks (expected this server's own page)";
}
