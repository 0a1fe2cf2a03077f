// Partial loops between two levels that lie too far apart for some of the floor between them.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/loop_scallop.hpp"

namespace cusp::contour_pocket {

// Loops halfway between the levels over the stretches where too much stands, so again in both
// halves, until nowhere more stands than may (LoopScallop::stretches()) or passes lie as near as
// they ever do (least_stepover()). No value where too much stands beside a spur into a corner, or
// where the loops add more than `max_length` mm of path.
std::optional<std::vector<clearing::PartialLoop>> partial_levels(const clearing::LoopStrip& strip,
                                                                 LoopScallop& loop_scallop,
                                                                 double radius,
                                                                 double max_length);

}  // namespace cusp::contour_pocket
