// The build without Eigen: no curves are fitted.
#include "host_tools/contour_pocket/nurbs_fit.hpp"

namespace cusp::contour_pocket {

bool nurbs_fit_available() { return false; }

std::optional<nurbs::Curve> fit_cubic(const std::vector<Station>&, const StationBand&)
{
    return std::nullopt;
}

}  // namespace cusp::contour_pocket
