// From the coordinates of an object to those of the drawing, and from there to the plane of x and y.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/similarity.hpp"

namespace cusp::import {

// Directions of the axes of an object with this direction of extrusion.
//
// normal  of any length; 0 counts as z
//
// Source: the arbitrary axis algorithm of the DXF reference.
Similarity object_axes(Vec3d normal);

// From where a drawing is looked at.
enum class DrawingSide {
    kAbove,  // x and y; what does not lie there is projected
    kFront,  // drawn in x and z: z is taken for y
    kSide,   // drawn in y and z: y is taken for x, z for y
};

struct DrawingBox {
    Vec3d low, high;
};

// Box of the control points, mm; without a path low is above high.
DrawingBox extent_of(const std::vector<DrawingPath>& paths);

// Front or side where all of it has one y or one x, to 1e-3 mm, and not one z.
DrawingSide view_of(const DrawingBox& extent);

Vec3d seen_from(DrawingSide view, Vec3d point);

// Moves the curves to the plane of x and y; curves seen edge on, as points, are left out.
void flatten(DrawingSide view, std::vector<DrawingPath>& paths);

// A sentence on a drawing that is not flat or does not lie in x and y; else "".
std::string view_note(const std::string& file, DrawingSide view, const DrawingBox& extent);

}  // namespace cusp::import
