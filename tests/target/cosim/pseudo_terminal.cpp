// Bytes between a pseudo-terminal and the chip's serial port.
#include "tests/target/cosim/pseudo_terminal.hpp"

#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "hal/posix/descriptor_link.hpp"
#include "hal/posix/endpoints.hpp"

namespace cusp::cosim {

void run_on_terminal(ChipUnderTest& chip, const std::string& link, Picoseconds time)
{
    using Clock = std::chrono::steady_clock;
    const hal::PseudoTerminal terminal{link};
    hal::DescriptorLink line{terminal.open_controller_end()};
    line.survive_hang_up(true);
    std::cout << "terminal" << std::endl;
    std::string out;
    chip.line().set_receiver([&out](char byte) { out.push_back(byte); });
    const auto begin = Clock::now();
    bool opened = false;
    for (Picoseconds done = 0; done < time; done += kMillisecond) {
        std::string bytes;
        for (std::uint8_t byte = 0; line.try_read(byte);) {
            bytes.push_back(static_cast<char>(byte));
        }
        chip.line().send(bytes);
        const bool held = terminal.has_peer();
        opened = opened || held;
        if (opened && !held) {
            break;
        }
        chip.run(kMillisecond);
        // Until someone listens what is said is lost, as on a wire.
        for (const char character : opened ? out : std::string{}) {
            const auto byte = static_cast<std::uint8_t>(character);
            line.write({&byte, 1});
        }
        out.clear();
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds{done / 1000});
    }
}

}  // namespace cusp::cosim
