// Levels, pockets, holes, inner corners and fillets of a part: what a machinist chooses tools by.
#pragma once

#include <array>
#include <vector>

#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::import {

// Levels and pockets of a mesh, as shadow.hpp finds them: of 1 mm^2 or more, at most kMostLevels levels.
job::PartFeatures features_of_mesh(const std::vector<std::array<Vec3d, 3>>& triangles);

// Those of a model, with its holes and corners as cad_holes.hpp finds them. A wider hole over a narrower one about the
// same axis is its counterbore; the level ground in holes is no pocket.
//
// model  read_whole_cad_model()
job::PartFeatures features_of_model(const CadModel& model);

}  // namespace cusp::import
