// Roughs a pocket over a floor that is not level by passes of bounded engagement.
#pragma once

#include "host_tools/cam/contour_pocket/rough_layers.hpp"

namespace cusp::contour_pocket {

// Cuts each layer of `result.heights` where the floor is lower, as deep as it is; then, from below, the
// ground beside it that is too high for the layer, in steps of a fifth of its depth. Each step is cut
// from its side, at most as deep as the layer. Fills the operation, and `left`: the steps' height too.
//
// pocket  its operation has the tool that roughs
// step    mm: of steps, where the layers are deep enough for several
//
// Errors: InputError if the region is too large for the tool (check_adaptive_size()).
void rough_adaptively(const Pocket& pocket, double step, RoughResult& result);

}  // namespace cusp::contour_pocket
