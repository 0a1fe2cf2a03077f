// Bounding boxes of parts; trimmed-off regions of surfaces are not counted.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/part_files.hpp"

namespace cusp::import {

struct PartExtent {
    Vec3d low;   // mm
    Vec3d high;  // mm

    Vec3d size() const { return high - low; }
};

// Precondition: at least one surface, all valid. Error: at most 1e-6 mm; at curved trims up to
// 1e-4 mm too large (`PartExtent` tests). Searches from 81 points of each candidate patch.
PartExtent extent_of_surfaces(const std::vector<nurbs::Surface>& surfaces);

// The upper side of that box, z in mm.
double highest_of_surfaces(const std::vector<nurbs::Surface>& surfaces);

// Precondition: at least one triangle.
PartExtent extent_of_triangles(const Triangles& triangles);

// In x and y; z is 0. Error: at most 1e-3 mm too small.
PartExtent extent_of_curves(const std::vector<nurbs::Curve>& chain);

// The bounding box of both.
PartExtent joined(const PartExtent& a, const PartExtent& b);

}  // namespace cusp::import
