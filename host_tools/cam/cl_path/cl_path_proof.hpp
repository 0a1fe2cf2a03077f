// Proof that the moves of a CL path do not gouge; moves that do are raised.
#pragma once

#include "host_tools/cam/cl_path/cl_path.hpp"

namespace cusp::cl_path {

// The point as it is written: rounded to kWrittenStep, z up.
Vec3d written(Vec3d p);

// Raises the ends of moves until every move clears the floor, and sets the path's least clearance.
// Returns the largest raise of a move, mm.
double certify(ClPath& path, const PathFloor& floor, const ClPathSettings& settings, bool closed);

// As certify(), for paths with curves: raises control points. If the shortfall exceeds the band
// (beside a cliff) nothing is raised, and the shortfall is returned.
double certify_curves(ClPath& path,
                      const PathFloor& floor,
                      const ClPathSettings& settings,
                      bool closed);

}  // namespace cusp::cl_path
