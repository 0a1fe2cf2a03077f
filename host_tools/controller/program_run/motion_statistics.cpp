// Differences of set points.
#include "host_tools/controller/program_run/motion_statistics.hpp"

#include <algorithm>
#include <cstdlib>

#include "firmware/base/pulse_frame.hpp"

namespace cusp::program_run {
namespace {

constexpr double kTicks = kServoTicksPerSecond;

void keep_greatest(Position& greatest, Position value)
{
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        greatest[axis] = std::max(greatest[axis], std::abs(value[axis]));
    }
}

}  // namespace

void MotionStatistics::add(Position set_point)
{
    ++ticks_;
    if (set_point != window_.latest()) {
        last_moving_ = ticks_;
        if (first_moving_ == 0) {
            first_moving_ = ticks_;
        }
    }
    take(set_point);
}

void MotionStatistics::finish()
{
    for (int tick = 0; tick < 3; ++tick) {
        take(window_.latest());
    }
}

void MotionStatistics::take(Position p)
{
    const auto [velocity, acceleration, jerk] = window_.take(p);
    if (velocity == Position{} && acceleration == Position{} && jerk == Position{}) {
        return;
    }
    keep_greatest(velocity_, velocity);
    keep_greatest(acceleration_, acceleration);
    keep_greatest(jerk_, jerk);
    length_ += norm(to_millimetres(velocity));
}

AxisVecd MotionStatistics::max_velocity() const { return to_millimetres(velocity_) * kTicks; }

AxisVecd MotionStatistics::max_acceleration() const
{
    return to_millimetres(acceleration_) * (kTicks * kTicks);
}

AxisVecd MotionStatistics::max_jerk() const
{
    return to_millimetres(jerk_) * (kTicks * kTicks * kTicks);
}

std::uint64_t MotionStatistics::moving_ticks() const
{
    return first_moving_ == 0 ? 0 : last_moving_ - first_moving_ + 1;
}

}  // namespace cusp::program_run
