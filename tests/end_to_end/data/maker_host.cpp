/* A tool's host in C++ that knows sockets alone: a robot that prompts, a load port by length and an aligner with an LRC.
 * maker_host ROBOT PORT ALIGNER, three ports of 127.0.0.1. It ends with 1 at the first answer that is not the wanted one. */
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

using Clock = std::chrono::steady_clock;

class Line {
  public:
    explicit Line(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_port = htons(static_cast<std::uint16_t>(port));
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const timeval patience{20, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        if (::connect(socket_, reinterpret_cast<sockaddr *>(&at), sizeof at) != 0) {
            throw std::runtime_error("no connection");
        }
    }
    ~Line() {
        ::close(socket_);
    }
    Line(const Line &) = delete;
    Line &operator=(const Line &) = delete;

    void send(const std::string &bytes) {
        if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size())) {
            throw std::runtime_error("not taken");
        }
    }
    std::string take(std::size_t count) {
        while (rest_.size() < count) {
            char some[512];
            const ssize_t got = ::recv(socket_, some, sizeof some, 0);
            if (got <= 0) {
                throw std::runtime_error("nothing came behind: " + rest_);
            }
            rest_.append(some, static_cast<std::size_t>(got));
        }
        const std::string taken = rest_.substr(0, count);
        rest_.erase(0, count);
        return taken;
    }
    std::string until(const std::string &end) {
        std::string heard;
        while (heard.size() < end.size() || heard.compare(heard.size() - end.size(), end.size(), end) != 0) {
            heard += take(1);
        }
        return heard.substr(0, heard.size() - end.size());
    }

  private:
    int socket_;
    std::string rest_;
};

void expect(const std::string &got, const std::string &wanted, const std::string &what) {
    if (got != wanted) {
        throw std::runtime_error(what + ": " + got + " (wanted " + wanted + ")");
    }
}

void robot_does(Line &robot, const std::string &command, const std::string &wanted) {
    robot.send(command + "\r");
    expect(robot.until("\r\n>"), wanted, command);
}

std::string counted(const std::string &body) {
    std::string frame{static_cast<char>((body.size() + 2) >> 8), static_cast<char>(body.size() + 2)};
    frame += body;
    unsigned sum = 0;
    for (const char c : frame) {
        sum += static_cast<unsigned char>(c);
    }
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02X", sum & 0xFFU);
    return "\x01" + frame + digits + "\x03";
}

std::string hear_counted(Line &port) {
    const std::string head = port.take(3);
    const std::size_t size = static_cast<unsigned char>(head[1]) * 256U + static_cast<unsigned char>(head[2]);
    const std::string rest = port.take(size + 1);
    const std::string body = rest.substr(0, size - 2);
    expect(head + rest, counted(body), "a frame by length");
    return body;
}

std::string with_lrc(const std::string &body) {
    std::string frame = "\x02";
    char lrc = 3;
    for (const char c : body) {
        frame += c == 2 || c == 3 || c == 16 ? std::string{16, c} : std::string{c};
        lrc = static_cast<char>(lrc ^ c);
    }
    return frame + '\x03' + lrc;
}

std::string hear_lrc(Line &aligner) {
    std::string body;
    expect(aligner.take(1), "\x02", "STX");
    for (std::string c = aligner.take(1); c != "\x03"; c = aligner.take(1)) {
        body += c == "\x10" ? aligner.take(1) : c;
    }
    expect(with_lrc(body).substr(with_lrc(body).size() - 1), aligner.take(1), "the LRC");
    return body;
}

void aligner_does(Line &aligner, const std::string &command) {
    aligner.send(with_lrc(command));
    expect(hear_lrc(aligner), "\x06", command);
    expect(hear_lrc(aligner), "E" + command.substr(0, 2), command);
}

void stop_in_motion(Line &robot) {
    robot_does(robot, "SPD 20", "OK");
    robot.send("MVA T 9000\r");
    robot.send("STA\r");
    expect(robot.until("\r\n>"), "000B", "busy, with power");
    robot.send("GET C,1\r");
    expect(robot.until("\r\n>"), "?03", "busy");
    robot.send("STOP\r");
    const std::string first = robot.until("\r\n>");
    const std::string second = robot.until("\r\n>");
    if (!((first == "OK" && second == "?13") || (first == "?13" && second == "OK"))) {
        throw std::runtime_error("a stop in motion: " + first + ", " + second);
    }
    robot_does(robot, "STA", "000A");
    robot_does(robot, "SPD 100", "OK");
}

/* A wafer lies on the chuck; an angle without a sensor, no angle, and a frame with a bad sum. */
void align(Line &aligner) {
    aligner_does(aligner, "VN");
    aligner.send(with_lrc("WF"));
    expect(hear_lrc(aligner),
           "\x06"
           "1",
           "the chuck holds it");
    aligner_does(aligner, "RO900");
    aligner.send(with_lrc("AL900")); /* this aligner has no sensor */
    expect(hear_lrc(aligner), "\x06", "align");
    expect(hear_lrc(aligner), "X07", "align");
    aligner.send(with_lrc("ALx"));
    expect(hear_lrc(aligner),
           "\x15"
           "07",
           "no angle");
    std::string broken = with_lrc("WF");
    broken.back() = static_cast<char>(broken.back() ^ 0x40);
    aligner.send(broken);
    expect(hear_lrc(aligner),
           "\x15"
           "01",
           "a bad sum");
}

/* The host is there again; its robot has lost its power with the client. */
void come_back(int robot_port) {
    Line again(robot_port);
    expect(again.until("\r\n>"), "READY", "a greeting");
    std::string told;
    const Clock::time_point begin = Clock::now();
    do { /* its power went with the client */
        again.send("STA\r");
        told = again.until("\r\n>");
    } while ((told.back() == '1' || told.back() == '9') && Clock::now() - begin < std::chrono::seconds(10));
    expect(told, "0008", "no power, and the last motion has failed");
    robot_does(again, "MTS A,1", "?10");
    robot_does(again, "PWR 1", "OK");
    robot_does(again, "RET", "OK");
    robot_does(again, "HOM", "OK");
    robot_does(again, "GET A,3", "OK");
}

void run(int robot_port, int load_port, int aligner_port) {
    Line port(load_port);
    Line aligner(aligner_port);
    {
        Line robot(robot_port);
        expect(robot.until("\r\n>"), "READY", "a greeting");
        robot_does(robot, "GET A,1", "?10");
        robot_does(robot, "PWR 1", "OK");
        robot_does(robot, "HOM", "OK");
        port.send(counted("00MOV:CLOAD;"));
        expect(hear_counted(port), "00ACK:CLOAD;", "load");
        robot_does(robot, "GET A,1", "?03"); /* the port maps */
        expect(hear_counted(port), "00INF:CLOAD;", "load");
        robot_does(robot, "GET A,1", "OK");
        robot_does(robot, "STA", "001A"); /* with the wafer, and the error of before */
        robot_does(robot, "PUT C,1", "OK");
        align(aligner);
        robot_does(robot, "GET C,1", "OK");
        robot_does(robot, "PUT A,3", "OK");
        robot_does(robot, "GET A,9", "?30");
        robot_does(robot, "RET", "OK");
        stop_in_motion(robot);
        robot_does(robot, "PUT X,1", "?20");
        robot_does(robot, "JMP", "?02");
        robot.send("MVA T 0\r"); /* the host falls amid a motion */
    }
    come_back(robot_port);
}

} // namespace

int main(int argc, char **argv) {
    try {
        if (argc != 4) {
            throw std::runtime_error("three ports, please");
        }
        run(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
    } catch (const std::exception &problem) {
        std::fprintf(stderr, "maker_host: %s\n", problem.what());
        return 1;
    }
    return 0;
}
