// The clocks: from the crystal, or from the chip's own oscillator where no crystal starts.
#pragma once

#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace cusp::hal::stm32f4 {

// The clock rates of a chip of the family. The crystal is divided to 1 MHz, multiplied and halved.
// USB has its 48 MHz from the same multiplier where twice core_hz is a multiple of it.
struct ClockPlan {
    std::uint32_t crystal_hz;        // a whole number of MHz
    std::uint32_t core_hz;           // a whole number of MHz, 50 to 216
    std::uint32_t wait_states;       // of the flash at this rate and 3.3 V
    std::uint32_t fast_bus_divisor;  // 1 or 2
    std::uint32_t slow_bus_divisor;  // 2 or 4
    std::uint32_t regulator_scale;  // VOS of PWR_CR that allows this rate: 1 (F405), 3 (F411, F446)
    bool external{false};           // a clock from outside drives OSC_IN instead of a crystal

    constexpr bool has_usb() const { return 2 * core_hz % kUsbHz == 0; }
    // PLLQ, the divisor of the multiplier's other output; without USB nothing uses it.
    constexpr std::uint32_t usb_divisor() const { return has_usb() ? 2 * core_hz / kUsbHz : 7; }
    constexpr std::uint32_t fast_bus_hz() const { return core_hz / fast_bus_divisor; }
    constexpr std::uint32_t slow_bus_hz() const { return core_hz / slow_bus_divisor; }
    // Timers count twice their bus's rate where that is divided.
    constexpr std::uint32_t fast_timer_hz() const
    {
        return fast_bus_divisor == 1 ? core_hz : 2 * fast_bus_hz();
    }
    constexpr std::uint32_t slow_timer_hz() const { return 2 * slow_bus_hz(); }

    static constexpr std::uint32_t kUsbHz = 48000000;
};

enum class ClockSource : std::uint8_t {
    kCrystal,    // 50 ppm or so: what the board is made for
    kNoCrystal,  // it did not start: the chip's oscillator; moves are right, times off by up to 4 %
    kOtherCrystal,  // it is not the one of the plan: likewise
    kNone,          // the multiplier did not lock: the chip runs at 16 MHz, no motion is possible
};

namespace detail {

// True if the running crystal is the planned one, within the accuracy of the chip's own oscillator.
// The core and timer 11 run from that oscillator, 16 MHz; timer 11 captures each eighth edge of
// the crystal divided by 31 (RTCPRE). RM0090 sections 7.2.10 and 19.5.11.
template <class Chip>
bool crystal_is(std::uint32_t hz) noexcept
{
    constexpr std::uint32_t kTimer11Clock = 1U << 18U;
    constexpr std::uint32_t kDivisor = 31;
    constexpr std::uint32_t kFromDividedCrystal = 2;
    constexpr std::uint32_t kEachEighthEdge = 1U | 3U << 2U;
    constexpr std::uint32_t kCaptured = 2;
    constexpr std::uint32_t kOscillatorHz = 16000000;
    auto& rcc = Chip::rcc();
    auto& timer = Chip::timer11();
    set_bits(rcc.apb2enr, kTimer11Clock);
    static_cast<void>(rcc.apb2enr.read());
    set_field(rcc.cfgr, 16, 5, kDivisor);
    timer.option.write(kFromDividedCrystal);
    timer.ccmr1.write(kEachEighthEdge);
    timer.ccer.write(1);
    timer.cr1.write(1);
    // The first capture begins the measurement.
    bool there = wait_for(timer.sr, kCaptured, kCaptured);
    const std::uint32_t begin = timer.ccr1.read();
    there = wait_for(timer.sr, kCaptured, kCaptured) && there;
    const std::uint32_t counts = (timer.ccr1.read() - begin) & 0xFFFFU;
    timer.cr1.write(0);
    clear_bits(rcc.apb2enr, kTimer11Clock);
    const std::uint32_t wanted = kOscillatorHz / 1000 * kDivisor * 8 / (hz / 1000);
    // The oscillator is off by 4 % at most; the nearest other crystals in use by 20.
    const std::uint32_t allowed = wanted / 10;
    return there && counts >= wanted - allowed && counts <= wanted + allowed;
}

// Back to the chip's own oscillator, the multiplier off: its settings can't be changed while it
// runs, as it does when a boot loader has started the firmware. RM0090 section 7.3.2.
template <class Chip>
bool stop_multiplier() noexcept
{
    constexpr std::uint32_t kOscillatorOn = 1U << 0U;
    constexpr std::uint32_t kOscillatorReady = 1U << 1U;
    constexpr std::uint32_t kMultiplierOn = 1U << 24U;
    constexpr std::uint32_t kMultiplierReady = 1U << 25U;
    auto& rcc = Chip::rcc();
    set_bits(rcc.cr, kOscillatorOn);
    bool done = wait_for(rcc.cr, kOscillatorReady, kOscillatorReady);
    clear_bits(rcc.cfgr, 3U);
    done = wait_for(rcc.cfgr, 3U << 2U, 0) && done;
    clear_bits(rcc.cr, kMultiplierOn);
    return wait_for(rcc.cr, kMultiplierReady, 0) && done;
}

// The core's voltage, which bounds its rate; takes effect when the multiplier starts. RM0090
// section 5.4.1, RM0383 section 5.4.1.
template <class Chip>
void set_regulator(std::uint32_t scale) noexcept
{
    constexpr std::uint32_t kPowerClock = 1U << 28U;
    set_bits(Chip::rcc().apb1enr, kPowerClock);
    static_cast<void>(Chip::rcc().apb1enr.read());
    set_bits(Chip::power().cr, scale << 14U);
}

inline constexpr std::uint32_t kCrystalOn = 1U << 16U;
inline constexpr std::uint32_t kCrystalReady = 1U << 17U;

// A clock from outside in place of a crystal, or not. It can be changed only while the oscillator is
// off, and a boot loader may have used it.
template <class Chip>
bool set_bypass(bool external) noexcept
{
    constexpr std::uint32_t kCrystalBypass = 1U << 18U;
    auto& rcc = Chip::rcc();
    clear_bits(rcc.cr, kCrystalOn);
    const bool off = wait_for(rcc.cr, kCrystalReady, 0);
    if (external) {
        set_bits(rcc.cr, kCrystalBypass);
    } else {
        clear_bits(rcc.cr, kCrystalBypass);
    }
    return off;
}

}  // namespace detail

// Sets the clocks up as planned, whatever they were. RM0090 section 7.3.
template <class Chip>
ClockSource start_clocks(const ClockPlan& plan) noexcept
{
    using detail::kCrystalOn;
    using detail::kCrystalReady;
    constexpr std::uint32_t kSecurityOn = 1U << 19U;
    constexpr std::uint32_t kMultiplierOn = 1U << 24U;
    constexpr std::uint32_t kMultiplierReady = 1U << 25U;
    constexpr std::uint32_t kFromCrystal = 1U << 22U;
    constexpr std::uint32_t kOscillatorHz = 16000000;
    constexpr std::uint32_t kInputHz = 1000000;
    // Used by nothing here: the F446's, reserved with this value elsewhere.
    constexpr std::uint32_t kUnusedDivisor = 2U << 28U;
    constexpr std::uint32_t kRegulatorReady = 1U << 14U;
    auto& rcc = Chip::rcc();
    if (!detail::stop_multiplier<Chip>()) {
        return ClockSource::kNone;
    }
    detail::set_regulator<Chip>(plan.regulator_scale);
    if (!detail::set_bypass<Chip>(plan.external)) {
        return ClockSource::kNone;
    }
    set_bits(rcc.cr, kCrystalOn);
    const bool starts = wait_for(rcc.cr, kCrystalReady, kCrystalReady);
    const bool crystal = starts && detail::crystal_is<Chip>(plan.crystal_hz);
    if (!crystal) {
        clear_bits(rcc.cr, kCrystalOn);
    }
    const std::uint32_t divisor = (crystal ? plan.crystal_hz : kOscillatorHz) / kInputHz;
    const std::uint32_t multiplier = 2 * plan.core_hz / kInputHz;
    rcc.pllcfgr.write(divisor | multiplier << 6U | (crystal ? kFromCrystal : 0U) |
                      plan.usb_divisor() << 24U | kUnusedDivisor);
    set_bits(rcc.cr, kMultiplierOn);
    if (!wait_for(rcc.cr, kMultiplierReady, kMultiplierReady) ||
        !wait_for(Chip::power().csr, kRegulatorReady, kRegulatorReady)) {
        return ClockSource::kNone;
    }
    // Prefetch, both caches, the wait states: before the clock rises.
    Chip::flash().acr.write(plan.wait_states | 1U << 8U | 1U << 9U | 1U << 10U);
    // The buses first, then the core's clock from the multiplier.
    const std::uint32_t slow = plan.slow_bus_divisor == 4 ? 5U : 4U;
    const std::uint32_t fast = plan.fast_bus_divisor == 2 ? 4U : 0U;
    rcc.cfgr.write(slow << 10U | fast << 13U);
    rcc.cfgr.write(slow << 10U | fast << 13U | 2U);
    if (!wait_for(rcc.cfgr, 3U << 2U, 2U << 2U)) {
        return ClockSource::kNone;
    }
    if (!crystal) {
        return starts ? ClockSource::kOtherCrystal : ClockSource::kNoCrystal;
    }
    // A crystal that stops from now on is an NMI, which is a fault like any other (RM0090 7.2.7).
    set_bits(rcc.cr, kSecurityOn);
    return ClockSource::kCrystal;
}

}  // namespace cusp::hal::stm32f4
