// Places along a plan path where the floor is looked up, close enough that it hides nothing between
// them.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/contour_pocket/tolerance_chain.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

struct StationSpacing {
    double along;           // mm between stations at most
    double plan_tolerance;  // mm: chords of arcs keep within an eighth of it
    double height;          // mm: chords of the floor keep within a twentieth of it
    bool sparse;  // where the floor is smooth most stations are interpolated, to a tenth of it
    double lookup_spacing{};  // mm: between lookups no farther apart nothing hides; 0: not known
};

struct StationRow {
    std::vector<Station> stations;     // heights: the tip's lowest
    std::vector<std::size_t> corners;  // first and last included
    std::optional<Vec2d> missing;      // a place without floor; the stations are not complete then
};

// Where the floor's slope changes from one station to the next so much that the chord between them
// would lie off the floor, there are more of them: a valley that the tool can't round off is met at
// its bottom.
//
// floor  null: a level floor at z = 0
StationRow stations_along(const std::vector<offset::Edge>& plan,
                          const drop_cutter::DropCutter* floor,
                          const StationSpacing& spacing);

}  // namespace cusp::contour_pocket
