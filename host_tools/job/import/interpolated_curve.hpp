// The cubic spline through given points.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

struct EndTangents {
    std::optional<Vec3d> first, last;  // directions, of any length but 0; none: free
};

// The cubic B-spline with continuous curvature that passes through the points, to rounding. Parameters
// are lengths of chords; a tangent has length 1; at a free end the curvature is 0.
//
// points  mm; repeated ones count once; two different ones at least
// closed  the last point is the first again, and the curve is smooth there
//
// Source: de Boor, A Practical Guide to Splines, chapter 4.
nurbs::Curve interpolated_curve(std::vector<Vec3d> points,
                                bool closed,
                                const EndTangents& tangents);

}  // namespace cusp::import
