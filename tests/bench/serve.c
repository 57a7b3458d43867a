/* Measures how soon `waferhand serve` acknowledges: one idle controller, and three of one cell at
 * once, by the wall clock at 1 kHz slices, without `timing.ack`. The first of the three carries a
 * wafer to and fro; each is asked for its status again as soon as it has answered. The time runs
 * from the request's last byte to the answer's last byte, on the host's side, with both processes
 * on the available cores. Start it at the root, after `make all`. */
#include <arpa/inet.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench/harness.h"

enum { PORTS = 3, IDLE_REQUESTS = 3000, BUSY_SECONDS = 10, MOST = 200000, PAUSE_US = 500 };

#define FOLDER "build/tests/bench/"

/* A dialect of lua/dialects with the words of a mechanism, and the way its host asks. */
typedef struct {
    const char *name, *mechanism, *words;
} controller_t;

static const controller_t controllers[PORTS] = {{"dollar", "robot", "GET PUT STATUS ACKN"},
                                                {"words", "aligner", "STATUS"},
                                                {"verbs", "load_port", "STATUS"}};

/* The host's side of a port. */
typedef struct {
    int connection;
    unsigned sequence;
    double asked_us; /* when it was asked; 0: nothing is asked */
    double again_us; /* when it is asked next */
    bool is_running; /* its action */
    size_t next;     /* the next round trip */
    char rest[4096];
    size_t size;
    double us[MOST];
    size_t count;
} port_t;

static port_t ports[PORTS];
static pid_t server;

static double now_us(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

__attribute__((noreturn)) static void give_up(const char *what, const char *shown) {
    (void)fprintf(stderr, "bench: serve: %s: %s\n", what, shown);
    if (server > 0) {
        (void)kill(server, SIGTERM);
    }
    exit(1);
}

/* ------------------------------------------------------------------------------------------------- the server */

/* Writes build/tests/bench/NAME.lua. */
static void write_dialect(const controller_t *controller) {
    char path[100];
    char text[65536];
    (void)snprintf(path, sizeof path, "lua/dialects/%s.lua", controller->name);
    FILE *in = fopen(path, "re");
    const size_t size = in ? fread(text, 1, sizeof text - 1, in) : 0;
    text[size] = '\0';
    char *table = strstr(text, "\nreturn {");
    if (!in || !table || fclose(in) != 0) {
        give_up("no dialect", path);
    }
    (void)snprintf(path, sizeof path, FOLDER "%s.lua", controller->name);
    FILE *out = fopen(path, "we");
    if (!out) {
        give_up("cannot be written", path);
    }
    *table = '\0';
    (void)fprintf(
        out,
        "%s\nlocal dialect = {%s\nfor name, command in pairs(dialect.commands) do\n"
        "  if not (\" %s \"):find(\" \" .. command.does .. \" \", 1, true) then\n"
        "    dialect.commands[name] = nil\n  end\nend\ndialect.mechanism = \"%s\"\nreturn dialect\n",
        text, table + strlen("\nreturn {"), controller->words, controller->mechanism);
    (void)fclose(out);
}

/* It runs on any core, whatever core the harness has chosen for this process; it writes the
 * addresses of its ports to `to`. */
__attribute__((noreturn)) static void be_server(size_t count, int to) {
    char command[1000] = "exec build/waferhand serve lua/layouts/paper.lua";
    cpu_set_t all;
    for (size_t i = 0; i < count; ++i) {
        const size_t size = strlen(command);
        (void)snprintf(command + size, sizeof command - size, " --dialect " FOLDER "%s.lua --tcp 127.0.0.1:0",
                       controllers[i].name);
    }
    memset(&all, 0xFF, sizeof all);
    (void)sched_setaffinity(0, sizeof all, &all);
    (void)dup2(to, STDERR_FILENO);
    (void)execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

static int connect_to(unsigned number) {
    const struct sockaddr_in at = {.sin_family = AF_INET,
                                   .sin_port = htons((uint16_t)number),
                                   .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection < 0 || connect(connection, (const struct sockaddr *)&at, sizeof at) != 0) {
        give_up("nobody listens", "127.0.0.1");
    }
    return connection;
}

/* With this number of controllers. */
static void start(size_t count) {
    int ends[2];
    char line[400];
    if (pipe(ends) != 0 || (server = fork()) < 0) {
        give_up("no process", "fork");
    }
    if (server == 0) {
        be_server(count, ends[1]);
    }
    (void)close(ends[1]);
    FILE *said = fdopen(ends[0], "re");
    for (size_t i = 0; i < count; ++i) {
        const char *colon = said && fgets(line, sizeof line, said) ? strrchr(line, ':') : NULL;
        if (!colon) {
            give_up("does not begin", "build/waferhand serve");
        }
        memset(&ports[i], 0, sizeof ports[i]);
        ports[i].connection = connect_to((unsigned)strtoul(colon + 1, NULL, 10));
    }
    (void)dup2(STDERR_FILENO, ends[0]); /* its output at the end is not read */
}

static void finish(size_t count) {
    for (size_t i = 0; i < count; ++i) {
        (void)close(ports[i].connection);
    }
    (void)kill(server, SIGTERM);
    (void)waitpid(server, NULL, 0);
    server = 0;
}

/* --------------------------------------------------------------------------------------------------- the host */

static void send_text(port_t *port, const char *text) {
    const size_t size = strlen(text);
    if (send(port->connection, text, size, MSG_NOSIGNAL) != (ssize_t)size) {
        give_up("not taken", text);
    }
}

/* A telegram with its checksum. */
static void send_telegram(port_t *port, unsigned sequence, const char *text) {
    char body[100];
    char frame[120];
    unsigned sum = 0;
    (void)snprintf(body, sizeof body, ",1,%02u,%s,", sequence, text);
    for (const char *c = body; *c != '\0'; ++c) {
        sum += (unsigned char)*c;
    }
    (void)snprintf(frame, sizeof frame, "$%s%02X\r", body, sum & 0xFFU);
    send_text(port, frame);
}

static void ask(size_t i) {
    static const char *const trip[] = {"MTRS,G,A,1", "MTRS,P,B,2", "MTRS,G,B,2", "MTRS,P,A,1"};
    port_t *port = &ports[i];
    if (i == 0) {
        port->sequence = port->sequence % 99 + 1;
        send_telegram(port, port->sequence, port->is_running ? "RSTS" : trip[port->next % 4]);
        port->next += port->is_running ? 0 : 1;
        port->is_running = true;
    } else {
        send_text(port, i == 1 ? "RQ STATUS\r" : "oROB1.STAT()\r");
    }
    port->asked_us = now_us();
}

static bool begins(const char *frame, const char *with) {
    return strncmp(frame, with, strlen(with)) == 0;
}

static bool is_telegrams_answer(const char *frame) {
    char expected[40];
    if (frame[0] == '!') {
        send_telegram(&ports[0], (unsigned)strtoul(frame + 4, NULL, 10), "ACKN");
        ports[0].is_running = false;
    }
    (void)snprintf(expected, sizeof expected, "$,1,%02u,", ports[0].sequence);
    if (frame[0] == '$' && (!begins(frame, expected) || !strstr(frame, ",0000"))) {
        give_up("answered", frame);
    }
    return frame[0] == '$';
}

/* True if the frame is the last one of the expected answer. */
static bool is_answer(size_t i, const char *frame) {
    static const char *const more[PORTS] = {"", "STATUS ", "eROB1."};
    static const char *const wanted[PORTS] = {"", "_RDY", "aROB1.STAT:"};
    if (i == 0) {
        return is_telegrams_answer(frame);
    }
    if (!begins(frame, more[i]) && !begins(frame, wanted[i])) {
        give_up("answered", frame);
    }
    return !begins(frame, more[i]);
}

/* The frames that have arrived. */
static void hear(size_t i) {
    port_t *port = &ports[i];
    const ssize_t got = recv(port->connection, port->rest + port->size, sizeof port->rest - port->size, 0);
    if (got <= 0) {
        give_up("hung up", controllers[i].name);
    }
    port->size += (size_t)got;
    for (char *end = memchr(port->rest, '\r', port->size); end; end = memchr(port->rest, '\r', port->size)) {
        *end = '\0';
        if (is_answer(i, port->rest) && port->count < MOST) {
            port->us[port->count++] = now_us() - port->asked_us;
            port->asked_us = 0;
            port->again_us = now_us() + PAUSE_US;
        }
        port->size -= (size_t)(end + 1 - port->rest);
        memmove(port->rest, end + 1, port->size);
    }
}

/* Polls all ports once, and sends the next requests. */
static void go_on(size_t count) {
    struct pollfd polls[PORTS];
    const struct timespec pause = {0, PAUSE_US * 1000 / 2};
    for (size_t i = 0; i < count; ++i) {
        if (ports[i].asked_us == 0 && ports[i].again_us <= now_us()) {
            ask(i);
        }
        polls[i] = (struct pollfd){.fd = ports[i].connection, .events = POLLIN};
    }
    (void)ppoll(polls, (nfds_t)count, &pause, NULL);
    for (size_t i = 0; i < count; ++i) {
        if (polls[i].revents != 0) {
            hear(i);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- the table */

static int by_size(const void *a, const void *b) {
    const double *x = a;
    const double *y = b;
    return (*x > *y) - (*x < *y);
}

static void row(const char *name, const char *what, double us, double goal_ms) {
    char text[60];
    double ms = us / 1e3;
    const bench_spread_t spread = bench_spread(&ms, 1);
    (void)snprintf(text, sizeof text, "%s, %s", name, what);
    bench_figure(text, "ms", &spread, true, goal_ms);
}

/* The goals apply to 99.9 % and to the slowest. */
static void tell(const char *name, port_t *port, double most_goal, double slowest_goal) {
    qsort(port->us, port->count, sizeof *port->us, by_size);
    row(name, "median", port->us[port->count / 2], 0);
    row(name, "99.9 %", port->us[port->count - 1 - port->count / 1000], most_goal);
    row(name, "slowest", port->us[port->count - 1], slowest_goal);
}

static void measure_idle(void) {
    start(1);
    ports[0].is_running = true; /* it is asked only for its status */
    while (ports[0].count < IDLE_REQUESTS) {
        go_on(1);
    }
    finish(1);
    tell("idle", &ports[0], 0, 5);
}

static void measure_busy(void) {
    char names[PORTS][40];
    size_t asked = 0;
    start(PORTS);
    for (const double end = now_us() + BUSY_SECONDS * 1e6; now_us() < end;) {
        go_on(PORTS);
    }
    finish(PORTS);
    for (size_t i = 0; i < PORTS; ++i) {
        asked += ports[i].count;
        (void)snprintf(names[i], sizeof names[i], "busy, %s", controllers[i].name);
        tell(names[i], &ports[i], 20, 100);
    }
    bench_note("%zu requests of three ports in %d s, while the robot of one moved", asked, BUSY_SECONDS);
}

int main(int argc, char **argv) {
    bench_begin("serve", "", argc, argv);
    bench_note("acknowledgements of `waferhand serve` at 1 kHz slices, --rate 1, ms");
    if (!bench_wanted("idle") && !bench_wanted("busy")) {
        return bench_end();
    }
    for (size_t i = 0; i < PORTS; ++i) {
        write_dialect(&controllers[i]);
    }
    if (bench_wanted("idle")) {
        measure_idle();
    }
    if (bench_wanted("busy")) {
        measure_busy();
    }
    return bench_end();
}
