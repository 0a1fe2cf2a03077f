// Faces of STEP and IGES models as trimmed NURBS surfaces, by Open CASCADE.
//
// Open CASCADE is loaded when the first such file is read: linking it would add 25 ms to the start
// of every command. The module that knows it, libcusp_cad.so, is built where it is installed.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// The unit is the file's own; the result is in mm. Analytic faces become rational B-splines,
// exactly; their edges' curves in (u, v) are Open CASCADE's. Faces of solids that look nowhere up
// are left out: no tool from above reaches them, and what covers them is in the model. Loose faces
// that close a volume count as a solid.
//
// Errors: InputError with the file and the reason: no such file, no STEP or IGES, no face that
// looks up, trims that contradict each other, no libcusp_cad.so.
std::vector<nurbs::Surface> read_cad_surfaces(const std::string& file);

}  // namespace cusp::import

// The door of libcusp_cad.so. Its other calls are answered by the program that loads it.
extern "C" void cusp_read_cad_surfaces(const std::string& file,
                                       std::vector<cusp::nurbs::Surface>& surfaces);
