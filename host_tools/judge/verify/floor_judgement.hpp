// The stock after cutting compared with the part: gouge, scallop, uncut floor.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/owed_ground.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/pocket_boundaries.hpp"
#include "host_tools/judge/verify/standing_stock.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

struct FloorQuestion {
    const std::vector<nurbs::Surface>& surfaces;
    const std::vector<std::array<Vec3d, 3>>& mesh;
    const std::vector<toolpath::Tool>& tools;  // those that the program uses
    const PocketBoundaries& walls;
    const HeightGrid& grid;
    const std::vector<double>& cut;  // heights of the stock after cutting; NaN: no stock to judge
    double top;                      // of the uncut stock
    const StandingStock& stock;      // before the program
    const OwedGround& owed;
    std::optional<double> scallop;
    double path_clearance;  // mm: largest distance that the path may keep from the floor
    const std::vector<ToolPositions>& runs;  // of all tools, roughing tools included
    double most_left;                        // mm: thicknesses below it may be inexact
};

// Per grid point.
struct FloorMaps {
    // mm above the reachable height; NaN outside the floor, +infinity where nothing was cut.
    std::vector<double> left;
    // mm that the program cut below the part inside the walls; 0 where none is.
    std::vector<double> gouge;
    // z of the part; NaN where it has none. Beyond walls the stock's top.
    std::vector<double> part;
};

// Fills the figures of the floor.
FloorMaps judge_floor(const FloorQuestion& question, VerifyFigures& figures);

}  // namespace cusp::verify
