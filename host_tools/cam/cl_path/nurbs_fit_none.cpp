// The build without Eigen: no curves are fitted.
#include "host_tools/cam/cl_path/nurbs_fit.hpp"

namespace cusp::cl_path {

bool nurbs_fit_available() { return false; }

std::optional<nurbs::Curve> fit_cubic(const std::vector<Station>&, const StationBand&)
{
    return std::nullopt;
}

}  // namespace cusp::cl_path
