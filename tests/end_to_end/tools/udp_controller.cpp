/* A robot controller in C++ that knows of a cell what lib/manual/board.md says of its frames, byte by byte, and nothing of board.h. Its
 * axes go by the library's profiles: it carries a wafer from A to B of tests/firmware/cell.lua, over UDP.
 *   udp_controller PORT */
#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <vector>
#include <waferhand.h>

namespace {

using Axes = std::array<double, 4>;
using Frame = std::vector<std::uint8_t>;

std::uint32_t sum_of(const std::uint8_t *bytes, std::size_t size) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (std::size_t i = 0; i < size; ++i) {
        sum ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) {
            sum = (sum & 1U) != 0U ? (sum >> 1) ^ 0xEDB88320U : sum >> 1;
        }
    }
    return ~sum;
}

void put(Frame &frame, std::size_t at, std::size_t size, std::uint64_t value) {
    for (std::size_t i = 0; i < size; ++i) {
        frame[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
}

std::uint32_t get(const std::uint8_t *from) {
    return static_cast<std::uint32_t>(from[0]) | static_cast<std::uint32_t>(from[1]) << 8 |
           static_cast<std::uint32_t>(from[2]) << 16 | static_cast<std::uint32_t>(from[3]) << 24;
}

Frame command(std::uint32_t answers, std::uint32_t sent, bool holds, const Axes &axes) {
    Frame frame(20 + 8 * axes.size());
    frame[0] = 0xA5;
    frame[1] = 'C';
    frame[2] = 1;
    frame[3] = static_cast<std::uint8_t>(axes.size());
    put(frame, 4, 4, answers);
    put(frame, 8, 4, sent);
    put(frame, 12, 4, holds ? 1U : 0U);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &axes[i], sizeof bits);
        put(frame, 16 + 8 * i, 8, bits);
    }
    put(frame, frame.size() - 4, 4, sum_of(frame.data(), frame.size() - 4));
    return frame;
}

struct State {
    std::uint32_t number, sensors;
    int status;
};

class Line {
  public:
    explicit Line(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in to{};
        sockaddr any{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        std::memcpy(&any, &to, sizeof any);
        const timeval wait{0, 100000};
        (void)setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
        if (::connect(socket_, &any, sizeof any) != 0) {
            throw std::runtime_error("no such port");
        }
    }
    ~Line() {
        ::close(socket_);
    }
    Line(const Line &) = delete;
    Line &operator=(const Line &) = delete;

    void send(const Frame &frame) {
        (void)::send(socket_, frame.data(), frame.size(), 0);
    }
    bool take(State &state) {
        std::array<std::uint8_t, 64> b{};
        if (::recv(socket_, b.data(), b.size(), 0) != 28 || b[0] != 0xA5 || b[1] != 'S' || b[2] != 1 ||
            get(&b[24]) != sum_of(b.data(), 24)) {
            return false;
        }
        state = State{get(&b[4]), get(&b[8]), b[12] + 256 * b[13]};
        return true;
    }

  private:
    int socket_;
};

/* One axis goes to a place, with the vacuum on or off, and stands there for some ms. */
struct Step {
    std::size_t axis;
    double to;
    bool holds;
    double stands_s;
};

const std::array<Step, 12> steps{{{2, 897, false, 0},
                                  {1, 700, false, 0},
                                  {2, 903, true, 0.3},
                                  {1, 400, true, 0},
                                  {0, 90, true, 0},
                                  {1, 700, true, 0},
                                  {2, 900, true, 0},
                                  {2, 900, false, 0.3},
                                  {2, 897, false, 0},
                                  {1, 400, false, 0},
                                  {0, 0, false, 0},
                                  {2, 850, false, 0}}};
const std::array<wh_limits_t, 4> limits{
    {{100, 300, 3000}, {500, 1500, 15000}, {20, 1000, 10000}, {100, 300, 3000}}};

class Controller {
  public:
    const Frame &tick(const State &state) {
        if (at_ < steps.size()) {
            go_on(steps[at_]);
        }
        seen_ = seen_ || (state.sensors & 1U) != 0U;
        out_ = command(state.number, ++sent_, holds_, axes_);
        return out_;
    }
    bool is_done() const {
        return at_ == steps.size() && seen_;
    }

  private:
    void go_on(const Step &step) {
        if (time_s_ == 0) {
            from_ = axes_[step.axis];
            holds_ = step.holds;
            if (wh_profile_plan(&profile_, step.to - from_, &limits[step.axis]) != WH_OK) {
                throw std::runtime_error("no profile");
            }
        }
        time_s_ += 1e-3;
        const bool is_there = time_s_ >= wh_profile_duration(&profile_);
        axes_[step.axis] = is_there ? step.to : from_ + wh_profile_position(&profile_, time_s_);
        if (time_s_ >= wh_profile_duration(&profile_) + step.stands_s) {
            ++at_;
            time_s_ = 0;
        }
    }

    Axes axes_{{0, 300, 850, 0}};
    wh_profile_t profile_{};
    std::size_t at_ = 0;
    double time_s_ = 0, from_ = 0;
    bool holds_ = false, seen_ = false;
    std::uint32_t sent_ = 0;
    Frame out_;
};

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        return 2;
    }
    Line line(static_cast<std::uint16_t>(std::atoi(argv[1])));
    Controller controller;
    Frame out = command(0xFFFFFFFFU, 0, false, Axes{});
    std::uint32_t last = 0xFFFFFFFFU;
    line.send(out);
    /* A simulator that is not there yet refuses at once; one that has ended is silent. */
    for (int silent = 0; silent < (last == 0xFFFFFFFFU ? 100 : 5);) {
        State state{};
        if (!line.take(state)) {
            ++silent;
            (void)usleep(100000);
        } else if (state.status != 0) {
            std::printf("refused: %d at %u\n", state.status, state.number);
            return 1;
        } else if (state.number != last) {
            silent = 0;
            last = state.number;
            out = controller.tick(state);
        }
        line.send(out);
    }
    std::puts(controller.is_done() ? "done" : "not done");
    return controller.is_done() ? 0 : 1;
}
