// Repairs rounding and conversion errors in the trimming loops of CAD faces.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Moves points just outside the domain into it, and joins ends that nearly meet.
void tidy(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

// Where a pole closes the loop, the edge has no length and its converted parameters are wrong.
// Replaces it by a line along the pole's side of the domain.
void bridge_poles(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

}  // namespace cusp::import
