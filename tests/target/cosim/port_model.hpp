// PortModel: a GPIO port: modes, pulls, what hangs on its pins, and a record of every level that it drives.
#pragma once

#include <functional>

#include "tests/target/cosim/model.hpp"
#include "tests/target/cosim/pins.hpp"

namespace cusp::cosim {

class PortModel final : public Model, public Pins {
public:
    PortModel(Circuit& circuit, char letter);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    // The set/reset register, written by a DMA controller: the pins must be outputs.
    void write_by_dma(std::uint32_t offset, std::uint32_t value);

    // Pins
    void drive(unsigned pin, int level) override;
    bool driven(unsigned pin) const override { return mode(pin) == 1; }
    bool high(unsigned pin) const override { return (odr_ >> pin & 1U) != 0; }
    int given_to(unsigned pin) const override
    {
        return mode(pin) == 2 ? static_cast<int>(function(pin)) : -1;
    }
    unsigned count() const override { return 16; }
    std::string name() const override { return std::string{"P"} + letter_; }

    unsigned mode(unsigned pin) const { return moder_ >> 2 * pin & 3U; }
    unsigned function(unsigned pin) const { return afr_[pin / 8] >> 4 * (pin % 8) & 15U; }
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

private:
    std::uint32_t levels() const;
    std::uint16_t outputs() const;
    void set_reset(std::uint32_t value) { odr_ = (odr_ & ~(value >> 16U)) | (value & 0xFFFFU); }
    void look();

    char letter_;
    std::uint32_t moder_{0}, otyper_{0}, ospeedr_{0}, pupdr_{0}, odr_{0}, lckr_{0};
    std::array<std::uint32_t, 2> afr_{};
    std::array<int, 16> outside_{};
    std::uint16_t outputs_{0};
    struct Listener {
        unsigned pin;
        std::function<void()> call;
    };
    std::vector<Listener> listeners_;
};

}  // namespace cusp::cosim
