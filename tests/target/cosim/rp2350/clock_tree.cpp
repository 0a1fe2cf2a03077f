// Sections 8.1 to 8.6 of the data sheet.
#include "tests/target/cosim/rp2350/clock_tree.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kRingHz = 11000000;
constexpr std::uint32_t kMostSystemHz = 150000000;
constexpr std::uint32_t kEnabled = 1U << 11U;  // of a generator
constexpr Picoseconds kLockTime = 50 * kMicrosecond;
// Sources of the reference and of the auxiliary inputs, as one number each.
enum Source : unsigned {
    kRing,
    kCrystal,
    kPllSystem,
    kPllUsb,
    kReferenceClock,
    kSystemClock,
    kNone
};

}  // namespace

ClockTree::ClockTree(Circuit& circuit, std::uint32_t crystal_hz, std::function<void()> changed)
    : circuit_{circuit},
      crystal_hz_{crystal_hz},
      changed_{std::move(changed)},
      crystal_{circuit,
               [this](std::uint32_t offset) {
                   return offset == 0      ? crystal_ctrl_
                          : offset == 4    ? crystal_status()
                          : offset == 0x0C ? crystal_startup_
                                           : 0U;
               },
               [this](std::uint32_t offset, std::uint32_t value) { write_crystal(offset, value); },
               [] {
               }},
      ring_{circuit,
            [](std::uint32_t offset) { return offset == 0x18 ? 1U << 31U | 1U << 12U : 0U; },
            [this](std::uint32_t, std::uint32_t) {
                circuit_.violate("ROSC: its rate is changed, which is not modelled");
            },
            [] {
            }},
      generators_{
          circuit, [this](std::uint32_t offset) { return read_generator(offset); },
          [this](std::uint32_t offset, std::uint32_t value) { write_generator(offset, value); },
          [] {
          }},
      ticks_{
          circuit,
          [this](std::uint32_t offset) {
              const Tick& tick = tickers_.at(offset / 12 % tickers_.size());
              const std::uint32_t running = (tick.ctrl & 1U) << 1U;
              return offset % 12 == 0 ? tick.ctrl | running : offset % 12 == 4 ? tick.cycles : 0U;
          },
          [this](std::uint32_t offset, std::uint32_t value) {
              Tick& tick = tickers_.at(offset / 12 % tickers_.size());
              (offset % 12 == 0 ? tick.ctrl : tick.cycles) = value & (offset % 12 == 0 ? 1U : 511U);
              look();
          },
          [] {
          }}
{
    for (unsigned i = 0; i < plls_.size(); ++i) {
        plls_[i].registers = std::make_unique<Facet>(
            circuit, [this, i](std::uint32_t offset) { return read_pll(plls_[i], offset); },
            [this, i](std::uint32_t offset, std::uint32_t value) { write_pll(i, offset, value); },
            [this, i] {
                Pll& pll = plls_[i];
                pll.cs = 1;
                pll.pwr = 0x2D;
                pll.feedback = 0;
                pll.prim = 0x77000;
                pll.locked_at = kNever;
                look();
            });
    }
}

void ClockTree::reset()
{
    crystal_ctrl_ = 0;
    crystal_startup_ = 0xC4;
    crystal_since_ = kNever;
    clocks_ = {};
    tickers_ = {};
    for (Pll& pll : plls_) {
        pll.registers->reset();
    }
    look();
}

bool ClockTree::crystal_stable() const
{
    if (crystal_hz_ == 0 || crystal_since_ == kNever) {
        return false;
    }
    const Picoseconds wait =
        kSecond / crystal_hz_ * 256 * static_cast<Picoseconds>(crystal_startup_ & 0x3FFFU);
    return circuit_.now >= crystal_since_ + wait;
}

std::uint32_t ClockTree::crystal_status() const
{
    return (crystal_since_ != kNever ? 1U << 12U : 0U) | (crystal_stable() ? 1U << 31U : 0U);
}

void ClockTree::write_crystal(std::uint32_t offset, std::uint32_t value)
{
    if (offset == 0) {
        const bool on = (value >> 12U & 0xFFFU) == 0xFAB;
        if (on && (value & 0xFFFU) != 0xAA0) {
            circuit_.violate("XOSC: a range other than 1 to 15 MHz");
        }
        // A crystal needs a millisecond.
        if (on && (crystal_startup_ & 0x3FFFU) * std::uint64_t{256} * 1000 < crystal_hz_) {
            circuit_.violate("XOSC: counts as stable before a millisecond has gone by");
        }
        crystal_since_ = !on ? kNever : crystal_since_ == kNever ? circuit_.now : crystal_since_;
        crystal_ctrl_ = value;
    } else if (offset == 0x0C) {
        crystal_startup_ = value;
    } else {
        circuit_.violate("XOSC: a register is written that is not modelled, " +
                         hexadecimal(offset));
    }
    look();
}

std::uint32_t ClockTree::read_pll(const Pll& pll, std::uint32_t offset) const
{
    switch (offset) {
        case 0x00:
            return pll.cs | (circuit_.now >= pll.locked_at ? 1U << 31U : 0U);
        case 0x04:
            return pll.pwr;
        case 0x08:
            return pll.feedback;
        case 0x0C:
            return pll.prim;
        default:
            return 0;
    }
}

void ClockTree::write_pll(unsigned number, std::uint32_t offset, std::uint32_t value)
{
    Pll& pll = plls_[number];
    const std::string name = number == 0 ? "PLL_SYS" : "PLL_USB";
    if (pll_used(number)) {
        circuit_.violate(name + ": changed while a clock comes from it");
    }
    std::uint32_t* const place = offset == 0      ? &pll.cs
                                 : offset == 4    ? &pll.pwr
                                 : offset == 8    ? &pll.feedback
                                 : offset == 0x0C ? &pll.prim
                                                  : nullptr;
    if (place == nullptr) {
        circuit_.violate(name + ": a register is written that is not modelled, " +
                         hexadecimal(offset));
        return;
    }
    *place = value;
    constexpr std::uint32_t kLoopOff = 0x21;  // PD, VCOPD
    const bool on = (pll.pwr & kLoopOff) == 0 && crystal_stable();
    if (!on) {
        pll.locked_at = kNever;
    } else if (pll.locked_at == kNever || offset == 0 || offset == 8) {
        pll.locked_at = circuit_.now + kLockTime;
        const std::uint64_t reference = crystal_hz_ / std::max(1U, pll.cs & 0x3FU);
        const std::uint64_t vco = reference * pll.feedback;
        if (reference < 5000000 || pll.feedback < 16 || pll.feedback > 320 || vco < 750000000 ||
            vco > 1600000000) {
            circuit_.violate(name + ": its oscillator at " + std::to_string(vco) + " Hz");
        }
    }
    look();
}

std::uint32_t ClockTree::pll_hz(unsigned number) const
{
    const Pll& pll = plls_[number];
    const std::uint32_t first = pll.prim >> 16U & 7U;
    const std::uint32_t second = pll.prim >> 12U & 7U;
    if ((pll.pwr & 0x29U) != 0 || first == 0 || second == 0 || pll.locked_at == kNever) {
        return 0;
    }
    const std::uint64_t reference = crystal_hz_ / std::max(1U, pll.cs & 0x3FU);
    return static_cast<std::uint32_t>(reference * pll.feedback / (first * second));
}

bool ClockTree::pll_used(unsigned number) const
{
    const auto aux = [this](unsigned clock) {
        return clocks_[clock].ctrl >> 5U & 7U;
    };
    const bool system = (clocks_[kSystem].ctrl & 1U) != 0 && aux(kSystem) == number;
    const bool peripheral =
        (clocks_[kPeripheral].ctrl & kEnabled) != 0 && aux(kPeripheral) == 1 + number;
    const bool usb = (clocks_[kUsb].ctrl & kEnabled) != 0 && aux(kUsb) == 1 - number;
    return system || peripheral || usb;
}

std::uint32_t ClockTree::source_hz(unsigned source) const
{
    switch (source) {
        case kRing:
            return kRingHz;
        case kCrystal:
            return crystal_stable() ? crystal_hz_ : 0U;
        case kPllSystem:
            return pll_hz(0);
        case kPllUsb:
            return pll_hz(1);
        case kReferenceClock:
            return reference_hz();
        case kSystemClock:
            return system_hz();
        default:
            return 0;
    }
}

std::uint32_t ClockTree::reference_hz() const
{
    const std::uint32_t source = clocks_[kReference].ctrl & 3U;
    const std::uint32_t by = std::max(1U, clocks_[kReference].div >> 16U & 255U);
    return source_hz(source == 0   ? kRing
                     : source == 2 ? kCrystal
                     : source == 1 ? kPllUsb
                                   : kNone) /
           by;
}

std::uint32_t ClockTree::system_hz() const
{
    constexpr Source kAux[] = {kPllSystem, kPllUsb, kRing, kCrystal, kNone, kNone, kNone, kNone};
    const Generator& clock = clocks_[kSystem];
    const std::uint32_t hz =
        (clock.ctrl & 1U) == 0 ? reference_hz() : source_hz(kAux[clock.ctrl >> 5U & 7U]);
    return hz / std::max(1U, clock.div >> 16U);
}

std::uint32_t ClockTree::peripheral_hz() const
{
    constexpr Source kAux[] = {kSystemClock, kPllSystem, kPllUsb, kRing,
                               kCrystal,     kNone,      kNone,   kNone};
    const Generator& clock = clocks_[kPeripheral];
    return (clock.ctrl & kEnabled) == 0
               ? 0
               : source_hz(kAux[clock.ctrl >> 5U & 7U]) / std::max(1U, clock.div >> 16U & 3U);
}

std::uint32_t ClockTree::usb_hz() const
{
    constexpr Source kAux[] = {kPllUsb, kPllSystem, kRing, kCrystal, kNone, kNone, kNone, kNone};
    const Generator& clock = clocks_[kUsb];
    return (clock.ctrl & kEnabled) == 0
               ? 0
               : source_hz(kAux[clock.ctrl >> 5U & 7U]) / std::max(1U, clock.div >> 16U & 15U);
}

std::uint32_t ClockTree::tick_hz(unsigned generator) const
{
    const Tick& tick = tickers_[generator];
    return (tick.ctrl & 1U) == 0 || tick.cycles == 0 ? 0 : reference_hz() / tick.cycles;
}

// The counter's sources are numbered otherwise.
std::uint32_t ClockTree::measured_khz() const
{
    switch (counter_source_) {
        case 1:
            return pll_hz(0) / 1000;
        case 2:
            return pll_hz(1) / 1000;
        case 3:
            return kRingHz / 1000;
        case 5:
            return source_hz(kCrystal) / 1000;
        case 8:
            return reference_hz() / 1000;
        case 9:
            return system_hz() / 1000;
        default:
            return 0;
    }
}

std::uint32_t ClockTree::read_generator(std::uint32_t offset) const
{
    if (offset < clocks_.size() * 12) {
        const unsigned number = offset / 12;
        const Generator& clock = clocks_[number];
        const bool switches = number == kReference || number == kSystem;
        switch (offset % 12) {
            case 0:
                return clock.ctrl | (!switches && (clock.ctrl & kEnabled) != 0 ? 1U << 28U : 0U);
            case 4:
                return clock.div;
            default:
                return switches ? 1U << (clock.ctrl & (number == kSystem ? 1U : 3U)) : 1U;
        }
    }
    constexpr std::uint32_t kCounted = 1U << 4U;
    return offset == 0xA4 ? kCounted : offset == 0xA8 ? measured_khz() << 5U : 0U;
}

void ClockTree::write_generator(std::uint32_t offset, std::uint32_t value)
{
    if (offset < clocks_.size() * 12) {
        const unsigned number = offset / 12;
        Generator& clock = clocks_[number];
        const bool switches = number == kReference || number == kSystem;
        constexpr std::uint32_t kAux = 7U << 5U;
        if (offset % 12 == 0) {
            const bool in_use = switches ? (clock.ctrl & 3U) == 1 && (value & 3U) == 1
                                         : (clock.ctrl & kEnabled) != 0;
            if (((clock.ctrl ^ value) & kAux) != 0 && in_use) {
                circuit_.violate("CLOCKS: the auxiliary source of clock " + std::to_string(number) +
                                 " is changed in use");
            }
            clock.ctrl = value & ~(1U << 28U);
        } else if (offset % 12 == 4) {
            clock.div = value;
        }
    } else if (offset == 0xA0) {
        counter_source_ = value;
    } else if (offset < 0x8C || offset > 0xA0) {
        circuit_.violate("CLOCKS: a register is written that is not modelled, " +
                         hexadecimal(offset));
    }
    look();
}

void ClockTree::look()
{
    const std::array<std::uint32_t, 4> rates{reference_hz(), system_hz(), peripheral_hz(),
                                             usb_hz()};
    if (rates[1] == 0) {
        circuit_.violate("CLOCKS: the core's clock stands still");
    }
    if (rates[1] > kMostSystemHz) {
        circuit_.violate("CLOCKS: the core at " + std::to_string(rates[1]) + " Hz");
    }
    for (unsigned i = 0; i < plls_.size(); ++i) {
        if (pll_used(i) && circuit_.now < plls_[i].locked_at) {
            circuit_.violate("CLOCKS: a clock comes from a PLL that has not locked");
        }
    }
    if (std::exchange(rates_, rates) != rates) {
        changed_();
    }
}

}  // namespace cusp::cosim::rp2350
