// The geometry behind ArcFitter: one candidate move for a run of vertices.
#pragma once

#include "firmware/segmenter/arc_fitter.hpp"

namespace cusp::segmenter {

// In the middle of a line the path may lie further off, by this factor. It is less than the tenth
// that users are promised, since the farthest point of an arc may be beside the middle.
inline constexpr double kBetweenVertices = 1.06;

// A line from the first to the last vertex: false where it leaves the tolerance, or where the
// vertices do not follow it in order.
bool fit_line(Span<const Vec3d> vertices, const FitSettings& settings, FittedMove& move) noexcept;

// An arc or helix in `plane` through the first and last vertex. Precondition: at least 3 vertices.
bool fit_arc(Span<const Vec3d> vertices,
             path::Plane plane,
             const FitSettings& settings,
             FittedMove& move) noexcept;

}  // namespace cusp::segmenter
