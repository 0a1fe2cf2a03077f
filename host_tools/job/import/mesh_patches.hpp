// Covers a mesh from above with trimmed surfaces that are never below it and preserve its walls.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/stl_facets.hpp"

namespace cusp::import {

struct MeshPatches {
    std::vector<nurbs::Surface> surfaces;
    double cell{};         // mm between knots of the coarsest curved surface; 0: all are plane
    double lift{};         // mm: bound of what was added along the normal
    double loose_share{};  // fraction of curved cells raised by more than the tolerance
    double overhang_area{};
};

// One surface for each of facet_groups(): a plane exactly, anything else as height_patch(), both
// trimmed along the group's edge, to 1e-5 mm. Vertical walls have no surface: their upper edge
// keeps the tool clear, since its shank is a cylinder.
//
// tolerance  mm, > 0: largest height of the surfaces above the mesh where it is smooth
//
// No value where facet_groups() has none; height_field() takes any mesh.
std::optional<MeshPatches> mesh_patches(const Facets& facets, double tolerance);

}  // namespace cusp::import
