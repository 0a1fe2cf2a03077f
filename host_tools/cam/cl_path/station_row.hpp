// Stations along a plan path, close enough that linear interpolation follows the floor.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/cl_path/tolerance_chain.hpp"

namespace cusp::cl_path {

struct StationSpacing {
    double along;           // mm: largest distance of stations
    double plan_tolerance;  // mm: chords of arcs are within an eighth of it
    double height;          // mm: chords of the floor are within a twentieth of it
    bool sparse;  // on smooth floors most stations are interpolated, within a tenth of `height`
    double lookup_spacing{};  // mm: up to this distance interpolation is accurate; 0: not known
};

struct StationRow {
    std::vector<Station> stations;     // heights: the lowest of the tip
    std::vector<std::size_t> corners;  // first and last included
    std::optional<Vec2d> missing;      // a place without floor: the stations are incomplete then
};

// Stations are denser where the floor's slope changes so much from one to the next that the chord
// between them would deviate from the floor. A valley tighter than the tool gets a station at its
// bottom.
//
// floor  null: a level floor at z = 0
StationRow stations_along(const std::vector<offset::Edge>& plan,
                          const PathFloor* floor,
                          const StationSpacing& spacing);

}  // namespace cusp::cl_path
