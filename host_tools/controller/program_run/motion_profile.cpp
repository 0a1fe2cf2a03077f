// Doubles the length of stretches whenever there are too many.
#include "host_tools/controller/program_run/motion_profile.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/axis.hpp"
#include "firmware/base/pulse_frame.hpp"

namespace cusp::program_run {
namespace {

constexpr double kTicksPerSecond = kServoTicksPerSecond;

void keep_greater(AxisVecd& greatest, AxisVecd value)
{
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        greatest[axis] = std::max(greatest[axis], std::abs(value[axis]));
    }
}

void join(ProfileStretch& stretch, const ProfileStretch& other)
{
    stretch.speed = std::max(stretch.speed, other.speed);
    keep_greater(stretch.velocity, other.velocity);
    keep_greater(stretch.acceleration, other.acceleration);
    keep_greater(stretch.jerk, other.jerk);
}

}  // namespace

void MotionProfile::add(Position set_point, std::uint32_t line)
{
    if (!window_) {
        window_.emplace(set_point);
        return;
    }
    if (ticks_ % ticks_each_ == 0) {
        if (stretches_.size() == kMostStretches) {
            halve();
        }
        stretches_.emplace_back();
        stretches_.back().first_line = line;
    }
    ++ticks_;
    const SetPointDifferences differences = window_->take(set_point);
    const AxisVecd velocity = to_millimetres(differences.velocity) * kTicksPerSecond;
    join(stretches_.back(),
         {norm(velocity), velocity,
          to_millimetres(differences.acceleration) * (kTicksPerSecond * kTicksPerSecond),
          to_millimetres(differences.jerk) * (kTicksPerSecond * kTicksPerSecond * kTicksPerSecond),
          0});
}

void MotionProfile::halve()
{
    for (std::size_t i = 0; i < kMostStretches / 2; ++i) {
        stretches_[i] = stretches_[2 * i];
        join(stretches_[i], stretches_[2 * i + 1]);
    }
    stretches_.resize(kMostStretches / 2);
    ticks_each_ *= 2;
}

double MotionProfile::seconds_each() const
{
    return static_cast<double>(ticks_each_) / kTicksPerSecond;
}

double MotionProfile::seconds() const { return static_cast<double>(ticks_) / kTicksPerSecond; }

}  // namespace cusp::program_run
