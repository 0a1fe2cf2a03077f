// A path of the tool in plan, laid on the floor: a chain of tip points whose straight moves stay
// within the tolerances and above the floor.
#pragma once

#include <vector>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

struct FloorPathSettings {
    double aside{};    // mm: how far a move may lie beside the plan path, either way
    double above{};    // mm: width of the band above the floor that moves stay in
    bool lift{true};   // false: points on the floor, moves within `above` on either side of it
    double spacing{};  // mm between the floor heights looked at
};

struct FloorPath {
    std::vector<Vec3d> points;
    double least_gap{};  // mm: lower bound of the gap between floor and tool, over all moves; may
                         // be < 0
    bool over_floor{true};
    Vec2d missing;  // a place without floor, where not over_floor
};

// Coordinates are multiples of this, mm: what is certified is what is written.
constexpr double kWrittenStep = 1e-4;

FloorPath lay_on_floor(const std::vector<Edge>& plan,
                       const TipFloor& floor,
                       const FloorPathSettings& settings);

}  // namespace cusp::host
