// The one place where the end decides.
#include "host_tools/cam/finishing/mesh_check.hpp"

#include "host_tools/cam/finishing/end_scallop_check.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"

namespace cusp::finishing {

std::unique_ptr<MeshCheck> mesh_check(const std::vector<Corners>& triangles,
                                      const GougeFreePathFitter& path_fitter,
                                      double scallop,
                                      double path_off)
{
    if (path_fitter.tool().shape == toolpath::ToolShape::kBall) {
        return std::make_unique<MeshScallopCheck>(triangles, path_fitter, scallop, path_off);
    }
    return std::make_unique<EndScallopCheck>(triangles, path_fitter, scallop, path_off);
}

}  // namespace cusp::finishing
