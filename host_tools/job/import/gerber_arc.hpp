// Arcs as Gerber and Excellon files give them: by their ends and a centre.
#pragma once

#include <optional>

#include "host_tools/job/import/gerber_shapes.hpp"

namespace cusp::import {

// mm
struct GerberArc {
    Vec2d from;
    Vec2d to;
    Vec2d centre;  // from its start
    bool counter_clockwise{};
};

// The arc about the nearest centre that is as far from both ends; a whole turn where they are one.
CircularWay way_of(const GerberArc& arc);

// Signs of the centre are not given: of the four that one whose arc is at most a quarter of a turn, and whose ends are
// most nearly as far from it. Nothing where the ends are one, or no arc is so short.
std::optional<CircularWay> quarter_way(const GerberArc& arc);

}  // namespace cusp::import
