// PortModel: a GPIO port: modes, pulls, what hangs on its pins, and a record of every level that it drives.
#pragma once

#include <functional>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

// The pins of a port changed: which are driven as outputs, and which of those are high.
struct PinChange {
    Picoseconds time;
    std::uint16_t driven;
    std::uint16_t high;
};

class PortModel final : public Model {
public:
    PortModel(Circuit& circuit, char letter);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    // The set/reset register, written by a DMA controller: the pins must be outputs.
    void write_by_dma(std::uint32_t offset, std::uint32_t value);

    // State of a wire outside: 0 or 1 drives the pin, -1 leaves it open.
    void drive(unsigned pin, int level);
    unsigned mode(unsigned pin) const { return moder_ >> 2 * pin & 3U; }
    unsigned function(unsigned pin) const { return afr_[pin / 8] >> 4 * (pin % 8) & 15U; }
    bool driven(unsigned pin) const { return mode(pin) == 1; }
    bool high(unsigned pin) const { return (odr_ >> pin & 1U) != 0; }
    char letter() const { return letter_; }
    // Something outside drives it.
    bool held(unsigned pin) const { return outside_[pin] >= 0; }
    // Level of the wire at a pin, whoever drives it; a wire that nobody drives is high.
    bool wire_high(unsigned pin) const { return driven(pin) ? high(pin) : outside_[pin] != 0; }
    // Called when the port's outputs change.
    void set_listener(unsigned pin, std::function<void()> listener)
    {
        listeners_.push_back({pin, std::move(listener)});
    }

    const std::vector<PinChange>& changes() const { return changes_; }
    // All but the last, which is how the pins stand.
    void forget_changes() { changes_.erase(changes_.begin(), changes_.end() - 1); }

private:
    std::uint32_t levels() const;
    std::uint16_t outputs() const;
    void set_reset(std::uint32_t value) { odr_ = (odr_ & ~(value >> 16U)) | (value & 0xFFFFU); }
    void note();

    char letter_;
    std::uint32_t moder_{0}, otyper_{0}, ospeedr_{0}, pupdr_{0}, odr_{0}, lckr_{0};
    std::array<std::uint32_t, 2> afr_{};
    std::array<int, 16> outside_{};
    std::uint16_t outputs_{0};
    std::vector<PinChange> changes_;
    struct Listener {
        unsigned pin;
        std::function<void()> call;
    };
    std::vector<Listener> listeners_;
};

}  // namespace cusp::cosim
