// Trochoids open necks and slots: full turns of the tool about places along the middle, each so far
// ahead of the one before as the engagement allows.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/neck_ways.hpp"
#include "host_tools/cam/adaptive_clearing/swept_area.hpp"

namespace cusp::adaptive_clearing {

struct TrochoidSpace {
    SweptArea& swept;
    const offset::RegionOffset& walls;
    double wall_clearance;  // mm: least distance of the tool's centre from the walls
    double max_engagement;  // radians
    double tolerance;       // mm, most: of chords in place of arcs
};

struct TrochoidPass {
    std::vector<offset::Edge> path;
    double engagement_bound{};     // radians, of all of the path
    double tolerance{kUnbounded};  // mm: of chords in place of its arcs
};

// The stock that is left along a way.
struct NeckStock {
    std::size_t first;  // indices of its places
    std::size_t last;
};

// The first such at or after a place.
std::optional<NeckStock> stock_along(const NeckWay& way,
                                     std::size_t from,
                                     const TrochoidSpace& space);

// Turns from one place of the way to another, or to where no step keeps the engagement; swept
// afterwards. Empty where that is nowhere.
//
// most_room  mm: of the first turn
TrochoidPass trochoidal_pass(const NeckWay& way,
                             std::size_t from,
                             std::size_t to,
                             double most_room,
                             const TrochoidSpace& space);

// The place where such a pass starts.
Vec2d trochoid_start(Vec2d centre, double most_room, const TrochoidSpace& space);

}  // namespace cusp::adaptive_clearing
