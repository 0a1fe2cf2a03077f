// Dwell: the clock of G4.
#pragma once

#include <cstdint>

namespace cusp::machine {

// Context: main loop.
class Dwell {
public:
    // `now`: servo ticks since power-up.
    void begin(double seconds, std::uint32_t now) noexcept;

    // True once the time is over. Asked each slice; while it is not asked, in a hold, the clock stands.
    bool over(std::uint32_t now) noexcept;

private:
    std::uint32_t left_{0};  // ticks
    std::uint32_t seen_{0};  // tick of the last question
};

}  // namespace cusp::machine
