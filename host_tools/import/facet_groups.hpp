// A mesh's facets that look up, in groups that are smooth and meet at edges only.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/import/stl_facets.hpp"
#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

struct FacetGroup {
    Facets facets;
    // Its edge seen from above, what belongs to it on the left: outer loops counter-clockwise.
    std::vector<std::vector<Vec3d>> loops;
};

// Facets that look down, and walls that stand upright to some micrometres, are in no group: from
// above nothing of them is seen but the edge over them. Groups end at edges where the slope jumps
// by more than 35 degrees, so that each can be followed by a smooth surface.
//
// None where that can't be told: facets whose sides run against each other, groups that lie over
// themselves, more than 200 groups.
std::optional<std::vector<FacetGroup>> facet_groups(const Facets& facets);

}  // namespace cusp::import
