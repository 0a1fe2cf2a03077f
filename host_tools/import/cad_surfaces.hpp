// Faces of STEP and IGES models as trimmed NURBS surfaces, where Open CASCADE was built in.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::host {

// "" where STEP and IGES can be read, else what this build lacks.
std::string missing_for_cad_files();

// The unit is the file's own; the result is in mm. Analytic faces become rational B-splines,
// exactly; their edges' curves in (u, v) are Open CASCADE's. Faces of solids that look nowhere up
// are left out: no tool from above reaches them, and what covers them is in the model. Loose faces
// that close a volume count as a solid.
//
// Errors: InputError with the file and the reason: no such file, no STEP or IGES, no face that
// looks up, trims that contradict each other, a build without Open CASCADE.
std::vector<Surface> read_cad_surfaces(const std::string& file);

}  // namespace cusp::host
