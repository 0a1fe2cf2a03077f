// Passes along a contour where stock is still beside it, with tangent leads.
#pragma once

#include <vector>

#include "host_tools/adaptive_clearing/swept_area.hpp"
#include "host_tools/offset/offset.hpp"

namespace cusp::adaptive_clearing {

struct WallSpace {
    const SweptArea& swept;
    const offset::RegionOffset& walls;
    double wall_clearance;  // mm: of leads
    double sliver;          // mm: thinner stock does not count
};

// The stretches of the contour that meet stock, each from swept ground to swept ground; a whole turn
// where all of it does. Precondition: the region lies to the left of the contour.
std::vector<std::vector<offset::Edge>> uncut_stretches(const offset::Contour& contour,
                                                       const WallSpace& space);

}  // namespace cusp::adaptive_clearing
