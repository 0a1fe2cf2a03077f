// Holes of a CAD model: vertical cylinders with material around them, open above.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/import/similarity.hpp"
#include "host_tools/job/job/part_geometry.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::import {

struct CadHoles {
    // By diameter, then by place. Cylinders of one axis and diameter are one hole.
    std::vector<job::Hole> holes;
    // Of each hole the cone that widens its upper end; none: it begins square.
    std::vector<std::optional<job::HoleMouth>> cones;
    std::size_t closed_above{};  // others, that begin below
    std::vector<double>
        corners;  // mm: radii of upright concave walls that do not close, one for each axis
};

// Round to 1e-4 of the radius, or 0.001 mm; complete but for a fiftieth of their side. A hole is
// blind where a face of the solid closes its lower end: level, a cone or a ball; a narrower hole below
// it makes it blind too. Slots and rounded corners are none.
//
// model  with all of its faces (read_cad_model())
CadHoles holes_of(const CadModel& model);

// The holes, and over those that a cone widens one as wide as that, down to the cone's lower end.
std::vector<job::Hole> mouths_of(const CadHoles& holes);

// The holes of a file, placed; z is the tool's axis.
//
// Errors: as read_cad_model().
CadHoles read_cad_holes(const std::string& file, const Similarity& placed);

}  // namespace cusp::import
