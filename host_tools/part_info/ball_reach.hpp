// The largest ball that reaches every place of a part from above.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/part_info/ground.hpp"
#include "host_tools/part_model/part_model.hpp"

namespace cusp::part_info {

struct BallReach {
    double leaves{};  // mm: what it may leave at a place, the tolerance asked for
    // mm; no value: every ball up to the radius asked for reaches everything.
    std::optional<double> radius;
    Vec3d at;              // where larger ones leave more
    bool corner{};         // sharp: half the ball leaves more than a quarter of the tolerance there
    std::size_t places{};  // looked at
};

// A ball end of radius R reaches a place where it can stand, free of the model, shank included, so
// that its lower side comes within the tolerance of the place, from the side that the normal points
// to. What it leaves there is the least over all of its positions, found by drops of the ball and a
// search in plan. In a hollow that is round with radius r
// to a depth h the result is r to r / (1 - tolerance / h); where only its bottom is so tight, more.
//
// places     none hidden from above; the likeliest to bound the ball first. All are looked at
//            unless the ball follows so many facets that it would take long; then 300 or more
// tolerance  mm > 0; for meshes at least what their facets are off the shape that is meant
// facets_off mm: how far facets may lie in front of the places, as on faces
// facets     of the model
// most       mm: radius of the largest ball asked for
//
// Accuracy (BallReach tests): 5 % of the radius at the places given, 0.5 % at those around the
// tightest. A tighter spot between places may be missed.
BallReach largest_ball(const part_model::PartModel& model,
                       const std::vector<GroundPlace>& places,
                       double tolerance,
                       double facets_off,
                       std::size_t facets,
                       double most);

}  // namespace cusp::part_info
