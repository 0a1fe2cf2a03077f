// Partial loops between two levels that lie too far apart for some of the floor between them.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/strip_ridge.hpp"

namespace cusp::host {

// Loops halfway between the levels over the stretches where too much stands, so again in both
// halves, until nowhere more stands than may (StripRidge::stretches()) or passes lie as near as
// they ever do (least_interval()). No value where too much stands beside a spur into a corner, or
// where the loops add more than `most` mm of path.
std::optional<std::vector<PartialLoop>> partial_levels(const LevelStrip& strip,
                                                       StripRidge& ridge,
                                                       double radius,
                                                       double most);

}  // namespace cusp::host
