// Regions laid over each other: what they have in common, and what one leaves of the other.
//
//     const auto stays = without(stock, pocket);    // the walls
//     const auto cut = common(pocket, stock);
//
// The result is none where the contours cannot be joined: where two of them run along each other,
// or cross at so flat an angle that the place of the crossing is not known to 1e-6 mm.
#pragma once

#include <optional>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

// The points of both regions.
std::optional<Region2d> common(const Region2d& a, const Region2d& b);

// The points of either region.
std::optional<Region2d> united(const Region2d& a, const Region2d& b);

// The points of `a` that are not in `b`.
std::optional<Region2d> without(const Region2d& a, const Region2d& b);

}  // namespace cusp::offset
