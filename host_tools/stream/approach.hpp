// Lines that rebuild the modal state of a resume point and bring the tool there from above.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/stream/resume_point.hpp"

namespace cusp::stream {

struct Approach {
    std::vector<std::string> lines;
    // In the program's coordinates, mm.
    Vec3d point;
    double safe_z{0};
    bool plunges{false};
    double plunge_feed{0};  // mm/min
};

// Raises the tool, moves over the point, starts spindle and coolant, goes down at the plunge feed,
// and leaves units, plane, distance, feed, path, tool length and G92 as they were. The controller
// has been reset before.
//
//   point    where to resume
//   before   offsets when the program began: what the program has changed since is set again, the
//            rest stays as a person may have set it
//   now      offsets that the controller has now
//   machine  where the tool is now
//   safe_z   height to travel at, mm in the program's coordinates; none: the highest that the
//            program was at. Never below where the tool is.
Approach make_approach(const ResumePoint& point,
                       const gcode::Parameters& before,
                       const gcode::Parameters& now,
                       Position machine,
                       std::optional<double> safe_z);

}  // namespace cusp::stream
