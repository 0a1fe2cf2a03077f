// The water tap replica of Chuang & Pan's figure 20, from its formula
// (examples/parts/chuang-pan-tap.json).
#pragma once

#include <algorithm>
#include <array>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::test {

inline std::vector<double> clamped_uniform_knots(int points, int degree)
{
    std::vector<double> knots;
    for (int i = 0; i <= points + degree; ++i) {
        knots.push_back(std::clamp(static_cast<double>(i - degree) / (points - degree), 0.0, 1.0));
    }
    return knots;
}

// A bicubic surface on clamped uniform knots from its control net, v fastest.
inline nurbs::Surface bicubic(int size_u, int size_v, std::vector<Vec3d> net)
{
    nurbs::Surface surface;
    surface.degree_u = 3;
    surface.degree_v = 3;
    surface.size_u = size_u;
    surface.size_v = size_v;
    surface.knots_u = clamped_uniform_knots(size_u, 3);
    surface.knots_v = clamped_uniform_knots(size_v, 3);
    surface.weights.assign(net.size(), 1.0);
    surface.points = std::move(net);
    return surface;
}

inline nurbs::Surface tap()
{
    const std::array<double, 10> height{0, 3, 12, 23, 27, 26, 20, 13, 9, 6};
    const std::array<double, 10> width{16, 20, 24, 24, 22, 19, 16, 14, 12, 11};
    const std::array<double, 8> profile{0, .1, .55, 1, 1, .55, .1, 0};
    std::vector<Vec3d> net;
    for (std::size_t i = 0; i < 10; ++i) {
        for (std::size_t j = 0; j < 8; ++j) {
            net.push_back({13.0 * static_cast<double>(i),
                           width[i] * (-1 + 2.0 * static_cast<double>(j) / 7),
                           0.7 * height[i] * profile[j]});
        }
    }
    return bicubic(10, 8, std::move(net));
}

}  // namespace cusp::test
