// Triangles from STL files, binary and ASCII.
#pragma once

#include <string>

#include "host_tools/job/import/facets.hpp"

namespace cusp::import {

// millimetres  of one unit of the file: STL does not name its unit
//
// Errors: InputError with file, line (ASCII) or facet (binary), value and limit: a truncated file,
// a coordinate that is not finite or beyond kLargestCoordinate. `check_facets` is the caller's.
Facets read_stl(const std::string& file, double millimetres);

}  // namespace cusp::import
