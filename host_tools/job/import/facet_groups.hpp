// Groups of a mesh's upward facets; each is smooth, and they meet at edges only.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/stl_facets.hpp"

namespace cusp::import {

struct FacetGroup {
    Facets facets;
    // The group's edge seen from above: outer loops counter-clockwise, holes clockwise.
    std::vector<std::vector<Vec3d>> loops;
};

// Downward facets and walls that are vertical within micrometres are in no group: from above only
// their upper edge is visible. Groups end at edges where the normal turns by more than 35 degrees,
// so that a smooth surface can follow each.
//
// No value where facets can't be grouped: inconsistent orientation, groups that overlap themselves
// in plan, more than 200 groups.
std::optional<std::vector<FacetGroup>> facet_groups(const Facets& facets);

}  // namespace cusp::import
