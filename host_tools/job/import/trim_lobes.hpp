// Cuts off the lobes of trimming loops that cross themselves.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// The loops of a face without lobes, as polylines.
//
// widest  mm on the surface: of the lobes cut off
struct LobeCut {
    std::vector<std::vector<nurbs::Curve>> loops;
    double widest;
};

// A loop that crosses itself is cut at each crossing into loops that do not. The largest of these is the face;
// so is what lies outside it and runs the same way round. The rest are lobes: blends of CAD kernels have
// them at corners, where an edge overshoots its vertex, or two edges that run along each other change sides.
//
// loop   each curve starts at the end of the one before it, the first one at the end of the last one
// width  mm on the surface: of lobes at most, four times their area by the way round them
//
// Returns none where the loop does not cross itself, or a lobe is wider.
std::optional<LobeCut> cut_lobes(const std::vector<nurbs::Curve>& loop,
                                 double width,
                                 const nurbs::Surface& surface);

}  // namespace cusp::import
