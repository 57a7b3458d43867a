#include "sim_board.h"

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "../loop/cable.h"
#include "../loop/exchange.h"
#include "../loop/pacing.h"
#include "../loop/plant.h"
#include "../text/json.h"
#include "app.h"
#include "connection.h"
#include "sim_board_told.h"

#define USUAL_BAUD 921600

/* A state that nobody answers is sent again after this time: before the first slice, and in lockstep. */
#define BEGIN_AGAIN_US 250000
#define LOCKSTEP_AGAIN_US 50000
/* Others than the board are served at least this often. */
#define TICK_US 100000
/* Lines of one kind that are said; later ones are counted alone. */
#define SAID 5

const wh_option_t wh_sim_board_options[] = {
    {"serial", 0, "DEVICE",
     "A controller's board drives the cell over this serial line, by the wall clock: see lib/manual/board.md",
     WH_OPTION_TEXT, .variable = offsetof(wh_sim_board_arguments_t, serial)},
    {"udp", 0, "ADDRESS:PORT", "Likewise over UDP: listen there, at 127.0.0.1 if only a port is given",
     WH_OPTION_TEXT, .variable = offsetof(wh_sim_board_arguments_t, udp)},
    {"baud", 0, "N", "The serial line's speed (default 921600)", WH_OPTION_WHOLE,
     .variable = offsetof(wh_sim_board_arguments_t, baud), 9600, 4e6},
    {"allow", 0, "ADDRESS[/BITS]",
     "With --udp: take frames from this machine and these addresses alone; may be given more than once",
     WH_OPTION_LIST, .variable = offsetof(wh_sim_board_arguments_t, allowed)},
    {"lag", 0, "SLICES",
     "The answer to the state of slice n drives slice n + SLICES (default 1), for lines that take longer",
     WH_OPTION_WHOLE, .variable = offsetof(wh_sim_board_arguments_t, lag), 1, WH_EXCHANGE_LAG},
    {"lockstep", 0, NULL,
     "Wait for each answer, however long it takes: for debuggers, emulators and lines that lose frames",
     WH_OPTION_FLAG, .variable = offsetof(wh_sim_board_arguments_t, lockstep)},
    {"seconds", 0, "S", "End once S seconds were simulated (default: at SIGINT or SIGTERM)", WH_OPTION_REAL,
     .variable = offsetof(wh_sim_board_arguments_t, seconds), 1e-3, 1e6},
    {"timeout", 0, "S",
     "Give up if no answer of the board comes for S seconds, at the beginning too (default: for ever)",
     WH_OPTION_REAL, .variable = offsetof(wh_sim_board_arguments_t, timeout_s), 1e-3, 1e6},
    {"lenient", 0, NULL, "Late, lost and damaged frames and resets of the board are told and do not fail it",
     WH_OPTION_FLAG, .variable = offsetof(wh_sim_board_arguments_t, lenient)},
    {0}};

/* Refuses an option that goes with a board alone. */
static void check_alone(const wh_sim_board_arguments_t *given, struct argp_state *state) {
    const struct {
        const char *name;
        bool is_given;
    } options[] = {{"baud", given->baud > 0},       {"allow", given->allowed.count > 0},
                   {"lag", given->lag > 0},         {"lockstep", given->lockstep},
                   {"seconds", given->seconds > 0}, {"timeout", given->timeout_s > 0},
                   {"lenient", given->lenient}};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; ++i) {
        if (options[i].is_given) {
            argp_error(state, "--%s: goes with a board (expected --serial or --udp as well)",
                       options[i].name);
        }
    }
}

void wh_sim_board_check(const void *filled, struct argp_state *state) {
    const wh_sim_board_arguments_t *given = filled;
    if (!wh_sim_board_is_wanted(given)) {
        check_alone(given, state);
        return;
    }
    if (given->serial && given->udp) {
        argp_error(state, "--serial and --udp: a cell has one board (expected one of the two)");
    }
    if (given->baud > 0 && !given->serial) {
        argp_error(state, "--baud: %" PRIu64 " (goes with --serial)", given->baud);
    }
    if (given->baud > 0 && !wh_cable_has_speed(given->baud)) {
        argp_error(state, "--baud: %" PRIu64 " (expected a speed of serial lines, such as 115200 or 921600)",
                   given->baud);
    }
    if (given->allowed.count > 0 && !given->udp) {
        argp_error(state, "--allow: goes with --udp");
    }
}

typedef struct {
    const wh_sim_board_arguments_t *arguments;
    const wh_node_t *node;
    wh_sim_board_told_t told; /* what is said at the end */
    wh_cable_t line;
    wh_allow_t allow;
    wh_board_gathered_t in;
    wh_exchange_t exchange;
    wh_plant_t plant;
    wh_pacing_t pacing;
    wh_status_t status; /* of the last command */
    bool is_begun;      /* the first slice may come */
    bool is_over;
    int64_t sent_us, heard_us, ticked_us;
    unsigned said[WH_EXCHANGE_NEWS + 2]; /* lines of each kind of news, of axes, and of held slices */
} session_t;

enum { SAID_AXES = WH_EXCHANGE_NEWS, SAID_HELD };

/* ------------------------------------------------------------------------------------------------ hearing */

/* True the first few times. */
static bool may_say(session_t *session, size_t kind) {
    return session->said[kind]++ < SAID;
}

/* The frame is not taken: why not. */
static void say_news(session_t *session, wh_exchange_news_t news, const uint8_t frame[]) {
    static const char *const words[WH_EXCHANGE_NEWS] = {
        [WH_EXCHANGE_LATE] = "came too late: its slice was held",
        [WH_EXCHANGE_UNKNOWN] = "answers a state that was not sent: it is not taken"};
    if (news == WH_EXCHANGE_OTHER_AXES && may_say(session, news)) {
        wh_node_warn(session->node, "a command of %d axes is not taken (expected %zu, as the layout has)",
                     frame[3], session->exchange.axes);
    } else if (words[news] && may_say(session, news)) {
        wh_node_warn(session->node, "the answer to state %" PRIu64 " %s", wh_board_get(frame + 4, 4),
                     words[news]);
    }
}

static void send_state(session_t *session) {
    const wh_state_t *state = &session->plant.simulation->server.state;
    const uint64_t held = session->exchange.counters.held;
    const wh_board_state_t told = {.number = session->exchange.next - 1,
                                   .sensors = state->sensors,
                                   .status = (uint16_t)session->status,
                                   .held = (uint16_t)(held < UINT16_MAX ? held : UINT16_MAX),
                                   .hash = wh_protocol_server_hash(&session->plant.simulation->server)};
    uint8_t frame[WH_BOARD_STATE_BYTES];
    wh_exchange_write(&session->exchange, &told, frame);
    session->sent_us = wh_node_clock_us();
    wh_exchange_note_sent(&session->exchange, session->sent_us);
    wh_cable_write(&session->line, frame, sizeof frame);
}

/* A board over UDP is known by its first sound frame; one that begins anew may come from another port of the
 * same machine. Any other sender is not heard. */
static bool is_of_board(session_t *session, bool is_hello) {
    wh_cable_t *line = &session->line;
    if (!line->is_udp || (line->has_peer && !line->is_stranger)) {
        return true;
    }
    if (!line->has_peer || (is_hello && wh_cable_is_same_host(line))) {
        char place[WH_CABLE_TEXT];
        wh_cable_take_peer(line);
        wh_address_write(&line->peer, place, sizeof place);
        wh_node_say(session->node, "the board is at %s", place);
        return true;
    }
    ++session->told.strangers;
    return false;
}

static void hear_frame(session_t *session, const uint8_t frame[]) {
    const bool is_hello = wh_board_get(frame + 4, 4) == WH_BOARD_HELLO;
    if (!is_of_board(session, is_hello)) {
        return;
    }
    const int64_t now_us = wh_node_clock_us();
    const wh_exchange_news_t news = wh_exchange_hear(&session->exchange, frame, now_us);
    session->heard_us = now_us;
    say_news(session, news, frame);
    if (session->exchange.is_reset) {
        session->exchange.is_reset = false;
        wh_node_warn(session->node, "the board has begun anew before slice %" PRIu32, session->exchange.next);
    }
    if (news == WH_EXCHANGE_HELLO) {
        send_state(session); /* it waits for one */
    }
}

/* A datagram holds whole frames. */
static void read_line(session_t *session) {
    uint8_t bytes[WH_CABLE_BYTES];
    int size = wh_cable_read(&session->line, bytes);
    while (size > 0) {
        for (int i = 0; i < size; ++i) {
            if (wh_board_gather(&session->in, WH_BOARD_KIND_COMMAND, bytes[i]) > 0) {
                hear_frame(session, session->in.bytes);
            }
        }
        if (session->line.is_udp) {
            session->in.skipped += (uint32_t)(session->in.count - session->in.taken);
            session->in.count = session->in.taken = 0;
        }
        size = wh_cable_read(&session->line, bytes);
    }
    if (size < 0 && !session->told.is_gone) {
        session->told.is_gone = session->is_over = true;
        wh_node_warn(session->node, "the serial line is gone after slice %" PRIu32,
                     session->exchange.next - 1);
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

/* The numbers of the board, or the last ones once more. */
static void drive(session_t *session) {
    const wh_exchange_slot_t *answer = wh_exchange_take(&session->exchange);
    char text[WH_PLANT_TEXT] = "";
    if (!answer) {
        if (may_say(session, SAID_HELD)) {
            wh_node_warn(session->node, "slice %" PRIu32 ": no answer is there: axes and valves stay",
                         session->exchange.next - 1);
        }
        return;
    }
    session->status = wh_plant_drive(&session->plant, answer->axes, answer->valves, text);
    if (text[0] != '\0' && may_say(session, SAID_AXES)) {
        wh_node_warn(session->node, "slice %" PRIu32 ": %s", session->exchange.next - 1, text);
    }
}

static void play_slice(session_t *session) {
    if (!session->arguments->lockstep) {
        wh_pacing_pass(&session->pacing, wh_node_clock_us());
    }
    drive(session);
    const wh_status_t status = wh_plant_step(&session->plant);
    if (status != WH_OK) {
        wh_node_warn(session->node, "slice %" PRIu32 ": the cell takes it not: %s",
                     session->exchange.next - 1, wh_status_text(status));
        session->told.refusal = status;
        session->is_over = true;
        return;
    }
    send_state(session);
    const double simulated_s =
        (double)wh_plant_slice(&session->plant) * (double)session->plant.layout->slice_us / 1e6;
    session->is_over = session->is_over || session->exchange.next == WH_BOARD_HELLO ||
                       (session->arguments->seconds > 0 && simulated_s >= session->arguments->seconds);
}

/* States that still wait in the line, and their answers, have this time to come through. */
#define QUIET_US 50000

/* Begins with the board's first answer. */
static void begin_slices(session_t *session) {
    session->is_begun = true;
    session->told.begun_us = wh_node_clock_us() + (session->arguments->lockstep ? 0 : QUIET_US);
    wh_pacing_begin(&session->pacing, session->plant.layout->slice_us, session->told.begun_us);
}

static bool waits_for_answer(const session_t *session) {
    return !session->is_begun || session->arguments->lockstep;
}

static bool is_due(const session_t *session, int64_t now_us) {
    if (waits_for_answer(session)) {
        return session->is_begun && wh_exchange_is_ready(&session->exchange);
    }
    return now_us >= wh_pacing_due(&session->pacing);
}

/* ---------------------------------------------------------------------------------------------- the clock */

/* When the line is looked at at the latest. */
static int64_t wakes_us(const session_t *session) {
    const int64_t again_us = session->is_begun ? LOCKSTEP_AGAIN_US : BEGIN_AGAIN_US;
    const int64_t due_us =
        waits_for_answer(session) ? session->sent_us + again_us : wh_pacing_due(&session->pacing);
    const int64_t tick_us = session->ticked_us + TICK_US;
    return due_us < tick_us ? due_us : tick_us;
}

static void wait_for_line(session_t *session) {
    struct pollfd line = {.fd = session->line.fd, .events = POLLIN};
    const int64_t wait_us = wakes_us(session) - wh_node_clock_us();
    if (wait_us > 0) {
        const struct timespec wait = {.tv_sec = wait_us / 1000000, .tv_nsec = wait_us % 1000000 * 1000};
        (void)ppoll(&line, 1, &wait, NULL);
    }
    read_line(session);
}

static void send_again(session_t *session, int64_t now_us) {
    const int64_t again_us = session->is_begun ? LOCKSTEP_AGAIN_US : BEGIN_AGAIN_US;
    if (waits_for_answer(session) && now_us - session->sent_us >= again_us) {
        send_state(session);
    }
}

static void look_for_silence(session_t *session, int64_t now_us) {
    const double timeout_s = session->arguments->timeout_s;
    if (timeout_s > 0 && (double)(now_us - session->heard_us) > timeout_s * 1e6) {
        wh_node_warn(session->node, "no answer of the board for %g s (--timeout)", timeout_s);
        session->told.is_silent = session->is_over = true;
    }
}

static void serve(session_t *session, const wh_sim_board_ticks_t *ticks) {
    session->heard_us = wh_node_clock_us();
    send_state(session);
    while (!wh_stop_requested && !session->is_over) {
        wait_for_line(session);
        if (!session->is_begun && wh_exchange_is_ready(&session->exchange)) {
            begin_slices(session);
        }
        const int64_t now_us = wh_node_clock_us();
        const bool has_played = !session->is_over && is_due(session, now_us);
        if (has_played) {
            play_slice(session);
        }
        send_again(session, now_us);
        look_for_silence(session, now_us);
        if (has_played || now_us - session->ticked_us >= TICK_US) {
            session->ticked_us = now_us;
            wh_sim_process_tick(session->plant.simulation);
            ticks->tick(ticks->user);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ opening */

static bool open_line(session_t *session) {
    const wh_sim_board_arguments_t *arguments = session->arguments;
    char problem[WH_CABLE_TEXT];
    for (size_t i = 0; i < arguments->allowed.count; ++i) {
        if (!wh_allow_add(&session->allow, arguments->allowed.items[i])) {
            fprintf(stderr,
                    "--allow %s: no address (expected one in numbers, such as 192.168.0.7 or 192.168.0.0/24, "
                    "at most %d of them)\n",
                    arguments->allowed.items[i], WH_ALLOW_MOST);
            return false;
        }
    }
    const bool opened = arguments->serial
                            ? wh_cable_open_serial(&session->line, arguments->serial,
                                                   arguments->baud > 0 ? arguments->baud : USUAL_BAUD,
                                                   WH_BOARD_COMMAND_BYTES(session->exchange.axes), problem)
                            : wh_cable_open_udp(&session->line, arguments->udp, problem);
    if (!opened) {
        fprintf(stderr, "--%s %s\n", arguments->serial ? "serial" : "udp", problem);
        return false;
    }
    session->line.allow = arguments->allowed.count > 0 ? &session->allow : NULL;
    return true;
}

static void say_event(void *user, int64_t utime, const char *text, bool is_complaint) {
    const session_t *session = user;
    (is_complaint ? wh_node_warn : wh_node_say)(session->node, "%.3f s: %s", (double)utime / 1e6, text);
}

static void say_ready(const session_t *session) {
    const wh_cable_t *line = &session->line;
    const char *warning = "";
    if (!line->is_local) {
        warning = line->allow ? ": the allowed addresses can command the cell"
                              : ": whoever reaches this machine can command the cell";
    }
    wh_node_say(session->node, "a board of %zu axes is awaited at %s%s", session->exchange.axes, line->place,
                warning);
}

int wh_sim_board_serve(const wh_sim_board_arguments_t *arguments, wh_sim_process_t *simulation,
                       const wh_sim_board_ticks_t *ticks, bool json) {
    static session_t session;
    session.arguments = arguments;
    session.node = simulation->node;
    wh_plant_open(&session.plant, simulation);
    wh_exchange_init(&session.exchange, session.plant.command.axis_count,
                     arguments->lag > 0 ? (uint32_t)arguments->lag : 1);
    if (!open_line(&session)) {
        return WH_EXIT_USAGE;
    }
    session.plant.heard = say_event;
    session.plant.heard_user = &session;
    say_ready(&session);
    serve(&session, ticks);
    session.told.ended_us = wh_node_clock_us();
    session.told.lenient = arguments->lenient;
    session.told.is_cut = !session.is_over && arguments->seconds > 0;
    session.told.lockstep = arguments->lockstep;
    session.told.exchange = &session.exchange;
    session.told.plant = &session.plant;
    session.told.pacing = &session.pacing;
    session.told.line = &session.line;
    session.told.in = &session.in;
    const int status = wh_sim_board_tell(&session.told, json);
    wh_cable_close(&session.line);
    return status;
}
