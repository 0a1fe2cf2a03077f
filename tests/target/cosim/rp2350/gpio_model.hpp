// GpioModel: 30 pins: functions (IO_BANK0), pads with their isolation (PADS_BANK0), the core's registers (SIO).
#pragma once

#include "tests/target/cosim/pins.hpp"
#include "tests/target/cosim/rp2350/facet.hpp"

namespace cusp::cosim::rp2350 {

class GpioModel final : public Pins {
public:
    static constexpr unsigned kPins = 30;
    static constexpr unsigned kUartFunction = 2;
    static constexpr unsigned kPwmFunction = 4;
    static constexpr unsigned kCoreFunction = 5;
    static constexpr unsigned kFirstPioFunction = 6;
    // Levels and directions that a PIO block drives.
    struct Driver {
        std::function<std::uint32_t()> levels;
        std::function<std::uint32_t()> directions;
    };
    // `inputs_changed`: a level that the blocks see is another one.
    GpioModel(Circuit& circuit, std::array<Driver, 3> pio, std::function<void()> inputs_changed);

    void reset();
    Model& functions() { return functions_; }
    Model& pads() { return pads_; }
    Model& core() { return core_; }

    // Levels as the blocks inside see them.
    std::uint32_t levels() const;
    // What drives the pins may be something else now.
    void look();
    // The pin is given to this function, its pad is not isolated, and takes what comes where that is asked for.
    bool ready(unsigned pin, unsigned function, bool as_input) const;

    // Pins
    void drive(unsigned pin, int level) override;
    bool driven(unsigned pin) const override;
    bool high(unsigned pin) const override { return (held_[pin].high); }
    int given_to(unsigned pin) const override;
    unsigned count() const override { return kPins; }
    std::string name() const override { return "GP"; }

private:
    // At the pad, behind the latch.
    struct Held {
        bool high{false}, driven{false};
        std::uint32_t pad{kPadReset};
        unsigned function{31};
    };
    static constexpr std::uint32_t kPadReset = 0x116;

    unsigned function(unsigned pin) const { return ctrl_[pin] & 31U; }
    Held now_at(unsigned pin) const;
    std::uint32_t read_core(std::uint32_t offset);
    void write_core(std::uint32_t offset, std::uint32_t value);
    std::uint32_t read_function(std::uint32_t offset) const;
    std::uint32_t inputs() const;
    static bool overridden(bool level, unsigned how)
    {
        return how == 0 ? level : how == 1 ? !level : how == 3;
    }

    Circuit& circuit_;
    std::array<Driver, 3> pio_;
    std::function<void()> inputs_changed_;
    Facet functions_, pads_, core_;
    std::array<std::uint32_t, kPins> ctrl_{}, pad_{};
    std::array<Held, kPins> held_{};
    std::array<int, kPins> outside_{};
    std::uint32_t out_{0}, enable_{0};
    std::uint32_t seen_{0};
};

}  // namespace cusp::cosim::rp2350
