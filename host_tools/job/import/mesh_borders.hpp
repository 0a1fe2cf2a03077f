// The open borders of a mesh: loops of edges with a facet on one side only.
#pragma once

#include <array>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct BorderEdge {
    Vec3d begin, end;  // as the loop runs
    Vec3d third;       // corner of the facet beside it
    Vec3d normal;      // of that facet, by the order of its corners; not of unit length
};
using BorderLoop = std::vector<BorderEdge>;

// Loops that pass no corner twice. Borders that lie on each other within kSewn, as where facets do not
// share corners or a corner lies on an edge of others, are sewn and not listed.
//
// Method: the edges with an odd number of facets form a cycle modulo 2, and so they do after corners are
// merged and edges are divided: every trail closes.
std::vector<BorderLoop> border_loops(const std::vector<std::array<Vec3d, 3>>& triangles);

inline constexpr double kSewn = 5e-3;  // mm

}  // namespace cusp::import
