// VirtualController: the whole firmware and its mill in real time, behind a pseudo-terminal or a
// socket, for any Grbl sender; with fault injection.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "firmware/machine/settings.hpp"
#include "hal/posix/endpoints.hpp"
#include "hal/sim/faulty_line.hpp"

namespace cusp::simulate {

struct ServeOptions {
    // Exactly one of these two.
    std::string pty_link;
    std::optional<hal::TcpAddress> tcp;
    // Settings as text: read at the start if the file exists, rewritten when settings change. Data
    // that a settings file cannot hold (offsets, startup lines) is stored in a file of this name
    // with ".store" appended. Empty: nothing is stored.
    std::string settings_file;
    // Port for commands to the panel and for faults: see fault_command.hpp.
    std::optional<hal::TcpAddress> control;
    std::optional<double> probe_z;
    hal::LineFaults faults;  // of the line, in both directions
    std::uint32_t seed{1};
    // The power fails after this many words written to the settings store.
    std::optional<std::uint64_t> cut_power_after;
    // Inputs that always read high (or low), whatever the switches: bits of InputBit.
    std::uint16_t stuck_high{0};
    std::uint16_t stuck_low{0};
    std::string vcd_file;
    // Messages for the user: connections, disconnections, faults.
    std::function<void(const std::string&)> notice;
};

// Runs until `stop` is set. Errors: InputError if the port cannot be opened or the settings cannot
// be used.
void serve(const ServeOptions& options, const std::atomic<int>& stop);

}  // namespace cusp::simulate
