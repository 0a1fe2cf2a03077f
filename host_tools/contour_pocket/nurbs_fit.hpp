// Cubic B-splines through the bands of stations, by least squares. Needs Eigen (CUSP_EIGEN).
#pragma once

#include <optional>
#include <vector>

#include "host_tools/contour_pocket/tolerance_chain.hpp"

namespace cusp::contour_pocket {

// False in a build without Eigen: fit_cubic() then never finds a curve.
bool nurbs_fit_available();

// The curve with the fewest control points found that starts and ends at the first and last station
// (at the middle of the band) and passes every station within the band; no value where half as many
// control points as stations do not suffice.
std::optional<nurbs::Curve> fit_cubic(const std::vector<Station>& stations,
                                      const StationBand& band);

}  // namespace cusp::contour_pocket
