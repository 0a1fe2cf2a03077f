// Partial loops between two rings whose distance is too large for part of the floor between them.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/contour_pocket/loop_scallop.hpp"

namespace cusp::contour_pocket {

// Loops halfway between the rings along the stretches with too high a scallop, repeated in both
// halves until no scallop is too high (LoopScallop::stretches()) or passes are as close as allowed
// (least_stepover()). None if the scallop is too high beside a cleanup spur, or if the loops add
// more than `max_length` mm of path.
std::optional<std::vector<clearing::PartialLoop>> loops_in_strip(const clearing::LoopStrip& strip,
                                                                 LoopScallop& loop_scallop,
                                                                 double radius,
                                                                 double max_length);

}  // namespace cusp::contour_pocket
