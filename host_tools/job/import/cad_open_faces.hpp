// Triangles of a CAD model with open edges, for the search for holes.
#pragma once

#include <array>
#include <vector>

#include "host_tools/job/import/cad_face.hpp"

namespace cusp::import {

// All faces as triangles where some edge has a face on one side alone, in the faces' sense; empty where they
// close. They lie up to 0.05 mm beside curved faces, and meet at shared edges.
//
// Method: Open CASCADE's BRepMesh.
std::vector<std::array<Vec3d, 3>> triangles_of_open_faces(const std::vector<SolidFace>& faces);

}  // namespace cusp::import
