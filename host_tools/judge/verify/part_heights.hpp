// The part in plan: the upper envelope of its surfaces on a grid.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

struct PartHeights {
    std::vector<double> z;                   // NaN where there is no surface
    std::vector<double> cosine;              // of the slope; 1 where it is horizontal
    std::vector<std::array<float, 2>> lean;  // x and y of the upward normal
};

// Heights are roots of the surfaces' equations (Newton's method), not interpolated; trims are
// honoured. Triangles are exact. Vertical surfaces and triangles have no height.
PartHeights part_heights(const std::vector<nurbs::Surface>& surfaces,
                         const std::vector<std::array<Vec3d, 3>>& triangles,
                         const HeightGrid& grid);

struct PartBox {
    double x_low, x_high, y_low, y_high, z_low, z_high;
};

// From samples of the surfaces, and all triangles.
PartBox part_box(const std::vector<nurbs::Surface>& surfaces,
                 const std::vector<std::array<Vec3d, 3>>& triangles = {});

}  // namespace cusp::verify
