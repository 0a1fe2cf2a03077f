// How far the moves of a program cut beyond the walls of 2.5-D operations, from their positions.
//
//     const WallGouge gouge = deepest_wall_gouge(regions, runs, {stock, top, 0.02, 0.02});
//     gouge.depth;  // mm, square to the wall; gouge.at is the place, with the line
#pragma once

#include <vector>

#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/standing_stock.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::verify {

// How far a cut breaks a bound, mm: one of the two, the greater.
struct Cuts {
    double gouge{};  // below a floor
    double wall{};   // beyond a wall
};

// The least of what a cut to z at a point breaks, over all regions. Near a wall that is cut too deep the greater of the
// two distances counts, not the whole depth.
//
// regions  what each has at the point
// top      z: of the stock before the cut
Cuts cuts_at(const std::vector<RegionAt>& regions, double z, double top);

struct WallGouge {
    double depth{};  // mm; 0: none over the tolerance
    FaultPlace at{};
};

struct WallLimits {
    const StandingStock& stock;  // before the program
    double top;                  // z: of the stock
    double plan_tolerance;       // mm: cuts that go no farther are none
    double floor_tolerance;      // mm
};

// A position whose end fits into one region is right; where the nearest region's tool follows curves, its distance from
// them counts. The edge of each other position is looked at all round, at several heights where it is not a flat end's:
// each place of it has to lie in some region.
//
// Accuracy: 0.002 mm at a position; positions lie within 0.1 mm.
WallGouge deepest_wall_gouge(const std::vector<CutRegion>& regions,
                             const std::vector<ToolPositions>& runs,
                             const WallLimits& limits);

}  // namespace cusp::verify
