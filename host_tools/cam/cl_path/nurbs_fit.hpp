// Least-squares cubic B-splines through the bands of stations. Needs Eigen (CUSP_EIGEN).
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/cl_path/tolerance_chain.hpp"

namespace cusp::cl_path {

// False in a build without Eigen: fit_cubic() then finds no curve.
bool nurbs_fit_available();

// The curve with the fewest control points found that starts and ends at the first and last station
// (in the middle of the band) and passes every station within the band. None if it would need more
// than half as many control points as stations.
std::optional<nurbs::Curve> fit_cubic(const std::vector<Station>& stations,
                                      const StationBand& band);

}  // namespace cusp::cl_path
