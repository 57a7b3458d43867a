#include "cable.h"

#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

static const struct {
    uint64_t baud;
    speed_t speed;
} speeds[] = {{9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
              {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
              {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1152000, B1152000},
              {1500000, B1500000}, {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000},
              {3500000, B3500000}, {4000000, B4000000}};

static bool find_speed(uint64_t baud, speed_t *speed) {
    for (size_t i = 0; i < sizeof speeds / sizeof speeds[0]; ++i) {
        if (speeds[i].baud == baud) {
            *speed = speeds[i].speed;
            return true;
        }
    }
    return false;
}

bool wh_cable_has_speed(uint64_t baud) {
    speed_t speed;
    return find_speed(baud, &speed);
}

static void begin(wh_cable_t *line, bool is_udp) {
    memset(line, 0, sizeof *line);
    line->fd = -1;
    line->is_udp = is_udp;
}

static bool fail(wh_cable_t *line, const char *what, const char *expected, char problem[WH_CABLE_TEXT]) {
    (void)snprintf(problem, WH_CABLE_TEXT, "%.200s: %s", what, expected ? expected : strerror(errno));
    wh_cable_close(line);
    return false;
}

/* ------------------------------------------------------------------------------------------------- serial */

/* A line that is polled wakes its reader once as many bytes are there as a frame has. */
static bool set_serial(int fd, speed_t speed, size_t frame) {
    struct termios settings;
    if (tcgetattr(fd, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~(tcflag_t)(CSTOPB | CRTSCTS);
    settings.c_cc[VMIN] = (cc_t)(frame < 255 ? frame : 255);
    settings.c_cc[VTIME] = 0;
    return cfsetispeed(&settings, speed) == 0 && cfsetospeed(&settings, speed) == 0 &&
           tcsetattr(fd, TCSANOW, &settings) == 0 && tcflush(fd, TCIOFLUSH) == 0;
}

bool wh_cable_open_serial(wh_cable_t *line, const char *device, uint64_t baud, size_t frame,
                          char problem[WH_CABLE_TEXT]) {
    speed_t speed = B921600;
    begin(line, false);
    (void)find_speed(baud, &speed);
    line->fd = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (line->fd < 0) {
        return fail(line, device, NULL, problem);
    }
    if (!isatty(line->fd)) {
        return fail(line, device, "no serial line (expected a device such as /dev/ttyUSB0, or a pty)",
                    problem);
    }
    if (ioctl(line->fd, TIOCEXCL) != 0 || !set_serial(line->fd, speed, frame)) {
        return fail(line, device, NULL, problem);
    }
    line->is_local = true;
    (void)snprintf(line->place, sizeof line->place, "%s", device);
    return true;
}

/* ---------------------------------------------------------------------------------------------------- UDP */

bool wh_cable_open_udp(wh_cable_t *line, const char *address, char problem[WH_CABLE_TEXT]) {
    wh_address_t at;
    begin(line, true);
    if (!wh_address_read(address, &at)) {
        return fail(line, address, "no address (expected " WH_ADDRESS_EXPECTED ")", problem);
    }
    line->fd = socket(at.bytes.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (line->fd < 0 || bind(line->fd, (const struct sockaddr *)&at.bytes, at.size) != 0) {
        return fail(line, address, NULL, problem);
    }
    at.size = sizeof at.bytes;
    (void)getsockname(line->fd, (struct sockaddr *)&at.bytes, &at.size);
    line->is_local = wh_address_is_local(&at);
    wh_address_write(&at, line->place, sizeof line->place);
    return true;
}

/* The bytes that say who an address is, and with its port. */
static size_t host_of(const wh_address_t *address, uint8_t host[16], in_port_t *port) {
    if (address->bytes.ss_family == AF_INET) {
        struct sockaddr_in four;
        memcpy(&four, &address->bytes, sizeof four);
        memcpy(host, &four.sin_addr, 4);
        *port = four.sin_port;
        return 4;
    }
    struct sockaddr_in6 six;
    memcpy(&six, &address->bytes, sizeof six);
    memcpy(host, &six.sin6_addr, 16);
    *port = six.sin6_port;
    return 16;
}

static bool is_same_host(const wh_address_t *a, const wh_address_t *b, bool *is_same_port) {
    uint8_t one[16];
    uint8_t other[16];
    in_port_t one_port;
    in_port_t other_port;
    const size_t size = host_of(a, one, &one_port);
    const bool is_same = size == host_of(b, other, &other_port) && memcmp(one, other, size) == 0;
    *is_same_port = one_port == other_port;
    return is_same;
}

bool wh_cable_is_same_host(const wh_cable_t *line) {
    bool is_same_port;
    return line->has_peer && is_same_host(&line->peer, &line->from, &is_same_port);
}

/* The bytes of the next datagram whose sender may send; 0: none is there. An error is the refusal of an
 * earlier frame, such as by a board that is off, and ends nothing. */
static int receive(wh_cable_t *line, uint8_t bytes[WH_CABLE_BYTES]) {
    for (;;) {
        line->from.size = sizeof line->from.bytes;
        struct sockaddr *from = (struct sockaddr *)&line->from.bytes;
        const ssize_t size = recvfrom(line->fd, bytes, WH_CABLE_BYTES, 0, from, &line->from.size);
        if (size <= 0 || !line->allow || wh_allow_has(line->allow, from)) {
            return size > 0 ? (int)size : 0;
        }
        ++line->refused;
    }
}

static int read_udp(wh_cable_t *line, uint8_t bytes[WH_CABLE_BYTES]) {
    bool is_same_port = false;
    const int size = receive(line, bytes);
    line->is_stranger = size > 0 && line->has_peer &&
                        !(is_same_host(&line->peer, &line->from, &is_same_port) && is_same_port);
    return size;
}

/* ----------------------------------------------------------------------------------------------- of both */

int wh_cable_read(wh_cable_t *line, uint8_t bytes[WH_CABLE_BYTES]) {
    if (line->is_udp) {
        return read_udp(line, bytes);
    }
    const ssize_t size = read(line->fd, bytes, WH_CABLE_BYTES);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
        return 0;
    }
    return size > 0 ? (int)size : -1;
}

void wh_cable_take_peer(wh_cable_t *line) {
    line->peer = line->from;
    line->has_peer = true;
    line->is_stranger = false;
}

void wh_cable_write(wh_cable_t *line, const uint8_t bytes[], size_t size) {
    if (line->is_udp && !line->has_peer) {
        return;
    }
    const ssize_t written = line->is_udp ? sendto(line->fd, bytes, size, MSG_NOSIGNAL,
                                                  (const struct sockaddr *)&line->peer.bytes, line->peer.size)
                                         : write(line->fd, bytes, size);
    line->unsent += written == (ssize_t)size ? 0 : 1;
}

void wh_cable_close(wh_cable_t *line) {
    if (line->fd >= 0) {
        (void)close(line->fd);
    }
    line->fd = -1;
}
