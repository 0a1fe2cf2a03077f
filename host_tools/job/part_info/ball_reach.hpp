// The largest ball end that reaches every point of a part from above.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/part_info/ground.hpp"

namespace cusp::part_info {

struct BallReach {
    double leaves{};  // mm: the given tolerance, which bounds the material left at a point
    // mm; no value: every ball up to the given radius reaches everything.
    std::optional<double> radius;
    Vec3d at;              // where larger balls leave more
    bool corner{};         // sharp: half the ball leaves more than a quarter of the tolerance there
    std::size_t places{};  // number of points examined
};

// A ball end of radius R reaches a point if some position without a gouge, shank included, brings
// its lower side within the tolerance of the point, from the side of the normal. The material left
// is the minimum over all positions, found by the drop cutter and a search in plan. In a concave
// fillet of radius r and depth h the result is between r and r / (1 - tolerance / h); it is larger
// where only the bottom is so tight.
//
// places      none hidden from above; those likely to bound the ball first. All are examined,
//             unless the ball touches so many facets that this takes long; then 300 or more
// tolerance   mm > 0; for meshes at least the deviation of the facets from the intended shape
// facets_off  mm: greatest distance of facets in front of the points, as on faces
// facets      number of facets of the model
// max_radius  mm: of the largest ball to try
//
// Accuracy (BallReach tests): 5 % of the radius at the given points, 0.5 % at those around the
// tightest. A tighter spot between points may be missed.
BallReach largest_ball(const part_model::PartModel& model,
                       const std::vector<GroundPlace>& places,
                       double tolerance,
                       double facets_off,
                       std::size_t facets,
                       double max_radius);

}  // namespace cusp::part_info
