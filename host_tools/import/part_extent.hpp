// How far a part reaches along x, y and z; what trims cut off not counted.
#pragma once

#include <vector>

#include "host_tools/import/part_files.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

struct PartExtent {
    Vec3d low;   // mm
    Vec3d high;  // mm

    Vec3d size() const { return high - low; }
};

// Of valid surfaces, one at least. Accuracy: 1e-6 mm, beside curved trims 1e-4 mm too far
// (`PartExtent` tests). A search from 81 places of each patch that may reach farthest.
PartExtent extent_of_surfaces(const std::vector<nurbs::Surface>& surfaces);

// The upper side of that box alone, z in mm.
double highest_of_surfaces(const std::vector<nurbs::Surface>& surfaces);

// Of the corners of triangles, one at least.
PartExtent extent_of_triangles(const Triangles& triangles);

// The box round both.
PartExtent joined(const PartExtent& a, const PartExtent& b);

}  // namespace cusp::import
