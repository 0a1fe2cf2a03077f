// Triangles in space at random, for judges by dense samples.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::test {

// Each within some 4 mm of a place in a box of 20 x 20 x 6 mm.
inline std::vector<std::array<Vec3d, 3>> random_triangles(std::mt19937& random, int count)
{
    std::uniform_real_distribution<double> place{0, 20};
    std::uniform_real_distribution<double> aside{-4, 4};
    std::vector<std::array<Vec3d, 3>> out;
    for (int k = 0; k < count; ++k) {
        const Vec3d a{place(random), place(random), 0.3 * place(random)};
        const auto near = [&] {
            return a + Vec3d{aside(random), aside(random), 0.5 * aside(random)};
        };
        out.push_back({a, near(), near()});
    }
    return out;
}

}  // namespace cusp::test
