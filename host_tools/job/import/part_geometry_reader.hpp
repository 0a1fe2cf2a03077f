// Reads a part file of any format for a description of it: everything that it holds, what a tool
// from above can't reach included.
#pragma once

#include <string>

#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::import {

// name         a file; of a drawing "#layer" may follow
// millimetres  of one unit of files that name none: 1 or 25.4
//
// Errors: InputError with file, place and reason: missing, empty or broken files, an unknown
// ending, a layer that the drawing does not have.
job::PartGeometry read_part_geometry(const std::string& name, double millimetres);

}  // namespace cusp::import
