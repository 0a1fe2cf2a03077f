// WatchdogModel: the independent watchdog, on the chip's slow oscillator at its fastest.
#pragma once

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class WatchdogModel final : public Model {
public:
    explicit WatchdogModel(Circuit& circuit) : Model{circuit} {}

    std::uint32_t read(std::uint32_t offset) override
    {
        return offset == 4 ? divisor_ : offset == 8 ? reload_ : 0U;
    }
    void write(std::uint32_t offset, std::uint32_t value) override
    {
        if (offset == 0) {
            open_ = value == 0x5555;
            running_ = running_ || value == 0xCCCC;
            if (value == 0xAAAA || value == 0xCCCC) {
                feed();
            }
        } else if (!open_) {
            circuit_.violate("IWDG: written while it is locked");
        } else {
            (offset == 4 ? divisor_ : reload_) = value;
            feed();
        }
    }
    void reset() override
    {
        open_ = running_ = bitten_ = frozen_ = false;
        divisor_ = 0;
        reload_ = 0xFFF;
        due_ = kNever;
    }
    void happen() override
    {
        due_ = kNever;
        bitten_ = true;
    }
    bool bitten() const { return bitten_; }
    // A debugger holds the core, and DBGMCU stops the watchdog with it.
    void freeze(bool on)
    {
        frozen_ = on;
        feed();
    }

private:
    void feed()
    {
        constexpr Picoseconds kFastest = kSecond / 47000;
        due_ = running_ && !frozen_ ? circuit_.now + kFastest * (4LL << divisor_) * (reload_ + 1)
                                    : kNever;
        circuit_.next_event = 0;
    }

    std::uint32_t divisor_{0}, reload_{0xFFF};
    bool open_{false}, running_{false}, bitten_{false}, frozen_{false};
};

}  // namespace cusp::cosim
