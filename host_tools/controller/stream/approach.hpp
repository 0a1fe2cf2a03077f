// Lines that restore the modal state of a resume point and move the tool there from above.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/controller/stream/resume_point.hpp"

namespace cusp::stream {

struct Approach {
    std::vector<std::string> lines;
    // In the program's coordinates, mm, and degrees of A.
    AxisVecd point;
    double safe_z{0};
    bool plunges{false};
    double plunge_feed{0};  // mm/min
};

// Raises the tool, moves over the point, A with it, starts spindle and coolant, descends at the plunge feed,
// and restores units, plane, distance, feed, path, tool length and G92. Precondition: the
// controller has been reset.
//
// point    where to resume
// before   offsets at the start of the program: changes by the program are restored, others stay as
//          the user may have set them
// now      the controller's present offsets
// machine  present machine position
// safe_z   height of travel, mm in the program's coordinates; none: the program's highest. Never
//          below the tool's present height
Approach make_approach(const ResumePoint& point,
                       const gcode::Parameters& before,
                       const gcode::Parameters& now,
                       Position machine,
                       std::optional<double> safe_z);

}  // namespace cusp::stream
