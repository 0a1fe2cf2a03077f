// Random bodies that Open CASCADE sweeps, turns, lofts or stretches, for random_part.
#pragma once

#include "tests/generators/draw.hpp"

#include "opencascade/TopoDS_Shape.hxx"
#include "opencascade/gp_Dir.hxx"

namespace cusp::test {

// Vertical in one of three cases.
gp_Dir random_axis(Draw& draw);

// Extruded splines and ellipses, polygons, balls, rings, cones and cylinders turned by part of a turn, pipes,
// free forms and lofts; within some 60 x 40 x 25 mm. May throw Standard_Failure, or make no valid shape.
TopoDS_Shape swept_body(Draw& draw);

// Mirrored, or stretched along the axes, or neither.
TopoDS_Shape stretched(Draw& draw, const TopoDS_Shape& shape);

}  // namespace cusp::test
