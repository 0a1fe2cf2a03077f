// Holes of a mesh that a tool from above would fall through, and the facets that close them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct MeshHole {
    Vec3d middle;  // of its box, mm
    Vec3d size;
    std::vector<std::array<Vec3d, 3>> cover;  // facets over its border
};

// Borders inside the silhouette from above, the largest first. Not the outer border of a sheet, nor a
// border at the lowest height of the mesh, as of a part without its underside, nor one under other facets.
// Over and under a rim of vertical walls the sense of their corners decides: the top is missing where they
// face away from it, the floor where they face it. Cracks that `kCrack` bridges are none.
std::vector<MeshHole> holes_from_above(const std::vector<std::array<Vec3d, 3>>& triangles);

inline constexpr double kCrack = 0.1;  // mm

// The covers of those holes; appends a sentence on them to the notes.
//
// files  names of the part, for the sentence
// what   of which the part consists: facets or faces
std::vector<std::array<Vec3d, 3>> covers_of_holes(
    const std::string& files,
    const char* what,
    const std::vector<std::array<Vec3d, 3>>& triangles,
    std::vector<std::string>& notes);

// Appends covers_of_holes() to a mesh.
void cover_holes(const std::string& files,
                 std::vector<std::array<Vec3d, 3>>& triangles,
                 std::vector<std::string>& notes);

}  // namespace cusp::import
