// The clocks: 150 MHz for the core and 48 MHz for USB, from the crystal of 12 MHz. Blocks out of reset.
#pragma once

#include <cstdint>

#include "hal/rp2350/chip_registers.hpp"
#include "hal/rp2350/rp2350.hpp"

namespace cusp::hal::rp2350 {

// A multiplier: crystal x `times` / (`first` x `second`); the product before the division is 750 to 1600 MHz.
struct MultiplierPlan {
    std::uint32_t times;
    std::uint32_t first;
    std::uint32_t second;
};
inline constexpr std::uint32_t kCrystalHz = 12000000;
inline constexpr MultiplierPlan kCorePlan{125, 5, 2};
inline constexpr MultiplierPlan kUsbPlan{100, 5, 5};
constexpr std::uint32_t rate(const MultiplierPlan& plan) noexcept
{
    return kCrystalHz / (plan.first * plan.second) * plan.times;
}
inline constexpr std::uint32_t kCoreHz = rate(kCorePlan);
static_assert(kCoreHz == 150000000 && rate(kUsbPlan) == 48000000);

namespace detail {

// 8.6.3: set up while it is in reset and off, then on, then divided.
template <class Word>
bool start_multiplier(Multiplier<Word>& multiplier, const MultiplierPlan& plan) noexcept
{
    constexpr std::uint32_t kLocked = 1U << 31U;
    constexpr std::uint32_t kOff = 1U << 0U;
    constexpr std::uint32_t kDividerOff = 1U << 3U;
    constexpr std::uint32_t kOscillatorOff = 1U << 5U;
    multiplier.cs.write(1);
    multiplier.fbdiv.write(plan.times);
    clear_bits(multiplier.pwr, kOff | kOscillatorOff);
    const bool locked = wait_for(multiplier.cs, kLocked, kLocked);
    multiplier.prim.write(plan.first << 16U | plan.second << 12U);
    clear_bits(multiplier.pwr, kDividerOff);
    return locked;
}

template <class Chip>
bool start_crystal() noexcept
{
    constexpr std::uint32_t kRange = 0xAA0;
    constexpr std::uint32_t kOn = 0xFABU << 12U;
    constexpr std::uint32_t kStable = 1U << 31U;
    constexpr std::uint32_t kStartup = kCrystalHz / 256 / 1000 + 1;  // 1 ms
    auto& crystal = Chip::crystal();
    crystal.startup.write(kStartup);
    crystal.ctrl.write(kRange | kOn);
    return wait_for(crystal.status, kStable, kStable);
}

}  // namespace detail

// Brings blocks out of reset; false where one stays there.
template <class Chip>
bool release_blocks(std::uint32_t blocks) noexcept
{
    clear_bits(Chip::resets().reset, blocks);
    return wait_for(Chip::resets().done, blocks, blocks);
}
// Into reset and out of it: as after a reset of the chip, whatever a boot loader has left.
template <class Chip>
bool restart_blocks(std::uint32_t blocks) noexcept
{
    set_bits(Chip::resets().reset, blocks);
    return release_blocks<Chip>(blocks);
}

// True where start_clocks() has succeeded.
template <class Chip>
bool clocks_run() noexcept
{
    constexpr std::uint32_t kLocked = 1U << 31U;
    auto& clocks = Chip::clocks();
    return (clocks.sys.selected.read() & 0xFU) == 1U << 1U &&
           (clocks.ref.selected.read() & 0xFU) == 1U << 2U &&
           (Chip::core_multiplier().cs.read() & Chip::usb_multiplier().cs.read() & kLocked) != 0;
}

// Sets the clocks up, whatever they were; false where the crystal or a multiplier does not start. The serial port
// counts the core's clock, the watchdog microseconds.
template <class Chip>
bool start_clocks() noexcept
{
    constexpr std::uint32_t kFromRing = 1U << 0U;  // bits of SELECTED
    constexpr std::uint32_t kFromCrystal = 1U << 2U;
    constexpr std::uint32_t kFromReference = 1U << 0U;
    constexpr std::uint32_t kFromMultiplier = 1U << 1U;
    constexpr std::uint32_t kAll = 0xF;
    constexpr std::uint32_t kEnabled = 1U << 11U;
    auto& clocks = Chip::clocks();
    // No clock but the core's runs while the rest is changed, and that from the chip's own ring oscillator.
    clocks.peri.ctrl.write(0);
    clocks.usb.ctrl.write(0);
    clear_bits(clocks.sys.ctrl, 1U);
    bool good = wait_for(clocks.sys.selected, kAll, kFromReference);
    clear_bits(clocks.ref.ctrl, 3U);
    good = wait_for(clocks.ref.selected, kAll, kFromRing) && good;
    good = detail::start_crystal<Chip>() && good;
    good = restart_blocks<Chip>(kCoreMultiplierBlock | kUsbMultiplierBlock) && good;
    good = good && detail::start_multiplier(Chip::core_multiplier(), kCorePlan) &&
           detail::start_multiplier(Chip::usb_multiplier(), kUsbPlan);
    if (!good) {
        return false;
    }
    clocks.ref.ctrl.write(2);
    good = wait_for(clocks.ref.selected, kAll, kFromCrystal);
    clocks.sys.ctrl.write(0);
    clocks.sys.ctrl.write(1);
    good = wait_for(clocks.sys.selected, kAll, kFromMultiplier) && good;
    clocks.peri.ctrl.write(kEnabled);
    clocks.usb.ctrl.write(kEnabled);
    auto& tick = Chip::ticks().watchdog;
    tick.cycles.write(kCrystalHz / 1000000);
    tick.ctrl.write(1);
    return good;
}

}  // namespace cusp::hal::rp2350
