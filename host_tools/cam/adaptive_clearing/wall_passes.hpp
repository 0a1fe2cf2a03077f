// Passes along a contour where stock is still beside it, with tangent leads.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

struct WallSpace {
    const SweptArea& swept;
    const offset::RegionOffset& walls;
    double wall_clearance;  // mm: of leads
    double sliver;          // mm: thinner stock does not count
    double max_engagement;  // radians
    double tolerance;       // mm: of chords in place of arcs
    offset::Box2d spot;     // stock is looked for with the tool's centre in it
};

struct WallPasses {
    std::vector<std::vector<offset::Edge>> paths;
    bool left{};  // stock that none takes: there the engagement would be over the limit
};

// The stretches of the contour that meet stock, each from swept ground to swept ground or to where
// the engagement would be over the limit; a whole turn where all of it meets stock. Leads are not
// measured. Precondition: the region lies to the left of the contour.
WallPasses uncut_stretches(const offset::Contour& contour, const WallSpace& space);

}  // namespace cusp::adaptive_clearing
