// The medial axis of a region: the centres of the discs inside it that touch its contours twice.
//
//     for (const AxisBranch& branch : medial_axis(region)) {
//         branch.front().radius;  // mm: of the largest disc about branch.front().at
//     }
//
// It has a branch into every convex corner, and together its discs cover the region.
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::prismatic {

struct AxisPoint {
    Vec2d at;
    double radius;  // mm
};

// Points of one branch; a single one where the axis is a point, as in a circle. Between two points
// the axis is straight and the radius changes linearly.
using AxisBranch = std::vector<AxisPoint>;

// mm: no disc of a chord is smaller than the largest disc there by more than this, nor beyond the
// contours by more than 2e-5 mm. Branches into round bends and blunt corners are left out where the
// discs beside them leave no more than this of the region.
inline constexpr double kAxisTolerance = 1e-3;

// The branches in the order of the contours; each part once.
//
// region  contours with the region on their left, which cross neither themselves nor each other
//
// Accuracy: as kAxisTolerance says (tests/property/prismatic, against distances by brute force).
// Source: the shrinking ball of Ma, Bae, Choi: 3D medial axis point approximation using nearest
// neighbors and the normal field, The Visual Computer 28 (2012), on edges in place of points.
std::vector<AxisBranch> medial_axis(const offset::Region2d& region);

}  // namespace cusp::prismatic
