// VirtualController: the whole firmware and its mill in real time, behind a pseudo-terminal or a
// socket, for any Grbl sender; with faults on demand.
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
    // One of these two.
    std::string pty_link;
    std::optional<hal::TcpAddress> tcp;
    // Settings as text: read at the start where it is there, rewritten when settings change. What a
    // settings file can't hold (offsets, startup lines) goes to the file of this name with ".store"
    // behind it. Empty: nothing is kept.
    std::string settings_file;
    // Where commands for the panel and the faults are taken: fault_command.hpp lists them.
    std::optional<hal::TcpAddress> control;
    std::optional<double> probe_z;
    hal::LineFaults faults;  // of the line, both ways
    std::uint32_t seed{1};
    // The power fails after this many words written to the settings store.
    std::optional<std::uint64_t> cut_power_after;
    // Inputs that read high (or low) whatever the switches say: bits of InputBit.
    std::uint16_t stuck_high{0};
    std::uint16_t stuck_low{0};
    std::string vcd_file;
    // One sentence for the person who serves: who came, who went, what failed.
    std::function<void(const std::string&)> notice;
};

// Runs until `stop` is set. Throws InputError where the place can't be opened or the settings can't
// be used.
void serve(const ServeOptions& options, const std::atomic<int>& stop);

}  // namespace cusp::simulate
