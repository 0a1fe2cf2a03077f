// The moves of a pecking drill at its place.
#pragma once

#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::toolpath {

// Heights of a hole, z.
struct HoleHeights {
    double above;  // rapid moves end here
    double top;    // pecks count from here
    double bottom;
};

// Down to the bottom in pecks, mm each, from where the tool is, over the hole; between two of them up and down again
// by rapid moves. The last one ends at the bottom.
void write_pecks(const HoleHeights& hole, double peck, ToolpathWriter& writer);

}  // namespace cusp::toolpath
