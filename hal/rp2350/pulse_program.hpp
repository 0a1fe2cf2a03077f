// The program that a state machine of the PIO plays frames with, and the words that it is fed.
//
// A word has the pins' levels of one microsecond in its lower half, and in its upper half those that the pins take if no
// word follows: the same with the steps low. So a stream that ends leaves no step high, whatever the core does.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/pulse_frame.hpp"
#include "hal/rp2350/gp_pins.hpp"

namespace cusp::hal::rp2350 {

// Steps of X Y Z, directions of X Y Z, step and direction of the second motor, which a board may lack: the order of the
// bits of PulseLines.
using LinePins = std::array<Pin, 8>;

// 11.4: ten cycles, a microsecond at kProgramHz.
//
//   pull noblock       a word, or X where there is none
//   out pins, 16
//   out x, 16          the levels without a next word
//   in x, 16           twice, so that X is a word of them
//   in x, 16
//   mov x, isr [4]
inline constexpr std::uint32_t kProgramHz = 10000000;
inline constexpr std::array<std::uint16_t, 6> kPulseProgram{0x8080, 0x6010, 0x6030,
                                                            0x4030, 0x4030, 0xA426};
inline constexpr std::uint32_t kPullInstruction = 0x8080;
inline constexpr std::uint32_t kOutInstruction = 0x6010;
inline constexpr std::uint32_t kOnesInstruction = 0xA0EB;        // mov osr, not null
inline constexpr std::uint32_t kDirectionsInstruction = 0x6090;  // out pindirs, 16
inline constexpr std::uint32_t kBeginInstruction = 0x0000;       // jmp 0

// `Table` has kLines, on at most 16 neighbouring pins.
template <class Table>
class PulseWords {
    static constexpr const LinePins& kLines = Table::kLines;

public:
    static constexpr bool kSecondMotor = is_there(kLines[6]) && is_there(kLines[7]);
    // The lines that the board has.
    static constexpr PulseLines kAllLines = kSecondMotor ? 0xFF : 0x3F;

    static constexpr unsigned kFirstPin = [] {
        unsigned first = Pin::kNone;
        for (const Pin pin : kLines) {
            first = pin.number < first ? pin.number : first;
        }
        return first;
    }();
    static constexpr unsigned kPins = [] {
        unsigned last = 0;
        for (const Pin pin : kLines) {
            last = is_there(pin) && pin.number > last ? pin.number : last;
        }
        return last - kFirstPin + 1;
    }();
    static_assert(kPins <= 16, "the lines lie on more than 16 neighbouring pins");

    // The pins of these lines, by their numbers.
    static constexpr std::uint32_t pins(PulseLines lines) noexcept
    {
        std::uint32_t found = 0;
        for (unsigned line = 0; line < kLines.size(); ++line) {
            found |= (lines >> line & 1U) != 0 ? bit_of(kLines[line]) : 0U;
        }
        return found;
    }
    // The lines whose pins are high.
    static PulseLines lines(std::uint32_t pins) noexcept
    {
        std::uint32_t found = 0;
        for (unsigned line = 0; line < kLines.size(); ++line) {
            found |= (pins & bit_of(kLines[line])) != 0 ? 1U << line : 0U;
        }
        return static_cast<PulseLines>(found);
    }
    // Levels of the pins where these lines are high, from the first pin on.
    static std::uint32_t levels(PulseLines lines, PulseLines inverted) noexcept
    {
        return kTable[static_cast<PulseLines>((lines ^ inverted) & kAllLines)];
    }
    static std::uint32_t word(PulseLines lines, PulseLines inverted) noexcept
    {
        const auto at_rest = static_cast<PulseLines>(lines & ~unsigned{kStepLines});
        return levels(lines, inverted) | levels(at_rest, inverted) << 16U;
    }

private:
    static constexpr std::array<std::uint16_t, 256> kTable = [] {
        std::array<std::uint16_t, 256> table{};
        for (unsigned lines = 0; lines < table.size(); ++lines) {
            table[lines] = static_cast<std::uint16_t>(
                pins(static_cast<PulseLines>(lines & kAllLines)) >> kFirstPin);
        }
        return table;
    }();
};

}  // namespace cusp::hal::rp2350
