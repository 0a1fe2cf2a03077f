// Segments between grid points, split until none crosses another: iterated snap rounding.
#pragma once

#include "host_tools/geometry/offset/grid_points.hpp"

namespace cusp::offset {

struct Segment {
    std::uint32_t from;    // vertices of a GridPoints
    std::uint32_t to;      // another one
    std::uint32_t source;  // of its caller's
};

// Replaces segments by chains over vertices until each two are equal, opposite, or have no point in
// common but their ends, and no other vertex lies within half a step of any. Each chain begins and
// ends where its segment did. Exact, so it cannot fail: every round adds a vertex to a chain, and
// chains, monotone in x and y, have no more vertices than their boxes have steps.
//
// Source: Hobby, "Practical segment intersection with finite precision output", 1999; repeated as in
// Halperin and Packer, "Iterated snap rounding", 2002.
void make_planar(std::vector<Segment>& segments, GridPoints& points);

}  // namespace cusp::offset
