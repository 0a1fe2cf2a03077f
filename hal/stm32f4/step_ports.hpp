// StepPorts: the ports of the step and direction lines, computed at compile time.
//
//   struct Table { static constexpr LinePins kLines{{{'E', 2}, {'D', 5}, ...}}; };
//   using Ports = StepPorts<Table>;                // Ports::kCount == 2: ports E and D
//   Chip::port(Ports::kLetters[0]).bsrr.write(Ports::word<0>(up, down));
//
// The ports are numbered in the order in which kLines names them.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/stm32f4/pins.hpp"

namespace cusp::hal::stm32f4 {

// Steps of X Y Z, directions of X Y Z, step and direction of the second motor, which a board may lack:
// the order of the bits of PulseLines.
using LinePins = std::array<Pin, 8>;

constexpr unsigned count_ports(const LinePins& lines) noexcept
{
    std::uint32_t ports = 0;
    unsigned count = 0;
    for (const Pin pin : lines) {
        count += is_there(pin) && (ports & clock_bit(pin)) == 0 ? 1U : 0U;
        ports |= clock_bit(pin);
    }
    return count;
}
constexpr bool has_second_motor(const LinePins& lines) noexcept
{
    return is_there(lines[6]) && is_there(lines[7]);
}

template <class Table>
class StepPorts {
    static constexpr const LinePins& kLines = Table::kLines;

public:
    static constexpr unsigned kCount = count_ports(kLines);
    // The lines that the board has.
    static constexpr PulseLines kAllLines = has_second_motor(kLines) ? 0xFF : 0x3F;

    static constexpr std::array<char, kCount> kLetters = [] {
        std::array<char, kCount> letters{};
        unsigned count = 0;
        for (const Pin pin : kLines) {
            bool known = !is_there(pin);
            for (unsigned i = 0; i < count; ++i) {
                known = known || letters[i] == pin.port;
            }
            if (!known) {
                letters[count] = pin.port;
                ++count;
            }
        }
        return letters;
    }();

    // The port's pins of these lines, one bit each.
    template <unsigned kPort>
    static std::uint32_t pins(PulseLines lines) noexcept
    {
        if constexpr (in_place()) {
            return lines;
        } else {
            return kPins[kPort][lines];
        }
    }
    // Word to write to the port's set/reset register.
    template <unsigned kPort>
    static std::uint32_t word(PulseLines up, PulseLines down) noexcept
    {
        return pins<kPort>(up) | pins<kPort>(down) << 16U;
    }
    // The lines that are high among the port's pins.
    template <unsigned kPort>
    static PulseLines lines(std::uint32_t pins) noexcept
    {
        std::uint32_t found = 0;
        for (unsigned line = 0; line < kLines.size(); ++line) {
            if (kLines[line].port == kLetters[kPort]) {
                found |= (pins >> kLines[line].number & 1U) << line;
            }
        }
        return static_cast<PulseLines>(found);
    }

private:
    // Lines on pins 0 and up of one port, in order, need no table.
    static constexpr bool in_place() noexcept
    {
        for (unsigned line = 0; line < kLines.size(); ++line) {
            if (is_there(kLines[line]) && kLines[line].number != line) {
                return false;
            }
        }
        return kCount == 1;
    }
    using PinsOfLines = std::array<std::uint16_t, unsigned{kAllLines} + 1>;
    static constexpr std::array<PinsOfLines, kCount> kPins = [] {
        std::array<PinsOfLines, kCount> table{};
        for (unsigned port = 0; port < kCount; ++port) {
            for (unsigned lines = 0; lines <= kAllLines; ++lines) {
                std::uint32_t pins = 0;
                for (unsigned line = 0; line < kLines.size(); ++line) {
                    const bool here = kLines[line].port == kLetters[port];
                    pins |= here ? (lines >> line & 1U) << kLines[line].number : 0U;
                }
                table[port][lines] = static_cast<std::uint16_t>(pins);
            }
        }
        return table;
    }();
};

// Levels at the pins of lines that go high and low; `inverted` has a 1 for each line whose pin is
// low where the line is high.
struct PinLevels {
    PulseLines up;
    PulseLines down;
};
constexpr PinLevels pin_levels(PulseLines raise, PulseLines lower, PulseLines inverted) noexcept
{
    return {static_cast<PulseLines>((raise & ~inverted) | (lower & inverted)),
            static_cast<PulseLines>((lower & ~inverted) | (raise & inverted))};
}

}  // namespace cusp::hal::stm32f4
