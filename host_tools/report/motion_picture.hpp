// How fast and how hard a run moved, over time, as SVG.
#pragma once

#include <string>

#include "firmware/base/machine_limits.hpp"
#include "host_tools/program_run/motion_profile.hpp"

namespace cusp::report {

// Four panels, one over the other, over the same seconds: the speed along the path in mm/s, and for each axis its
// velocity, acceleration and jerk in per cent of their limits. What is drawn at a time is the greatest of that stretch.
std::string motion_picture(const program_run::MotionProfile& profile, const MachineLimits& limits);

}  // namespace cusp::report
