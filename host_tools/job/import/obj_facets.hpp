// Triangles from Wavefront OBJ files.
#pragma once

#include <string>

#include "host_tools/job/import/facets.hpp"

namespace cusp::import {

// All faces, of all objects and groups; a face with more than three corners is cut into triangles
// that do not leave it where it is plane. Lines, points, normals, materials are passed over.
//
// millimetres  of one unit of the file: OBJ does not name its unit
//
// Errors: InputError with file and line: a coordinate that is no number or beyond
// kLargestCoordinate, a face with fewer than three corners or with a vertex that is not there.
// `check_facets` is the caller's.
Facets read_obj(const std::string& file, double millimetres);

}  // namespace cusp::import
