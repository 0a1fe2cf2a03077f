// FaultCommand: one line of the virtual controller's control port: faults to inject, and operation
// of its panel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/faulty_line.hpp"

namespace cusp::simulate {

enum class FaultKind : std::uint8_t {
    kUnplug,         // unplug
    kPlug,           // plug
    kPowerOff,       // power off
    kPowerOn,        // power on
    kCutPowerAfter,  // cut N              words written to the settings store until power fails
    kInputHigh,      // high INPUT         x y z limits, probe, door, hold, start, reset
    kInputLow,       // low INPUT
    kInputFree,      // free INPUT
    kProbePlate,     // plate Z            mm above the position at power-up
    kLineFaults,     // line noise=P loss=P doubling=P delay=P
    kLoseFrame,      // lose-frame         a pulse frame is late
    kOverrun,        // overrun            the serial port loses bytes
    kWhere,          // where              reports position, steps, inputs and outputs
};

struct FaultCommand {
    FaultKind kind{FaultKind::kWhere};
    double value{0};
    std::uint16_t inputs{0};
    hal::LineFaults faults;
};

// None if the line is no command.
std::optional<FaultCommand> parse_fault_command(std::string_view line);

// "noise=0.005,loss=0.001": none if malformed, or if a probability is not in 0 to 1.
std::optional<hal::LineFaults> parse_line_faults(std::string_view text);

// The bit of InputBit for an input's name; 0 if there is none of this name.
std::uint16_t input_named(std::string_view name);

// The bits of all of them. Throws InputError that begins with `option` where there is none of a name.
std::uint16_t inputs_named(const std::vector<std::string>& names, const char* option);

}  // namespace cusp::simulate
