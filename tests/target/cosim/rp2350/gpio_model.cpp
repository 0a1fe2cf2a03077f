// Chapter 9 of the data sheet, and section 3.1.3.
#include "tests/target/cosim/rp2350/gpio_model.hpp"

#include <utility>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kIsolated = 1U << 8U;
constexpr std::uint32_t kOutputDisabled = 1U << 7U;
constexpr std::uint32_t kInputEnabled = 1U << 6U;
constexpr std::uint32_t kPullUp = 1U << 3U;
constexpr std::uint32_t kPullDown = 1U << 2U;
constexpr std::uint32_t kAllPins = (1U << GpioModel::kPins) - 1U;

}  // namespace

GpioModel::GpioModel(Circuit& circuit,
                     std::array<Driver, 3> pio,
                     std::function<void()> inputs_changed)
    : circuit_{circuit},
      pio_{std::move(pio)},
      inputs_changed_{std::move(inputs_changed)},
      functions_{circuit, [this](std::uint32_t offset) { return read_function(offset); },
                 [this](std::uint32_t offset, std::uint32_t value) {
                     if (offset >= kPins * 8 || offset % 8 != 4) {
                         circuit_.violate("IO_BANK0: a register is written that is not modelled, " +
                                          hexadecimal(offset));
                         return;
                     }
                     ctrl_[offset / 8] = value;
                     look();
                 },
                 [this] {
                     ctrl_.fill(31);
                     look();
                 }},
      pads_{circuit,
            [this](std::uint32_t offset) {
                return offset >= 4 && offset / 4 - 1 < kPins ? pad_[offset / 4 - 1] : 0U;
            },
            [this](std::uint32_t offset, std::uint32_t value) {
                if (offset < 4 || offset / 4 - 1 >= kPins) {
                    circuit_.violate("PADS_BANK0: a register is written that is not modelled, " +
                                     hexadecimal(offset));
                    return;
                }
                pad_[offset / 4 - 1] = value;
                look();
            },
            [this] {
                pad_.fill(kPadReset);
                look();
            }},
      core_{circuit, [this](std::uint32_t offset) { return read_core(offset); },
            [this](std::uint32_t offset, std::uint32_t value) { write_core(offset, value); },
            [this] {
                out_ = enable_ = 0;
                look();
            }}
{
    outside_.fill(-1);
    ctrl_.fill(31);
    pad_.fill(kPadReset);
}

void GpioModel::reset()
{
    functions_.reset();
    pads_.reset();
    core_.reset();
    held_ = {};
    look();
}

auto GpioModel::now_at(unsigned pin) const -> Held
{
    const unsigned function = this->function(pin);
    Held now{false, false, pad_[pin], function};
    if (function == kCoreFunction) {
        now.high = (out_ >> pin & 1U) != 0;
        now.driven = (enable_ >> pin & 1U) != 0;
    } else if (function >= kFirstPioFunction && function < kFirstPioFunction + pio_.size()) {
        const Driver& block = pio_[function - kFirstPioFunction];
        now.high = (block.levels() >> pin & 1U) != 0;
        now.driven = (block.directions() >> pin & 1U) != 0;
    } else {
        now.driven = function == kPwmFunction || (function == kUartFunction && pin % 4 == 0);
    }
    now.high = overridden(now.high, ctrl_[pin] >> 12U & 3U);
    now.driven = overridden(now.driven, ctrl_[pin] >> 14U & 3U) && (now.pad & kOutputDisabled) == 0;
    return now;
}

void GpioModel::look()
{
    std::uint32_t driven = 0;
    std::uint32_t levels = 0;
    for (unsigned pin = 0; pin < kPins; ++pin) {
        Held& held = held_[pin];
        if ((pad_[pin] & kIsolated) == 0) {
            held = now_at(pin);
        }
        if (held.driven && outside_[pin] >= 0) {
            circuit_.violate("GP" + std::to_string(pin) + ": driven from outside and from inside");
        }
        driven |= (this->driven(pin) ? 1U : 0U) << pin;
        levels |= (held.high ? 1U : 0U) << pin;
    }
    note(circuit_.now, driven, levels & driven);
    const std::uint32_t inputs = this->levels();
    if (std::exchange(seen_, inputs) != inputs) {
        inputs_changed_();
    }
}

bool GpioModel::driven(unsigned pin) const
{
    const Held& held = held_[pin];
    return held.driven && held.function >= kCoreFunction &&
           held.function < kFirstPioFunction + pio_.size();
}

int GpioModel::given_to(unsigned pin) const
{
    const Held& held = held_[pin];
    return held.function < kCoreFunction ? static_cast<int>(held.function) : -1;
}

bool GpioModel::ready(unsigned pin, unsigned function, bool as_input) const
{
    const Held& held = held_[pin];
    return held.function == function && (!as_input || (held.pad & kInputEnabled) != 0);
}

void GpioModel::drive(unsigned pin, int level)
{
    outside_.at(pin) = level;
    look();
}

std::uint32_t GpioModel::levels() const
{
    std::uint32_t levels = 0;
    for (unsigned pin = 0; pin < kPins; ++pin) {
        const Held& held = held_[pin];
        const bool wire = held.driven          ? held.high
                          : outside_[pin] >= 0 ? outside_[pin] != 0
                                               : (held.pad & kPullUp) != 0;
        const bool seen = wire && (held.pad & kInputEnabled) != 0;
        levels |= (overridden(seen, ctrl_[pin] >> 16U & 3U) ? 1U : 0U) << pin;
    }
    return levels;
}

// Erratum E9: a pull-down does not pull an input down that was high.
std::uint32_t GpioModel::inputs() const
{
    for (unsigned pin = 0; pin < kPins; ++pin) {
        const Held& held = held_[pin];
        constexpr std::uint32_t kPulledDown = kInputEnabled | kPullDown;
        if (!held.driven && held.function == kCoreFunction &&
            (held.pad & kPulledDown) == kPulledDown) {
            circuit_.violate("GP" + std::to_string(pin) +
                             ": an input with a pull-down (erratum E9)");
        }
    }
    return levels();
}

std::uint32_t GpioModel::read_core(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:  // the number of this core
        case 0x08:
        case 0x14:
        case 0x34:
            return 0;
        case 0x04:
            return inputs();
        case 0x10:
            return out_;
        case 0x30:
            return enable_;
        default:
            circuit_.violate("SIO: a register is read that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void GpioModel::write_core(std::uint32_t offset, std::uint32_t value)
{
    std::uint32_t& word = offset < 0x30 ? out_ : enable_;
    switch (offset) {
        case 0x10:
        case 0x30:
            word = value;
            break;
        case 0x18:
        case 0x38:
            word |= value;
            break;
        case 0x20:
        case 0x40:
            word &= ~value;
            break;
        case 0x28:
        case 0x48:
            word ^= value;
            break;
        default:
            circuit_.violate("SIO: a register is written that is not modelled, " +
                             hexadecimal(offset));
    }
    word &= kAllPins;
    look();
}

std::uint32_t GpioModel::read_function(std::uint32_t offset) const
{
    const unsigned pin = offset / 8;
    if (pin >= kPins) {
        circuit_.violate("IO_BANK0: a register is read that is not modelled, " +
                         hexadecimal(offset));
        return 0;
    }
    if (offset % 8 == 4) {
        return ctrl_[pin];
    }
    return (levels() >> pin & 1U) << 17U | (held_[pin].driven ? 1U << 13U : 0U) |
           (held_[pin].high ? 1U << 9U : 0U);
}

}  // namespace cusp::cosim::rp2350
