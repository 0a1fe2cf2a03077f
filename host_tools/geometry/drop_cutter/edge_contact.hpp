// Contact of a tool with a straight edge.
#pragma once

#include <optional>

#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::drop_cutter {

// A straight edge as seen from the tool's axis: z = slope * y at the distance `away` from the
// axis in plan, for y in [low, high] along it. All in mm but the slope.
struct EdgeBeside {
    double slope;
    double away;
    double low;
    double high;
};

struct EdgeContact {
    double lift;   // mm: z of the tip
    double along;  // y of the contact
};

// The tip dropped on the edge: the maximum of slope y - profile_height(sqrt(away^2 + y^2)) over y.
// None where the tool does not reach the edge.
std::optional<EdgeContact> drop_on_edge(const toolpath::Tool& tool, const EdgeBeside& edge);

}  // namespace cusp::drop_cutter
