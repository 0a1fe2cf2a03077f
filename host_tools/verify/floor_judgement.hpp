// The stock after cutting compared with the part: gouge, scallop, uncut floor.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/height_grid.hpp"
#include "host_tools/verify/machined_stock.hpp"
#include "host_tools/verify/part_heights.hpp"
#include "host_tools/verify/verify.hpp"
#include "host_tools/verify/wall_distance.hpp"

namespace cusp::verify {

struct FloorQuestion {
    const std::vector<nurbs::Surface>& surfaces;
    const std::vector<std::array<Vec3d, 3>>& mesh;
    const std::vector<toolpath::Tool>& tools;  // those that the program cuts with
    const std::vector<WallDistance>& walls;
    const HeightGrid& grid;
    const std::vector<double>& cut;  // heights of the stock after cutting
    double top;                      // of the uncut stock
    std::optional<double> scallop;
    double path_clearance;                   // mm: how far the path may have to stay off the floor
    const std::vector<ToolPositions>& runs;  // of all tools, those that only rough, too
    double most_left;                        // mm: thicknesses below it may be inexact
};

// Fills the figures of the floor. Returns what is left over what can be reached, per grid point:
// mm, NaN outside the floor, +infinity where nothing was cut.
std::vector<double> judge_floor(const FloorQuestion& question, VerifyFigures& figures);

}  // namespace cusp::verify
