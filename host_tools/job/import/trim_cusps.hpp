// Cuts off the tips of cusps in trimming loops.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// If two edges of a blend meet almost along each other, rounding makes them cross near the vertex.
// Cuts both where they are 5e-5 of the domain apart after the last crossing, and joins them by a
// line.
//
// loop  each curve starts at the end of the one before it, the first one at the end of the last one
// gap   mm: how far apart they may be up to there
//
// Returns how far apart they are at most, mm; 0 where there is no such place.
double cut_cusps(std::vector<nurbs::Curve>& loop, double gap, const nurbs::Surface& surface);

}  // namespace cusp::import
