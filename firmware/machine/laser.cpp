// Power by speed, tick by tick.
#include "firmware/machine/laser.hpp"

#include <cmath>

namespace cusp::machine {

void Laser::configure(const Settings& settings) noexcept
{
    on_ = settings.on(Setting::kLaserMode);
    law_ = DutyLaw{settings};
    duty_ = law_.duty(0);
    powers_.fill({});
    speed_.store(0, std::memory_order_relaxed);
}

void Laser::tick(path::LaserPower power, bool stands, unsigned delay, Position moved) noexcept
{
    constexpr unsigned kPlaces = kLongestDelay + 1;
    latest_ = (latest_ + 1) % kPlaces;
    powers_[latest_] = power;
    if (stood_ && !stands) {
        powers_.fill(power);
    }
    stood_ = stands;
    const unsigned delayed = (latest_ + kPlaces - delay) % kPlaces;
    // nm a tick are um/s.
    constexpr float kMillimetresPerSecond = 1e-3F;
    const auto to_number = [](std::int64_t nm) {
        return static_cast<float>(static_cast<std::int32_t>(nm));
    };
    float travel = norm(mapped(xyz(moved), to_number));
    // As the feed: A counts where it moves alone.
    for (unsigned axis = kLinearAxes; axis < kAxisCount && travel == 0; ++axis) {
        travel = std::fabs(to_number(moved[axis]));
    }
    const float velocity = travel * kMillimetresPerSecond;
    const float speed = powers_[delayed].at(velocity) * override_.load(std::memory_order_relaxed);
    speed_.store(speed, std::memory_order_relaxed);
    duty_ = law_.duty(speed);
}

}  // namespace cusp::machine
