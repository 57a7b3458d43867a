/* The board of tests/firmware/board.h as a process, and a line that does harm.
 *   board pty LINK            a pty with a link to it, as a board at a serial line; prints "ready"
 *   board udp ADDRESS:PORT    sends to the simulator there, with a hello until it answers
 *   lose=N  damage=N  double=N  reset=N  delay=N   harm to every N-th byte, or frame, that it sends; a reset at state
 *                             N - 1; every N-th answer comes 5 ms late */
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "firmware/board.h"

typedef struct {
    unsigned long lose, damage, twice, reset, delay;
} harm_t;

static harm_t harm;
static unsigned long bytes_sent, frames_sent;

static bool is_turn(unsigned long every, unsigned long count) {
    return every > 0 && count % every == 0;
}

/* Sends the frame as the line leaves it; a datagram whole. */
static void send_frame(int fd) {
    uint8_t line[WH_BOARD_BYTES];
    size_t size = 0;
    ++frames_sent;
    for (size_t i = 0; i < board.out_size; ++i) {
        ++bytes_sent;
        line[size] = (uint8_t)(board.out[i] ^ (is_turn(harm.damage, bytes_sent) ? 0x10 : 0));
        size += is_turn(harm.lose, bytes_sent) ? 0 : 1;
    }
    if (is_turn(harm.delay, frames_sent)) {
        const struct timespec late = {0, 5000000};
        (void)nanosleep(&late, NULL);
    }
    for (int times = is_turn(harm.twice, frames_sent) ? 2 : 1; times > 0; --times) {
        if (write(fd, line, size) != (ssize_t)size) {
            exit(1);
        }
    }
}

static void take(int fd, const uint8_t bytes[], ssize_t size) {
    for (ssize_t i = 0; i < size; ++i) {
        if (board_take(bytes[i])) {
            if (harm.reset > 0 && board.state.number + 1 == harm.reset) {
                harm.reset = 0;
                board_begin();
            } else {
                send_frame(fd);
            }
        }
    }
}

static int open_pty(const char *link) {
    const int fd = posix_openpt(O_RDWR | O_NOCTTY);
    struct termios settings;
    if (fd < 0 || grantpt(fd) != 0 || unlockpt(fd) != 0 || tcgetattr(fd, &settings) != 0) {
        return -1;
    }
    cfmakeraw(&settings);
    const char *slave = ptsname(fd);
    /* Held open, so that the line does not end when the simulator goes. */
    if (tcsetattr(fd, TCSANOW, &settings) != 0 || open(slave, O_RDWR | O_NOCTTY) < 0) {
        return -1;
    }
    (void)unlink(link);
    return symlink(slave, link) == 0 ? fd : -1;
}

static int open_udp(char *address) {
    char *colon = strrchr(address, ':');
    struct sockaddr_in to = {.sin_family = AF_INET};
    const int fd = socket(AF_INET, SOCK_DGRAM, 0);
    if (!colon) {
        return -1;
    }
    *colon = '\0';
    to.sin_port = htons((uint16_t)atoi(colon + 1));
    return fd >= 0 && inet_pton(AF_INET, address, &to.sin_addr) == 1 &&
                   connect(fd, (struct sockaddr *)&to, sizeof to) == 0
               ? fd
               : -1;
}

static void read_harm(char *text) {
    const struct {
        const char *name;
        unsigned long *every;
    } kinds[] = {{"lose", &harm.lose},
                 {"damage", &harm.damage},
                 {"double", &harm.twice},
                 {"reset", &harm.reset},
                 {"delay", &harm.delay}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        const size_t length = strlen(kinds[i].name);
        if (strncmp(text, kinds[i].name, length) == 0 && text[length] == '=') {
            *kinds[i].every = strtoul(text + length + 1, NULL, 10);
            return;
        }
    }
    exit(2);
}

int main(int argc, char **argv) {
    const bool is_udp = argc > 2 && strcmp(argv[1], "udp") == 0;
    const int fd = argc < 3 ? -1 : is_udp ? open_udp(argv[2]) : open_pty(argv[2]);
    for (int i = 3; i < argc; ++i) {
        read_harm(argv[i]);
    }
    if (fd < 0) {
        return 2;
    }
    puts("ready");
    (void)fflush(stdout);
    board_begin();
    for (;;) {
        struct pollfd line = {.fd = fd, .events = POLLIN};
        uint8_t bytes[2048];
        if (poll(&line, 1, 20) > 0) {
            const ssize_t size = read(fd, bytes, sizeof bytes);
            take(fd, bytes, size);
        } else if (is_udp && !board.has_state) {
            (void)!write(fd, board.out, board.out_size);
        }
    }
}
