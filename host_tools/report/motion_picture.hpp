// Speed of a run and its shares of the limits over time, as SVG.
#pragma once

#include <string>

#include "firmware/base/machine_limits.hpp"
#include "host_tools/program_run/motion_profile.hpp"

namespace cusp::report {

// Four panels, one above the other, with one time axis: the speed along the path in mm/s, and for
// each axis its velocity, acceleration and jerk in per cent of their limits. The value drawn at a
// time is the largest of that stretch.
std::string motion_picture(const program_run::MotionProfile& profile, const MachineLimits& limits);

}  // namespace cusp::report
