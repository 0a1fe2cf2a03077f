// Where a chamfer's tool runs beside the edge that it breaks.
#pragma once

namespace cusp::job {

// mm from the edge to the tool's tip: the flank and not the tip cuts the lower edge.
inline constexpr double kChamferTip = 0.2;

}  // namespace cusp::job
