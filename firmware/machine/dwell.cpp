// Ticks that count.
#include "firmware/machine/dwell.hpp"

#include "firmware/base/pulse_frame.hpp"

namespace cusp::machine {

void Dwell::begin(double seconds, std::uint32_t now) noexcept
{
    constexpr double kMostSeconds = 4e6;  // of a 32-bit tick counter
    const double limited = seconds < kMostSeconds ? seconds : kMostSeconds;
    left_ = static_cast<std::uint32_t>(limited * static_cast<double>(kServoTicksPerSecond) + 0.5);
    seen_ = now;
}

bool Dwell::over(std::uint32_t now) noexcept
{
    // A gap longer than a few ticks was a hold.
    constexpr std::uint32_t kLongestGap = 10;
    const std::uint32_t passed = now - seen_;
    seen_ = now;
    const std::uint32_t counted = passed > kLongestGap ? 1U : passed;
    left_ = counted < left_ ? left_ - counted : 0;
    return left_ == 0;
}

}  // namespace cusp::machine
