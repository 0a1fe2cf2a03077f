// Stock that a program leaves beside the walls of a 2.5-D operation, cuts into them, and how far it leaves the curves
// that an operation follows, from its moves.
//
//     const WallFaults faults = faults_at_walls(region, {regions, cuts, stock, is_open, 0.02, 0.02, 0.02});
//     faults.stock->thickness;  // mm, square to the wall; faults.stock->at is the place, with the line
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/standing_stock.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/verify/wall_gouge.hpp"

namespace cusp::verify {

struct WallQuestion {
    const std::vector<CutRegion>& regions;  // of all operations
    const std::vector<EarlierCut>& cuts;    // of the whole program; of those before it with line 0
    const StandingStock& stock;             // before the program
    // True if stock remains on the floor near a place. Beside tabs walls are judged over these alone.
    std::function<bool(Vec2d centre, double radius)> is_open;
    double allowed;          // mm: stock that is no thicker is none
    double plan_tolerance;   // mm: cuts that go no farther are none
    double floor_tolerance;  // mm
};

struct WallFaults {
    std::optional<WallStock> stock;  // the thickest
    std::optional<WallGouge> gouge;  // the deepest
};

// Stock beside the walls of a pocket, a profile, a v_carve or a chamfer, and cuts into these walls; the greatest
// distance from its curves of the path of an engraving or of a profile on its loops.
//
// Stock: a place of a wall is judged where the operation's tool fits with 0.02 mm, or its tolerance, to spare: at
// the floor, of a round end where it has the full radius, of a cone at the top, of a chamfer at its upper edge.
// Cuts: how deep a place of the wall is within a moving tool, less how deep it is within the region of another
// operation, as high as it is a wall.
//
// Accuracy: 0.002 mm at places every 0.1 mm and at corners.
WallFaults faults_at_walls(const CutRegion& region, const WallQuestion& question);

}  // namespace cusp::verify
