// Horizontal rectangles as surfaces.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::test {

// length is along the unit vector `along`, width across it, mm.
inline nurbs::Surface turned_plate(Vec2d centre, Vec2d along, double length, double width, double z)
{
    nurbs::Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    for (const double u : {-0.5, 0.5}) {
        for (const double v : {-0.5, 0.5}) {
            const Vec2d p =
                centre + along * (u * length) + offset::left_normal(along) * (v * width);
            s.points.push_back({p.x, p.y, z});
            s.weights.push_back(1);
        }
    }
    return s;
}

inline nurbs::Surface plate(double x0, double y0, double x1, double y1, double z)
{
    return turned_plate({0.5 * (x0 + x1), 0.5 * (y0 + y1)}, {1, 0}, x1 - x0, y1 - y0, z);
}

}  // namespace cusp::test
