// Trimming loops of a surface, in its parameters: chained, nested and oriented.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// curves  in order, as the file lists them; each closed alone or with those after it. Outer
//         loops run counter-clockwise, holes clockwise.
//
// Returns the loops, an outer one first; where the file gives holes only, the edge of the domain is
// the outer loop.
// Errors: an open loop, one that leaves the domain, loops that cross, loops whose directions
// contradict their nesting.
std::vector<std::vector<nurbs::Curve>> trim_loops(const std::vector<nurbs::Curve>& curves,
                                                  const nurbs::Surface& surface,
                                                  const std::string& place);

}  // namespace cusp::import
