// Rounding and conversion of CAD files put right in the trimming loops of their faces.
#pragma once

#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Points just outside the domain are moved into it, ends that nearly meet together.
void tidy(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

// Where a pole closes the loop the edge there has no length, and after the conversion no true
// parameters either: a line along the pole's side of the domain takes its place.
void bridge_poles(std::vector<nurbs::Curve>& loop, const nurbs::Surface& surface);

}  // namespace cusp::import
