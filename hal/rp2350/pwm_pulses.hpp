// SpindlePulses: the spindle's pulses, made by a slice of the pulse width modulator, at any rate and duty cycle.
#pragma once

#include <cstdint>

#include "firmware/base/panel.hpp"
#include "hal/rp2350/gp_pins.hpp"

namespace cusp::hal::rp2350 {

// Each pin has one channel of one slice (9.4): two neighbours share a slice.
struct PulsePin {
    Pin pin;
};

// `Place` has kPulses, a PulsePin, and kPulseClockHz: what the slice counts.
template <class Chip, class Place>
class SpindlePulses {
public:
    // The pin goes to the slice; the pulses have the rate and duty that were set last.
    static void start() noexcept
    {
        slice().csr.write(settings() | kEnable);
        set_pin_function<Chip>(kPin, PinFunction::kPwm, kPadOutput);
    }

    // hz >= 1; the slowest is 9 Hz.
    static void set_rate(std::uint32_t hz) noexcept
    {
        constexpr std::uint32_t kMostCounts = 65535;  // so that a duty of all of them fits
        constexpr std::uint32_t kMostScale = 255;
        if (hz == hz_) {
            return;
        }
        hz_ = hz;
        const std::uint32_t counts = Place::kPulseClockHz / hz;
        const std::uint32_t wanted = (counts + kMostCounts - 1) / kMostCounts;
        const std::uint32_t scale = wanted < kMostScale ? wanted : kMostScale;
        const std::uint32_t period = counts / scale;
        period_ = period < kMostCounts ? period : kMostCounts;
        slice().div.write(scale << 4U);
        slice().top.write(period_ - 1);
    }

    // From the next pulse on, with the polarity at once. duty: 0 to kFullDuty; what is not 0 gives pulses.
    // Context: any; bounded time.
    static void set_duty(std::uint16_t duty, bool inverted) noexcept
    {
        inverted_ = inverted;
        slice().csr.write(settings() | (slice().csr.read() & kEnable));
        set_duty(duty);
    }
    static void set_duty(std::uint16_t duty) noexcept
    {
        const auto counts =
            static_cast<std::uint32_t>((std::uint64_t{duty} * period_ + kFullDuty - 1) / kFullDuty);
        slice().cc.write(counts << (kSecond ? 16U : 0U));
    }

private:
    static constexpr Pin kPin = Place::kPulses.pin;
    static constexpr unsigned kSlice = kPin.number / 2 % 8;
    static constexpr bool kSecond = kPin.number % 2 != 0;
    static constexpr std::uint32_t kEnable = 1U << 0U;

    static auto& slice() noexcept { return Chip::pwm().slice[kSlice]; }
    static std::uint32_t settings() noexcept { return inverted_ ? 1U << (kSecond ? 3U : 2U) : 0U; }

    static inline std::uint32_t hz_{0};
    static inline std::uint32_t period_{1};  // counts
    static inline bool inverted_{false};
};

}  // namespace cusp::hal::rp2350
