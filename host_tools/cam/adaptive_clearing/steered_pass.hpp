// A pass that keeps its engagement: at each step it turns towards the stock as far as the bound
// lets it.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

struct Pose {
    Vec2d at;
    Vec2d heading;  // unit vector; stock is on its right
};

struct SteeringSpace {
    SweptArea& swept;
    const offset::RegionOffset& walls;
    double wall_clearance;  // mm: least distance of the tool's centre from the walls
    double turn_radius;     // mm: the tightest turn away from stock
    double max_engagement;  // radians
    double tolerance;       // mm: of chords in place of arcs
};

struct SteeredPass {
    std::vector<offset::Edge> path;
    double engagement_bound{};  // radians, of all of the path
};

// The circle of the tightest turn to the left keeps the clearance: from every pose there is a way
// on that does not leave the space.
bool has_room_to_turn(const SteeringSpace& space, Pose pose);

// Tangent arcs from the pose to where the last stock was cut; swept afterwards. Empty where nothing
// is cut, or no way keeps the bound. Precondition: has_room_to_turn().
//
// Within 0.01 radii of what is swept stock does not count: such slivers do not hold a pass.
SteeredPass steered_pass(const SteeringSpace& space, Pose pose);

}  // namespace cusp::adaptive_clearing
