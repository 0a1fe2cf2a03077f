// Covers a mesh, seen from above, with trimmed surfaces that never lie below it and keep its walls.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/import/stl_facets.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

struct MeshPatches {
    std::vector<nurbs::Surface> surfaces;
    double cell{};         // mm between knots of the coarsest curved one; 0: all are plane
    double lift{};         // mm: bound of what was added along the normal
    double loose_share{};  // of the cells of curved ones, where that is more than the tolerance
    double overhang_area{};
};

// One surface for each of facet_groups(): a plane exactly, anything else as height_patch(), both
// trimmed along the group's edge, to 1e-5 mm. Upright walls have no surface: the edge over them
// keeps the tool off, since its shank is straight.
//
// tolerance  mm, > 0: how far surfaces may lie over the mesh where it is smooth
//
// No value where facet_groups() has none; height_field() takes any mesh.
std::optional<MeshPatches> mesh_patches(const Facets& facets, double tolerance);

}  // namespace cusp::import
