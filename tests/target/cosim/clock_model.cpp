// The clock tree of RM0090 section 7.3 and RM0383 section 6.3, with its start-up times and bounds.
#include "tests/target/cosim/clock_model.hpp"

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kOscillatorHz = 16000000;
constexpr Picoseconds kCrystalStart = 2 * kMillisecond;
constexpr Picoseconds kMultiplierStart = 200 * kMicrosecond;
constexpr std::uint32_t kCrystalOn = 1U << 16U;
constexpr std::uint32_t kCrystalReady = 1U << 17U;
constexpr std::uint32_t kCrystalBypass = 1U << 18U;
constexpr std::uint32_t kSecurityOn = 1U << 19U;
constexpr std::uint32_t kMultiplierOn = 1U << 24U;
constexpr std::uint32_t kMultiplierReady = 1U << 25U;
constexpr std::uint32_t kFromCrystal = 1U << 22U;
constexpr std::uint32_t kPowerClock = 28;

}  // namespace

ClockModel::ClockModel(Circuit& circuit, const ClockFacts& facts)
    : Model{circuit}, facts_{facts}, crystal_alive_{facts.crystal_hz != 0}
{
    ClockModel::reset();
    note_reset(ResetCause::kPowerUp);
}

void ClockModel::reset()
{
    cr_ = 0x81;
    pllcfgr_ = 0x24003010;
    cfgr_ = 0;
    cir_ = 0;
    ahb1enr_ = 0x00100000;
    ahb2enr_ = 0;
    apb1enr_ = 0;
    apb2enr_ = 0;
    power_cr_ = facts_.full_scale << 14U;
    wait_states_ = 0;
    update();
}

void ClockModel::note_reset(ResetCause cause)
{
    constexpr std::uint32_t kPin = 1U << 26U;
    switch (cause) {
        case ResetCause::kPowerUp:
            csr_ = kPin | 1U << 27U | 1U << 25U;
            break;
        case ResetCause::kPin:
            csr_ |= kPin;
            break;
        case ResetCause::kSoftware:
            csr_ |= kPin | 1U << 28U;
            break;
        case ResetCause::kWatchdog:
            csr_ |= kPin | 1U << 29U;
            break;
    }
}

std::uint32_t ClockModel::control() const
{
    const bool crystal =
        (cr_ & kCrystalOn) != 0 && crystal_fits() && circuit_.now - crystal_since_ >= kCrystalStart;
    const bool multiplier =
        (cr_ & kMultiplierOn) != 0 && circuit_.now - multiplier_since_ >= kMultiplierStart;
    const bool oscillator = (cr_ & 1U) != 0;
    return cr_ | (oscillator ? 2U : 0U) | (crystal ? kCrystalReady : 0U) |
           (multiplier ? kMultiplierReady : 0U);
}

std::uint32_t ClockModel::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:
            return control();
        case 0x04:
            return pllcfgr_;
        case 0x08:
            return cfgr_ | (cfgr_ & 3U) << 2U;
        case 0x0C:
            return cir_;
        case 0x30:
            return ahb1enr_;
        case 0x34:
            return ahb2enr_;
        case 0x40:
            return apb1enr_;
        case 0x44:
            return apb2enr_;
        case 0x74:
            return csr_;
        default:
            circuit_.violate("RCC: read of a register that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void ClockModel::write_control(std::uint32_t value)
{
    const std::uint32_t risen = value & ~cr_;
    if (((value ^ cr_) & kCrystalBypass) != 0 && (cr_ & kCrystalOn) != 0) {
        circuit_.violate("RCC: the bypass is changed while the oscillator is on");
    }
    if ((risen & kCrystalOn) != 0) {
        crystal_since_ = circuit_.now;
    }
    if ((risen & kMultiplierOn) != 0) {
        multiplier_since_ = circuit_.now;
        if ((pllcfgr_ & kFromCrystal) != 0 && (control() & kCrystalReady) == 0) {
            circuit_.violate("RCC: the multiplier is started on a crystal that is not ready");
        }
    }
    if ((cfgr_ & 3U) == 2 && (value & kMultiplierOn) == 0) {
        circuit_.violate("RCC: the multiplier is stopped while the core runs from it");
    }
    cr_ = value & ~(2U | kCrystalReady | kMultiplierReady);
}

void ClockModel::write(std::uint32_t offset, std::uint32_t value)
{
    switch (offset) {
        case 0x00:
            write_control(value);
            break;
        case 0x04:
            if ((cr_ & kMultiplierOn) != 0) {
                circuit_.violate("RCC: the multiplier is set while it runs");
            }
            // Reserved with this value, or the F446's PLLR, for which 0 and 1 are wrong.
            if (value >> 28U != pllcfgr_ >> 28U) {
                circuit_.violate("RCC: bits 28 to 31 of PLLCFGR are changed");
            }
            pllcfgr_ = value;
            break;
        case 0x08:
            if ((value & 3U) == 2 && (control() & kMultiplierReady) == 0) {
                circuit_.violate("RCC: the core is switched to a multiplier that is not ready");
            }
            cfgr_ = value & ~(3U << 2U);
            break;
        case 0x0C:
            cir_ &= ~(value >> 16U & 0xFFU);
            break;
        case 0x30:
            ahb1enr_ = value;
            break;
        case 0x34:
            ahb2enr_ = value;
            break;
        case 0x40:
            apb1enr_ = value;
            break;
        case 0x44:
            apb2enr_ = value;
            break;
        case 0x74:
            if ((value >> 24U & 1U) != 0) {
                csr_ = 0;
            }
            break;
        default:
            circuit_.violate("RCC: write to a register that is not modelled, " +
                             hexadecimal(offset));
    }
    update();
}

std::uint32_t ClockModel::read_power(std::uint32_t offset) const
{
    if (!apb1_on(kPowerClock)) {
        circuit_.violate("PWR: read without its clock");
    }
    // VOSRDY: the regulator is ready once the multiplier runs.
    const bool ready = (control() & kMultiplierReady) != 0;
    return offset == 0 ? power_cr_ : offset == 4 ? (ready ? 1U << 14U : 0U) : 0U;
}

void ClockModel::write_power(std::uint32_t offset, std::uint32_t value)
{
    if (!apb1_on(kPowerClock)) {
        circuit_.violate("PWR: written without its clock");
        return;
    }
    if (offset == 0) {
        if (((power_cr_ ^ value) >> 14U & 3U) != 0 && (cr_ & kMultiplierOn) != 0) {
            circuit_.violate("PWR: VOS changed while the multiplier runs");
        }
        power_cr_ = value;
    }
}

void ClockModel::set_wait_states(std::uint32_t count)
{
    wait_states_ = count;
    check_rates();
}

std::uint64_t ClockModel::inside_hz() const
{
    const std::uint32_t m = pllcfgr_ & 63U;
    const std::uint32_t n = pllcfgr_ >> 6U & 511U;
    const std::uint32_t source =
        (pllcfgr_ & kFromCrystal) != 0 ? (crystal_alive_ ? facts_.crystal_hz : 0) : kOscillatorHz;
    return m < 2 ? 0 : std::uint64_t{source / m} * n;
}

std::uint32_t ClockModel::usb_hz() const
{
    const std::uint32_t q = pllcfgr_ >> 24U & 15U;
    const bool runs = (control() & kMultiplierReady) != 0;
    return runs && q >= 2 ? static_cast<std::uint32_t>(inside_hz() / q) : 0;
}

std::uint32_t ClockModel::multiplier_hz() const
{
    const std::uint32_t n = pllcfgr_ >> 6U & 511U;
    const std::uint32_t p = 2 * ((pllcfgr_ >> 16U & 3U) + 1);
    const std::uint64_t inside = inside_hz();
    if (inside == 0) {
        circuit_.violate("RCC: PLLM below 2, or no source");
        return kOscillatorHz;
    }
    const std::uint64_t input = inside / n;
    if (input < 950000 || input > 2100000) {
        circuit_.violate("RCC: the multiplier's input is " + std::to_string(input) + " Hz");
    }
    if (inside < 100000000 || inside > 432000000) {
        circuit_.violate("RCC: the multiplier would run at " + std::to_string(inside) + " Hz");
    }
    return static_cast<std::uint32_t>(inside / p);
}

void ClockModel::update()
{
    const std::uint32_t source = cfgr_ & 3U;
    const std::uint32_t hz = source == 2   ? multiplier_hz()
                             : source == 1 ? facts_.crystal_hz
                                           : kOscillatorHz;
    core_hz_ = hz != 0 ? hz : kOscillatorHz;
    ++changes_;
    circuit_.next_event = 0;
    check_rates();
}

void ClockModel::check_rates()
{
    if (core_hz_ > facts_.most_hz) {
        circuit_.violate("RCC: the core runs at " + std::to_string(core_hz_) + " Hz");
    }
    if (slow_bus_hz() > facts_.most_slow_hz || fast_bus_hz() > facts_.most_fast_hz) {
        circuit_.violate("RCC: a bus runs too fast");
    }
    if ((core_hz_ - 1) / facts_.hz_per_wait_state > wait_states_) {
        circuit_.violate("FLASH: too few wait states for " + std::to_string(core_hz_) + " Hz");
    }
    // A scale below the full one allows some 85 % of the rate: RM0090 table 15, RM0383 table 14.
    if (core_hz_ > facts_.most_hz / 100 * 85 && (power_cr_ >> 14U & 3U) != facts_.full_scale) {
        circuit_.violate("PWR: VOS does not allow " + std::to_string(core_hz_) + " Hz");
    }
}

std::uint32_t ClockModel::divided_crystal_hz() const
{
    const std::uint32_t by = cfgr_ >> 16U & 31U;
    return by >= 2 && (control() & kCrystalReady) != 0 ? facts_.crystal_hz / by : 0;
}

void ClockModel::kill_crystal()
{
    const bool used = (cfgr_ & 3U) == 2 && (pllcfgr_ & kFromCrystal) != 0;
    crystal_alive_ = false;
    if ((cr_ & kSecurityOn) == 0) {
        if (used) {
            circuit_.violate("the crystal stopped and no clock security watches it");
        }
        return;
    }
    // The clock security system: back to the own oscillator, and an NMI.
    cr_ &= ~(kCrystalOn | kSecurityOn | (used ? kMultiplierOn : 0U));
    cfgr_ &= ~3U;
    cir_ |= 1U << 7U;
    circuit_.nmi = true;
    update();
}

}  // namespace cusp::cosim
