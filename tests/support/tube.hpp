// A round tube as one closed surface.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::test {

// Around the x axis or, with `along_y`, the y axis, starting at 0. u runs along the axis, v once
// around it from the horizontal side.
//
// radius, length  mm
inline nurbs::Surface tube(double radius, double length, bool along_y)
{
    nurbs::Surface s;
    s.degree_u = 1;
    s.degree_v = 2;
    s.knots_u = {0, 0, 1, 1};
    s.knots_v = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    s.size_u = 2;
    s.size_v = 9;
    const std::vector<Vec2d> ring{{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                  {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (const double at : {0.0, length}) {
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const double level = radius * ring[k].x;
            const double z = radius * ring[k].y;
            s.points.push_back(along_y ? Vec3d{level, at, z} : Vec3d{at, level, z});
            s.weights.push_back(k % 2 == 0 ? 1 : std::sqrt(0.5));
        }
    }
    return s;
}

}  // namespace cusp::test
