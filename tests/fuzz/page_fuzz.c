/* Any bytes as a request to the server of a live page: its headers, or the body of a command.
 *
 * The first byte chooses. No header lets in a client that is not the page itself. A body is answered by one object
 * of JSON; without the token, or if it is refused, nothing has changed. An accepted line comes out as it was
 * given. */
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "app/live_control.h"
#include "fuzz.h"
#include "host/address.h"
#include "text/json.h"
#include "view/origin.h"

#define TOKEN "0123456789abcdef0123456789abcdef"
#define HEADERS 4

/* ------------------------------------------------------------------------------------------------ headers */

/* Rebinding needs a name: only numbers are let in, and localhost where it is this machine. */
static void check_host(const char *host, const char *place) {
    const char *port = strrchr(place, ':') + 1;
    const char *colon = strrchr(host, ':');
    REQUIRE(colon && strcmp(colon + 1, port) == 0);
    if (strncasecmp(host, "localhost:", 10) == 0) {
        REQUIRE(strstr(place, "192.") == NULL);
        return;
    }
    for (const char *c = host; *c != '\0'; ++c) {
        REQUIRE(isxdigit((unsigned char)*c) || strchr(".:[]", *c) != NULL);
    }
}

/* A line each: Host, Origin, Sec-Fetch-Site, Sec-Fetch-Mode; one that begins with - is missing. */
static void split(char *text, char *fields[HEADERS]) {
    for (size_t i = 0; i < HEADERS && text; ++i) {
        char *next = strchr(text, '\n');
        if (next) {
            *next++ = '\0';
        }
        fields[i] = text[0] != '-' ? text : NULL;
        text = next;
    }
}

static void check_headers(uint8_t choice, char *text) {
    static const char *const places[] = {"127.0.0.1:8765", "0.0.0.0:8765", "192.168.1.7:8765", "[::1]:8765"};
    const char *place = places[choice % 4U];
    char *fields[HEADERS] = {NULL};
    wh_address_t address;
    REQUIRE(wh_address_read(place, &address));
    split(text, fields);
    const wh_origin_headers_t headers = {fields[0], fields[1], fields[2], fields[3]};
    const bool is_page = (choice & 4U) != 0;
    if (wh_origin_refusal(&address, &headers, is_page)) {
        return;
    }
    REQUIRE(headers.host);
    check_host(headers.host, place);
    REQUIRE(!headers.origin || (strncmp(headers.origin, "http://", 7) == 0 &&
                                strcasecmp(headers.origin + 7, headers.host) == 0));
    REQUIRE(!headers.site || is_page || strcmp(headers.site, "same-origin") == 0 ||
            strcmp(headers.site, "none") == 0);
}

/* --------------------------------------------------------------------------------------------- commands */

static bool is_same(const wh_live_control_t *a, const wh_live_control_t *b) {
    return a->is_paused == b->is_paused && a->ends_at_command == b->ends_at_command &&
           a->slices == b->slices && a->rate_ppm == b->rate_ppm && a->lines.waiting == b->lines.waiting &&
           a->requests == b->requests;
}

static bool has_token(const char *body, size_t size) {
    json_t *request = json_loadb(body, size, JSON_REJECT_DUPLICATES, NULL);
    const char *token = json_string_value(json_object_get(request, "token"));
    const bool has = token && strcmp(token, TOKEN) == 0;
    json_decref(request);
    return has;
}

static void check_line(const wh_live_line_t *line, const char *body, size_t size) {
    json_t *request = json_loadb(body, size, JSON_REJECT_DUPLICATES, NULL);
    const char *given = json_string_value(json_object_get(request, line->completes ? "complete" : "line"));
    REQUIRE(given && strcmp(given, line->text) == 0 && strpbrk(given, "\r\n") == NULL);
    json_decref(request);
}

static void check_answer(unsigned status, char *answer, bool *is_accepted) {
    REQUIRE(status == 200 || status == 202 || status == 400 || status == 403 || status == 503);
    json_t *told = json_loads(answer, JSON_REJECT_DUPLICATES, NULL);
    REQUIRE(json_is_object(told) && fuzz_is_one_line(answer));
    *is_accepted = json_is_true(json_object_get(told, "ok"));
    REQUIRE(*is_accepted == (status < 400));
    json_decref(told);
    free(answer);
}

/* Pauses, steps and a pace are those of slices that wait, within their limits. */
static void check_pace(const wh_live_control_t *before, const wh_live_control_t *control) {
    REQUIRE(control->paces || (control->slices == 0 && (!control->is_paused || before->is_paused)));
    REQUIRE(control->rate_ppm >= 0 && control->rate_ppm <= 1000000000 && control->slices <= 1000000);
}

static void check_lines(wh_live_control_t *control, unsigned status, const char *body, size_t size) {
    wh_live_line_t line;
    if (wh_live_lines_take(&control->lines, &line)) {
        REQUIRE(status == 202 && control->controlled == WH_LIVE_PROMPT && line.number == control->requests);
        check_line(&line, body, size);
    }
}

static void check_command(uint8_t choice, const char *body, size_t size) {
    static const wh_live_controlled_t kinds[] = {WH_LIVE_RUN, WH_LIVE_TESTER, WH_LIVE_PROMPT, WH_LIVE_PROMPT};
    wh_live_control_t control = {.is_paused = (choice & 4U) != 0};
    bool is_accepted;
    char *answer = NULL;
    REQUIRE(wh_live_control_begin(&control, kinds[choice % 4U], choice % 4U != 3, 1));
    memcpy(control.token, TOKEN, sizeof TOKEN);
    const wh_live_control_t before = control;
    const unsigned status = wh_live_control_take(&control, body, size, &answer);
    check_answer(status, answer, &is_accepted);
    REQUIRE(has_token(body, size) || (!is_accepted && (status == 403 || status == 400)));
    REQUIRE(is_accepted || status == 503 || is_same(&before, &control));
    check_pace(&before, &control);
    check_lines(&control, status, body, size);
    wh_live_control_end(&control);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    char *text = malloc(size);
    REQUIRE(text != NULL);
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    if (data[0] >= 0x80) {
        check_headers(data[0], text);
    } else {
        check_command(data[0], text, size - 1);
    }
    free(text);
    return 0;
}
