// Path data of SVG (the attribute `d`) as curves: lines, Bezier curves and elliptic arcs, all exactly.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

// In the coordinates of the text, one path for each subpath; pieces without length are left out.
//
// place  file and line, for messages
// Errors: InputError with the position in the text and what stands there.
// Source: SVG 1.1, sections 8.3 and F.6.
std::vector<DrawingPath> paths_of_data(std::string_view text, const std::string& place);

// The arc of an ellipse between two points. Radii that are too small grow until it reaches; without a radius it is a
// line. Precondition: the points differ.
//
// turn      of the ellipse's axis, degrees
// large     the way round of more than half
// positive  from x to y
nurbs::Curve elliptic_arc(
    Vec2d from, Vec2d to, Vec2d radii, double turn, bool large, bool positive);

}  // namespace cusp::import
