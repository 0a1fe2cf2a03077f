// Polygons for tests.
#pragma once

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::test {

inline offset::Contour polygon(const std::vector<Vec2d>& points)
{
    offset::Contour contour;
    for (std::size_t i = 0; i < points.size(); ++i) {
        contour.push_back(offset::line_edge(points[i], points[(i + 1) % points.size()]));
    }
    return contour;
}

inline offset::Contour rectangle(double x0, double y0, double x1, double y1)
{
    return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

inline offset::Contour square(double x, double y, double half)
{
    return rectangle(x - half, y - half, x + half, y + half);
}

}  // namespace cusp::test
