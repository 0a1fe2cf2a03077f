// InputFilter: debounced inputs. A level counts once it has lasted.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/panel.hpp"

namespace cusp::machine {

// Context: sample() in the servo tick, the rest anywhere.
class InputFilter {
public:
    // Ticks that an input must stay on or off before that counts; 0 takes it at once.
    void set_ticks(std::uint8_t ticks) noexcept { ticks_ = ticks; }

    // One sample a servo tick; bits of InputBit, on = 1.
    void sample(std::uint16_t inputs) noexcept;

    // Inputs as last sampled, and as they count.
    std::uint16_t raw() const noexcept { return raw_; }
    std::uint16_t steady() const noexcept { return steady_; }

    // Changes that did not last, since power-up: noise on the wires. Wraps.
    std::uint32_t glitches() const noexcept { return glitches_; }

private:
    std::array<std::uint8_t, kInputCount> differing_{};
    std::uint32_t glitches_{0};
    std::uint16_t raw_{0};
    std::uint16_t steady_{0};
    std::uint16_t counted_{0};  // inputs whose counter is above 0
    std::uint8_t ticks_{0};
};

}  // namespace cusp::machine
