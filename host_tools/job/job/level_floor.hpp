// The height of an operation's floor, if it is level.
#pragma once

#include <optional>

#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// z of the floor; none where its heights differ by more than 1e-6 mm, or there are no surfaces.
std::optional<double> level_floor(const Operation& operation);

}  // namespace cusp::job
