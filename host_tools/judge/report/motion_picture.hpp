// Speed of a run, and velocity, acceleration and jerk relative to their limits, over time, as SVG.
#pragma once

#include <string>

#include "firmware/base/machine_limits.hpp"
#include "host_tools/controller/program_run/motion_profile.hpp"

namespace cusp::report {

// Four panels above each other with a common time axis: the speed along the path in mm/s, and for
// each axis its velocity, acceleration and jerk in per cent of their limits. Each value is the
// largest of its stretch of time.
std::string motion_picture(const program_run::MotionProfile& profile, const MachineLimits& limits);

}  // namespace cusp::report
