// Fillets of a CAD model: faces that are round across with one radius, between faces that they are tangent to.
#pragma once

#include <vector>

#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::import {

// Cylinders and tori of 5 to 175 degrees across, and other faces whose sections are arcs of one radius, to 0.001 of it.
// Holes, pins, balls and upright concave walls, the inner corners of cad_holes.hpp, are none. Lengths are those of the
// untrimmed faces.
//
// model  read_whole_cad_model()
std::vector<job::PartFillets> fillets_of(const CadModel& model);

}  // namespace cusp::import
