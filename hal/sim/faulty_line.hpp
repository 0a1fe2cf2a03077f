// FaultyLine: a serial line that damages, loses, doubles and delays bytes at random, from a seed.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <string>
#include <string_view>

namespace cusp::hal {

// Probabilities for each byte, 0 to 1.
struct LineFaults {
    double noise{0.0};     // one of its bits flips
    double loss{0.0};      // it never arrives
    double doubling{0.0};  // it arrives twice
    double delay{0.0};     // it and all that follow wait for up to delay_ticks
    std::uint32_t delay_ticks{20};
};

class FaultyLine {
public:
    FaultyLine(const LineFaults& faults, std::uint32_t seed) : faults_{faults}, random_{seed} {}

    // Bytes go in at one end ...
    void put(std::string_view bytes);
    // ... and come out at the other, in order.
    std::string take();
    // One servo tick passes.
    void advance();

    void set_faults(const LineFaults& faults) { faults_ = faults; }
    void clear() { bytes_.clear(); }
    // Faults done so far.
    std::uint64_t faults_done() const { return faults_done_; }

private:
    bool happens(double probability);

    struct Byte {
        char value;
        std::uint64_t due;  // tick
    };
    LineFaults faults_;
    std::mt19937 random_;
    std::deque<Byte> bytes_;
    std::uint64_t now_{0};
    std::uint64_t last_due_{0};
    std::uint64_t faults_done_{0};
};

}  // namespace cusp::hal
