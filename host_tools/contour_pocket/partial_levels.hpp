// Partial loops between two rings that are too far apart for some of the floor between them.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/loop_scallop.hpp"

namespace cusp::contour_pocket {

// Loops halfway between the rings over the stretches where the scallop is too high, again in both
// halves, until it is nowhere too high (LoopScallop::stretches()) or passes are as near as they may
// be (least_stepover()). No value where it is too high beside a spur into a corner, or
// where the loops add more than `max_length` mm of path.
std::optional<std::vector<clearing::PartialLoop>> partial_levels(const clearing::LoopStrip& strip,
                                                                 LoopScallop& loop_scallop,
                                                                 double radius,
                                                                 double max_length);

}  // namespace cusp::contour_pocket
