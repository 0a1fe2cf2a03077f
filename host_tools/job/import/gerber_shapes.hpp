// Shapes that apertures of Gerber files draw, as regions of lines and arcs.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/svg_transform.hpp"

namespace cusp::import {

// An arc or a whole circle about its centre.
struct CircularWay {
    Vec2d centre;
    double radius{};  // mm
    double start{};   // radians
    double sweep{};   // radians, positive counter-clockwise, at most a turn
};

// All contours run counter-clockwise, but for holes; winding numbers are 0 or 1.

offset::Contour circle_contour(Vec2d centre, double radius);

// Of three points or more, in either direction.
offset::Contour polygon_contour(std::vector<Vec2d> points);

offset::Contour rectangle_contour(Vec2d centre, double width, double height);

// A rectangle whose shorter sides are half circles.
offset::Contour obround_contour(Vec2d centre, double width, double height);

// A circle's way along a line.
offset::Contour capsule_contour(Vec2d from, Vec2d to, double radius);

// A convex polygon's way along a line.
offset::Contour swept_contour(const std::vector<Vec2d>& polygon, Vec2d from, Vec2d to);

// A circle's way along an arc; by chords within 2e-4 mm where its radius reaches the centre.
offset::Region2d thick_arc(const CircularWay& way, double radius);

// The edges of an arc, each at most a quarter of a turn.
std::vector<offset::Edge> arc_edges(const CircularWay& way);

// Precondition: the map keeps angles.
offset::Region2d mapped(const PlaneMap& map, const offset::Region2d& region);

}  // namespace cusp::import
