// Trimming loops of a surface, in (u, v): chained, nested and oriented.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// curves  in the order of the file; each is closed by itself or together with those after it. Outer
//         loops run counter-clockwise, holes clockwise.
//
// Returns the loops, an outer one first. If there are only holes, the boundary of the domain is
// added as the outer loop. Errors: an open loop, one that leaves the domain, loops that cross,
// loops whose directions contradict their nesting.
std::vector<std::vector<nurbs::Curve>> trim_loops(const std::vector<nurbs::Curve>& curves,
                                                  const nurbs::Surface& surface,
                                                  const std::string& place);

}  // namespace cusp::import
