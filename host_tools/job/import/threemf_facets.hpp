// Triangles from 3MF files, by lib3mf.
#pragma once

#include <string>

#include "host_tools/job/import/facets.hpp"

namespace cusp::import {

// The build items of the file, each with its components, placed as the file places them, in the
// file's own unit. Objects that no item builds are left out.
//
// Errors: InputError with the file and the reason: no such file, no 3MF, no item, a coordinate
// beyond kLargestCoordinate, a build of cusp without lib3mf. `check_facets` is the caller's.
Facets read_threemf(const std::string& file);

}  // namespace cusp::import
