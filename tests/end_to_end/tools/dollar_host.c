/* dollar_host ADDRESS PORT: a tool's host that uses only sockets. It plays the paper's transfer run
 * as `$`-comma telegrams with sums and sequence numbers. It waits for each acknowledgement and
 * completion, answers that with ACKN, and prints the number of telegrams and the longest time to an
 * acknowledgement. It ends with 1 at the first answer that is not good. */
#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static int connection;
static char rest[65536];
static size_t waiting;
static unsigned frames;
static double slowest_ms;

static void give_up(const char *what, const char *frame) {
    (void)fprintf(stderr, "dollar_host: %s: %s\n", what, frame);
    exit(1);
}

static double now_ms(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static unsigned sum_of(const char *text, size_t size) {
    unsigned sum = 0;
    for (size_t i = 0; i < size; ++i) {
        sum += (unsigned char)text[i];
    }
    return sum & 0xFFU;
}

static void say(unsigned sequence, const char *text) {
    char body[200];
    char frame[210];
    const int length = snprintf(body, sizeof body, ",1,%02u,%s,", sequence, text);
    const int size = snprintf(frame, sizeof frame, "$%s%02X\r", body, sum_of(body, (size_t)length));
    if (write(connection, frame, (size_t)size) != size) {
        give_up("not taken", text);
    }
}

/* The next frame without its end, after a check of its sum and end. */
static void hear(char frame[300]) {
    char *end = NULL;
    while (!(end = memchr(rest, '\r', waiting))) {
        const ssize_t got = read(connection, rest + waiting, sizeof rest - waiting);
        if (got <= 0) {
            give_up("nothing came behind", frame);
        }
        waiting += (size_t)got;
    }
    const size_t size = (size_t)(end - rest);
    (void)snprintf(frame, 300, "%.*s", (int)size, rest);
    waiting -= size + 1;
    memmove(rest, end + 1, waiting);
    ++frames;
    if (size < 4 || size > 299 || strtoul(frame + size - 2, NULL, 16) != sum_of(frame + 1, size - 3)) {
        give_up("a wrong sum", frame);
    }
}

/* The next frame that begins with this text. Events, and other frames that a host does not know,
 * are skipped. */
static void hear_from(const char *start, char frame[300]) {
    do {
        hear(frame);
    } while (strncmp(frame, start, strlen(start)) != 0);
}

static void act(unsigned sequence, const char *text) {
    char frame[300] = "";
    char wanted[40];
    const double begin = now_ms();
    say(sequence, text);
    (void)snprintf(wanted, sizeof wanted, "$,1,%02u,", sequence);
    hear_from(wanted, frame);
    const double took = now_ms() - begin;
    slowest_ms = took > slowest_ms ? took : slowest_ms;
    if (strncmp(frame + strlen(wanted) + 1, ",0000,", 6) != 0) {
        give_up("refused", frame);
    }
    wanted[0] = '!';
    hear_from(wanted, frame);
    if (strncmp(frame + strlen(wanted) + 1, ",0000,", 6) != 0) {
        give_up("failed", frame);
    }
    say(sequence, "ACKN");
}

int main(int count, char **arguments) {
    static const char *const transfer[] = {"MTRS,G,A,1", "MTRS,P,B,2", "MTRS,G,B,1", "MTRS,P,B,10"};
    const struct timeval patience = {.tv_sec = 30};
    struct sockaddr_in at = {.sin_family = AF_INET};
    if (count != 3 || inet_pton(AF_INET, arguments[1], &at.sin_addr) != 1) {
        give_up("expected", "ADDRESS PORT");
    }
    at.sin_port = htons((unsigned short)atoi(arguments[2]));
    connection = socket(AF_INET, SOCK_STREAM, 0);
    if (connection < 0 || connect(connection, (const struct sockaddr *)&at, sizeof at) != 0 ||
        setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) != 0) {
        give_up("not reached", arguments[2]);
    }
    for (unsigned i = 0; i < sizeof transfer / sizeof *transfer; ++i) {
        act(i + 1, transfer[i]);
    }
    (void)printf("%u telegrams, acknowledged within %.1f ms\n", frames, slowest_ms);
    return close(connection) == 0 ? 0 : 1;
}
