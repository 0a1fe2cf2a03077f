// Triangles of a CAD model; those of one with open edges are for the search for holes.
#pragma once

#include <array>
#include <vector>

#include "host_tools/job/import/cad_face.hpp"

namespace cusp::import {

// All faces as triangles in the faces' sense, which meet at shared edges.
//
// off  mm, > 0: how far they may lie beside curved faces
//
// Method: Open CASCADE's BRepMesh.
std::vector<std::array<Vec3d, 3>> triangles_of_faces(const std::vector<SolidFace>& faces,
                                                     double off);

// All faces as triangles where some edge has a face on one side alone, in the faces' sense; empty where they
// close. They lie up to 0.05 mm beside curved faces.
std::vector<std::array<Vec3d, 3>> triangles_of_open_faces(const std::vector<SolidFace>& faces);

}  // namespace cusp::import
