// Sections 12.8, 12.9, 7.4 and 12.5 of the data sheet.
#include "tests/target/cosim/rp2350/timers.hpp"

#include <algorithm>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kTrigger = 1U << 31U;
constexpr std::uint32_t kEnable = 1U << 30U;
constexpr std::uint32_t kCore = 1U << 23U;        // of the sequencer's blocks
constexpr std::uint32_t kOscillators = 3U << 2U;  // of those that run the watchdog
constexpr std::uint32_t kMostCount = 0xFFFFFF;

}  // namespace

Watchdog::Watchdog(Circuit& circuit, std::function<std::uint32_t()> tick_hz)
    : Model{circuit},
      tick_hz_{std::move(tick_hz)},
      sequencer_{
          circuit,
          [this](std::uint32_t offset) {
              return offset == 8 ? selected_ : offset == 12 ? 0x1FFFFFFU : 0U;
          },
          [this](std::uint32_t offset, std::uint32_t value) {
              if (offset == 8) {
                  selected_ = value;
              } else if (value != 0) {
                  circuit_.violate("PSM: a block is forced on or off, which is not modelled");
              }
          },
          [] {
          }}
{
}

void Watchdog::reset()
{
    ctrl_ = 0x07000000;
    selected_ = 0;
    count_ = 0;
    bitten_ = frozen_ = false;
    plan();
}

void Watchdog::power_up()
{
    reason_ = 0;
    scratch_ = {};
}

std::uint32_t Watchdog::left() const
{
    if (due_ == kNever) {
        return count_;
    }
    const Picoseconds tick = kSecond / std::max(1U, tick_hz_());
    const auto passed = static_cast<std::uint64_t>((circuit_.now - since_) / tick);
    return passed >= count_ ? 0U : count_ - static_cast<std::uint32_t>(passed);
}

void Watchdog::plan()
{
    const std::uint32_t hz = tick_hz_();
    const bool runs = (ctrl_ & kEnable) != 0 && !frozen_ && hz != 0;
    since_ = circuit_.now;
    due_ = runs ? circuit_.now + kSecond / hz * count_ : kNever;
    circuit_.next_event = 0;
}

void Watchdog::look_again()
{
    count_ = left();
    plan();
}

void Watchdog::freeze(bool on)
{
    count_ = left();
    frozen_ = on && (ctrl_ >> 25U & 1U) != 0;
    plan();
}

void Watchdog::bite(std::uint32_t reason)
{
    if ((selected_ & kCore) == 0) {
        circuit_.violate("WATCHDOG: bites, and PSM_WDSEL leaves the core out");
    }
    reason_ = reason;
    bitten_ = true;
}

void Watchdog::happen()
{
    due_ = kNever;
    bite(1);
}

std::uint32_t Watchdog::read(std::uint32_t offset)
{
    if (offset >= 0x0C && offset < 0x2C) {
        return scratch_[(offset - 0x0C) / 4];
    }
    return offset == 0 ? ctrl_ | left() : offset == 8 ? reason_ : 0U;
}

void Watchdog::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset >= 0x0C && offset < 0x2C) {
        scratch_[(offset - 0x0C) / 4] = value;
    } else if (offset == 0) {
        count_ = left();
        ctrl_ = value & 0x47000000U;
        if ((ctrl_ & kEnable) != 0) {
            if (tick_hz_() != 1000000) {
                circuit_.violate("WATCHDOG: on with " + std::to_string(tick_hz_()) +
                                 " ticks a second");
            }
            if ((selected_ & kOscillators) != 0) {
                circuit_.violate("PSM: the watchdog resets the oscillator that it runs from");
            }
        }
        plan();
        if ((value & kTrigger) != 0) {
            bite(2);
        }
    } else if (offset == 4) {
        if (value > kMostCount) {
            circuit_.violate("WATCHDOG: a time that is too long");
        }
        count_ = value & kMostCount;
        plan();
    } else {
        circuit_.violate("WATCHDOG: a register is written that is not modelled");
    }
}

Timer0::Timer0(Circuit& circuit, std::function<std::uint32_t()> tick_hz)
    : Model{circuit}, tick_hz_{std::move(tick_hz)}
{
}

void Timer0::reset()
{
    alarms_ = {};
    armed_ = raised_ = enabled_ = forced_ = latched_ = 0;
    since_ = circuit_.now;
    update();
}

std::uint64_t Timer0::time() const
{
    return static_cast<std::uint64_t>((circuit_.now - since_) / kMicrosecond);
}

void Timer0::update()
{
    due_ = kNever;
    const std::uint64_t now = time();
    for (unsigned i = 0; i < alarms_.size(); ++i) {
        circuit_.set_line(i, (((raised_ & enabled_) | forced_) >> i & 1U) != 0);
        if ((armed_ >> i & 1U) != 0) {
            const std::uint32_t away = alarms_[i] - static_cast<std::uint32_t>(now);
            due_ = std::min(due_, since_ + static_cast<Picoseconds>(now + away) * kMicrosecond);
        }
    }
    circuit_.next_event = 0;
}

void Timer0::happen()
{
    const auto now = static_cast<std::uint32_t>(time());
    for (unsigned i = 0; i < alarms_.size(); ++i) {
        if ((armed_ >> i & 1U) != 0 && alarms_[i] == now) {
            armed_ &= ~(1U << i);
            raised_ |= 1U << i;
        }
    }
    update();
}

std::uint32_t Timer0::read(std::uint32_t offset)
{
    if (tick_hz_() != 1000000) {
        circuit_.violate("TIMER0: read with " + std::to_string(tick_hz_()) + " ticks a second");
    }
    switch (offset) {
        case 0x08:
            return latched_;
        case 0x0C:
            latched_ = static_cast<std::uint32_t>(time() >> 32U);
            return static_cast<std::uint32_t>(time());
        case 0x20:
            return armed_;
        case 0x24:
            return static_cast<std::uint32_t>(time() >> 32U);
        case 0x28:
            return static_cast<std::uint32_t>(time());
        case 0x3C:
            return raised_;
        case 0x40:
            return enabled_;
        case 0x44:
            return forced_;
        case 0x48:
            return (raised_ & enabled_) | forced_;
        default:
            return offset >= 0x10 && offset < 0x20 ? alarms_[(offset - 0x10) / 4] : 0U;
    }
}

void Timer0::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset >= 0x10 && offset < 0x20) {
        alarms_[(offset - 0x10) / 4] = value;
        armed_ |= 1U << (offset - 0x10) / 4;
    } else if (offset == 0x20) {
        armed_ &= ~value;
    } else if (offset == 0x3C) {
        raised_ &= ~value;
    } else if (offset == 0x40) {
        enabled_ = value;
    } else if (offset == 0x44) {
        forced_ = value;
    } else {
        circuit_.violate("TIMER0: a register is written that is not modelled, " +
                         hexadecimal(offset));
    }
    update();
}

PulseWidths::PulseWidths(Circuit& circuit, std::function<std::uint32_t()> clock_hz)
    : Model{circuit}, clock_hz_{std::move(clock_hz)}
{
}

std::uint32_t PulseWidths::duty_ppm(unsigned output) const
{
    const Slice& slice = slices_[output / 2];
    const std::uint32_t compare = slice.compare >> 16 * (output % 2) & 0xFFFFU;
    const bool inverted = (slice.csr >> (2 + output % 2) & 1U) != 0;
    std::uint64_t ppm = (slice.csr & 1U) == 0 ? (slice.counter < compare ? 1000000 : 0)
                                              : std::uint64_t{compare} * 1000000 / (slice.top + 1);
    ppm = std::min<std::uint64_t>(ppm, 1000000);
    return static_cast<std::uint32_t>(inverted ? 1000000 - ppm : ppm);
}

std::uint32_t PulseWidths::pulses_hz(unsigned output) const
{
    const Slice& slice = slices_[output / 2];
    const std::uint64_t sixteenths = std::max(1U, slice.div & 0xFFFU);
    return static_cast<std::uint32_t>(std::uint64_t{clock_hz_()} * 16 / sixteenths /
                                      (slice.top + 1));
}

std::uint32_t PulseWidths::read(std::uint32_t offset)
{
    if (offset == 0xF0) {
        std::uint32_t on = 0;
        for (unsigned i = 0; i < kSlices; ++i) {
            on |= (slices_[i].csr & 1U) << i;
        }
        return on;
    }
    if (offset > 0xF0) {
        circuit_.violate("PWM: a register is read that is not modelled, " + hexadecimal(offset));
        return 0;
    }
    const Slice& slice = slices_[offset / 20];
    const std::uint32_t words[] = {slice.csr, slice.div, slice.counter, slice.compare, slice.top};
    return words[offset % 20 / 4];
}

void PulseWidths::write(std::uint32_t offset, std::uint32_t value)
{
    if (offset == 0xF0) {
        for (unsigned i = 0; i < kSlices; ++i) {
            slices_[i].csr = (slices_[i].csr & ~1U) | (value >> i & 1U);
        }
        return;
    }
    if (offset > 0xF0) {
        circuit_.violate("PWM: a register is written that is not modelled, " + hexadecimal(offset));
        return;
    }
    Slice& slice = slices_[offset / 20];
    std::uint32_t* const words[] = {&slice.csr, &slice.div, &slice.counter, &slice.compare,
                                    &slice.top};
    if (offset % 20 == 0 && (value & 0x32U) != 0) {
        circuit_.violate("PWM: a slice that is gated or counts down, which is not modelled");
    }
    *words[offset % 20 / 4] = value;
    for (unsigned channel = 0; channel < 2; ++channel) {
        const unsigned output = offset / 20 * 2 + channel;
        changes_.push_back({circuit_.now, output, duty_ppm(output)});
    }
}

}  // namespace cusp::cosim::rp2350
