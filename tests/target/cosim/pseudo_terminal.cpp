// Bytes between a pseudo-terminal and the chip's serial port.
#include "tests/target/cosim/pseudo_terminal.hpp"

#include <chrono>
#include <fcntl.h>
#include <iostream>
#include <poll.h>
#include <stdexcept>
#include <stdlib.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

namespace cusp::cosim {
namespace {

int open_terminal()
{
    const int descriptor = posix_openpt(O_RDWR | O_NOCTTY);
    if (descriptor < 0 || grantpt(descriptor) != 0 || unlockpt(descriptor) != 0) {
        throw std::runtime_error{"no pseudo-terminal"};
    }
    termios settings{};
    tcgetattr(descriptor, &settings);
    cfmakeraw(&settings);
    tcsetattr(descriptor, TCSANOW, &settings);
    fcntl(descriptor, F_SETFL, O_NONBLOCK);
    return descriptor;
}

bool hung_up(int descriptor)
{
    pollfd state{descriptor, POLLIN, 0};
    return poll(&state, 1, 0) > 0 && (state.revents & POLLHUP) != 0 &&
           (state.revents & POLLIN) == 0;
}

}  // namespace

void run_on_terminal(ChipUnderTest& chip, Picoseconds time)
{
    using Clock = std::chrono::steady_clock;
    const int descriptor = open_terminal();
    std::cout << "terminal " << ptsname(descriptor) << std::endl;
    std::string out;
    chip.serial().set_receiver([&out](char byte) { out.push_back(byte); });
    const auto begin = Clock::now();
    bool opened = false;
    for (Picoseconds done = 0; done < time; done += kMillisecond) {
        std::array<char, 256> bytes{};
        const ssize_t count = read(descriptor, bytes.data(), bytes.size());
        if (count > 0) {
            chip.serial().send({bytes.data(), static_cast<std::size_t>(count)});
        }
        const bool closed = hung_up(descriptor);
        opened = opened || !closed;
        if (opened && closed) {
            break;
        }
        chip.run(kMillisecond);
        // Until someone listens what is said is lost, as on a wire.
        const ssize_t written = opened ? write(descriptor, out.data(), out.size()) : 0;
        out.erase(0, opened && written > 0 ? static_cast<std::size_t>(written) : 0);
        if (!opened) {
            out.clear();
        }
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds{done / 1000});
    }
    close(descriptor);
}

}  // namespace cusp::cosim
