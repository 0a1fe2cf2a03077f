// Boxes as closed meshes, and their STL files.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"

#include "fmt/format.h"

namespace cusp::test {

using Triangles = std::vector<std::array<Vec3d, 3>>;

// Two triangles, oriented by the order of the corners.
inline void add_quad(Triangles& out, Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    out.push_back({a, b, c});
    out.push_back({a, c, d});
}

// Twelve facets that face outwards.
inline Triangles box_mesh(Vec3d low, Vec3d high)
{
    const auto at = [&](int x, int y, int z) {
        return Vec3d{x == 0 ? low.x : high.x, y == 0 ? low.y : high.y, z == 0 ? low.z : high.z};
    };
    Triangles out;
    add_quad(out, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
    add_quad(out, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
    add_quad(out, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
    add_quad(out, at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1));
    add_quad(out, at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1));
    add_quad(out, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
    return out;
}

inline std::string ascii_stl(const Triangles& triangles)
{
    std::string out = "solid part\n";
    for (const auto& t : triangles) {
        out += "facet normal 0 0 0\nouter loop\n";
        for (const Vec3d& p : t) {
            out += fmt::format("vertex {} {} {}\n", p.x, p.y, p.z);
        }
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid part\n";
}

}  // namespace cusp::test
