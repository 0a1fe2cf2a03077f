// ToolTimes: the time that each tool of a program is in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/base/pulse_frame.hpp"

namespace cusp::program_run {

struct ToolTime {
    int number;           // its T word; 0: the program names none
    std::uint64_t ticks;  // servo ticks of cuts, rapid moves and dwells

    double seconds() const { return static_cast<double>(ticks) / kServoTicksPerSecond; }
};

// Lines are sent long before they are executed, so a tool's time starts with the first move after
// its T word. Ticks before the first T word count for the first tool.
class ToolTimes {
public:
    // The tool in the spindle after a line; in the order of the program.
    void read_line(std::uint64_t line, int tool);

    // One servo tick, in which the line was executed.
    void add_tick(std::uint32_t executing_line);

    // In the order of their first use.
    const std::vector<ToolTime>& times() const { return times_; }
    // Number of changes from one tool to another.
    std::uint64_t changes() const { return changes_; }

private:
    struct Start {
        std::uint64_t line;
        std::size_t tool;  // in times_
    };
    std::size_t place_of(int tool);

    std::vector<ToolTime> times_{{0, 0}};
    std::vector<Start> starts_{{0, 0}};
    std::size_t current_{0};  // of starts_
    int named_{0};            // last
    std::uint64_t changes_{0};
};

}  // namespace cusp::program_run
