// Widens the hole at the foot of an entry by level turns of bounded engagement.
//
//     const EntrySpiral spiral = entry_spiral(swept, centre, 0.9, settings);   // mm
//     spiral.path;      // half turns, tangent to each other, from the centre outwards
//
// A helix leaves a floor that slopes by its pitch. A level turn over it would meet stock on half of
// the tool's circumference. The helix ends in its centre instead, in a hole of the tool's radius
// with a level floor; from there the distance to the centre grows by a factor a turn, as a straight
// cut's engagement would allow.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"

namespace cusp::adaptive_clearing {

struct EntrySpiralLimits {
    double max_engagement;  // radians
    double tolerance;       // mm: of chords in place of arcs
};

struct EntrySpiral {
    std::vector<offset::Edge> path;
    double radius{};            // mm: of the last turn
    double engagement_bound{};  // radians: after the first turn, which is part of the entry
};

// Half turns of the spiral that make its first turn: in a hole of the tool's own radius no way at the
// side is bounded.
constexpr std::size_t kFirstTurnEdges = 3;

// Sweeps the hole and the spiral.
//
// radius  mm, > 0: the last turn's; it is smaller if a turn cannot be widened within the limit. One
//         of hardly more than nothing is a first turn alone.
EntrySpiral entry_spiral(SweptArea& swept,
                         Vec2d centre,
                         double radius,
                         const EntrySpiralLimits& limits);

}  // namespace cusp::adaptive_clearing
