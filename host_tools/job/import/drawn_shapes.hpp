// The curves that entities of a drawing stand for.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// The curves of one object of a drawing in order, each from the end of the one before.
struct DrawingPath {
    std::vector<nurbs::Curve> curves;
    bool closed{};  // a loop by itself: as drawn, or since its ends meet
};

// All curves, in order.
std::vector<nurbs::Curve> curves_of(const std::vector<DrawingPath>& paths);

nurbs::Curve line_curve(Vec2d a, Vec2d b);

// The arc about `centre` that starts at the angle `start`; a positive sweep is counter-clockwise.
// Angles in radians.
// Precondition: radius > 0, 0 < |sweep| <= 2 pi.
nurbs::Curve arc_curve(Vec2d centre, double radius, double start, double sweep);

// A line of a polyline, or its arc.
//
// bulge  tangent of a quarter of the sweep; positive: counter-clockwise
nurbs::Curve bulged_curve(Vec2d from, Vec2d to, double bulge);

// By its control points, first and last on the curve: a line of two, else of the degree of their number less one.
nurbs::Curve bezier_curve(const std::vector<Vec2d>& points);

// Splits the curve at inner knots of multiplicity degree + 1, with which some programs write chains
// of Bezier curves. Wrong counts of knots or weights are left to check_curve().
std::vector<nurbs::Curve> parts_of(const nurbs::Curve& curve);

}  // namespace cusp::import
