// Pins: those of a port, as a wire outside sees them, and a record of every level that the chip drives.
#pragma once

#include <string>
#include <vector>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

// The pins of a port changed: which are driven as outputs, and which of those are high.
struct PinChange {
    Picoseconds time;
    std::uint32_t driven;
    std::uint32_t high;
};

class Pins {
public:
    Pins() = default;
    Pins(const Pins&) = delete;
    Pins& operator=(const Pins&) = delete;
    virtual ~Pins() = default;

    // State of a wire outside: 0 or 1 drives the pin, -1 leaves it open.
    virtual void drive(unsigned pin, int level) = 0;
    // As an output of the core's.
    virtual bool driven(unsigned pin) const = 0;
    virtual bool high(unsigned pin) const = 0;
    // Given to another block, and its number there; -1: not.
    virtual int given_to(unsigned pin) const = 0;
    virtual unsigned count() const = 0;
    // What stands before a pin's number in its name.
    virtual std::string name() const = 0;

    const std::vector<PinChange>& changes() const { return changes_; }
    // All but the last, which is how the pins stand.
    void forget_changes() { changes_.erase(changes_.begin(), changes_.end() - 1); }

protected:
    // True if that is a change.
    bool note(Picoseconds now, std::uint32_t driven, std::uint32_t high)
    {
        if (!changes_.empty() && changes_.back().driven == driven && changes_.back().high == high) {
            return false;
        }
        changes_.push_back({now, driven, high});
        return true;
    }

private:
    std::vector<PinChange> changes_;
};

}  // namespace cusp::cosim
