// The part seen from above: the upper envelope of its surfaces over a grid.
#pragma once

#include <array>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/verify/height_grid.hpp"

namespace cusp::verify {

struct PartHeights {
    std::vector<double> z;                   // NaN where no surface lies
    std::vector<double> cosine;              // of the slope there; 1 on flat ground
    std::vector<std::array<float, 2>> lean;  // x and y of the upward normal
};

// Heights are roots of the surfaces' equations (Newton), not interpolated. Upright
// surfaces have no height. Trims are honoured.
// Triangles count as they are; upright ones have no height.
PartHeights part_heights(const std::vector<nurbs::Surface>& surfaces,
                         const std::vector<std::array<Vec3d, 3>>& triangles,
                         const HeightGrid& grid);

struct PartBox {
    double x_low, x_high, y_low, y_high, z_low, z_high;
};

// Of the surfaces' points, sampled, and of the triangles.
PartBox part_box(const std::vector<nurbs::Surface>& surfaces,
                 const std::vector<std::array<Vec3d, 3>>& triangles = {});

}  // namespace cusp::verify
