// Repairs rounding and conversion errors in the trimming loops of CAD faces.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Points just outside the domain are moved into it, ends that nearly meet together.
void tidy(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

// Where a pole closes the loop, the edge there has no length, and its converted parameters are
// wrong: a line along the pole's side of the domain replaces it.
void bridge_poles(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

}  // namespace cusp::import
