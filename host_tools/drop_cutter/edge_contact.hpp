// A tool that rests on a straight edge, or passes a place on a straight way.
#pragma once

#include "host_tools/toolpath/tool.hpp"

namespace cusp::drop_cutter {

struct EdgeContact {
    double lift;   // mm; kNoContact where the tool does not reach the edge
    double forth;  // where on the edge it rests
};

inline constexpr double kNoContact = -1e300;

// How far a straight edge beside the tool's axis lifts its tip: the highest value of
// slope y - profile_height(sqrt(away^2 + y^2)) over y in [low, high].
EdgeContact drop_on_edge(
    const toolpath::Tool& tool, double slope, double away, double low, double high);

}  // namespace cusp::drop_cutter
