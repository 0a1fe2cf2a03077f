// A bumpy surface with a round hole above a lower plate: a cliff around the hole.
#pragma once

#include <cmath>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "tests/support/plates.hpp"

namespace cusp::test {

// On [0, 30] x [0, 30] mm, 2 to 7 mm high; the hole is at the centre.
//
//   radius  in (u, v): a fraction of the size
inline nurbs::Surface holed_sheet(double radius)
{
    nurbs::Surface s;
    s.degree_u = s.degree_v = 3;
    s.size_u = s.size_v = 6;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1.0 / 3, 2.0 / 3, 1, 1, 1, 1};
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            s.points.push_back({6.0 * i, 6.0 * j, 4.5 + 2.5 * std::sin(1.9 * i + 2.3 * j)});
            s.weights.push_back(1.0 + 0.2 * ((i + j) % 2));
        }
    }
    nurbs::Curve circle{2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {}, {}};
    constexpr double kWay[][2] = {{1, 0},  {1, -1}, {0, -1}, {-1, -1}, {-1, 0},
                                  {-1, 1}, {0, 1},  {1, 1},  {1, 0}};
    for (int k = 0; k < 9; ++k) {
        circle.points.push_back({0.5 + radius * kWay[k][0], 0.5 + radius * kWay[k][1], 0.0});
        circle.weights.push_back(k % 2 == 0 ? 1.0 : std::sqrt(0.5));
    }
    const auto side = [](Vec3d a, Vec3d b) {
        return nurbs::Curve{1, {0, 0, 1, 1}, {a, b}, {1, 1}};
    };
    s.trims = {{side({0, 0, 0}, {1, 0, 0}), side({1, 0, 0}, {1, 1, 0}), side({1, 1, 0}, {0, 1, 0}),
                side({0, 1, 0}, {0, 0, 0})},
               {circle}};
    return s;
}

// The sheet and the plate below it.
inline std::vector<nurbs::Surface> holed_floor(double radius)
{
    return {plate(-5, -5, 35, 35, 0), holed_sheet(radius)};
}

}  // namespace cusp::test
