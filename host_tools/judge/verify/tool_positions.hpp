// The positions of a tool: the places at which the stock is cut.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::verify {

// Positions of one tool's tip, in order; `rapid` says which are reached by rapid moves, `lines`
// by which line of the program.
struct ToolPositions {
    toolpath::Tool tool;
    std::vector<Vec3d> tips;
    std::vector<bool> rapid;
    std::vector<std::uint32_t> lines{};
};

}  // namespace cusp::verify
