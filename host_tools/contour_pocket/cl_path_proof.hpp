// Proof that the moves of a CL path do not gouge, and raising of those that do.
#pragma once

#include "host_tools/contour_pocket/cl_path.hpp"

namespace cusp::contour_pocket {

// The point as it is written: rounded to kWrittenStep, z up.
Vec3d written(Vec3d p);

// Raises the ends of every move by what it lacks to keep off the floor, until none lacks anything,
// and sets the path's least clearance. Returns the most that a move is raised by, mm.
double certify(ClPath& path,
               const drop_cutter::DropCutter& floor,
               const ClPathSettings& settings,
               bool closed);

// As certify(), for paths with curves: raises control points. Where more than the band is lacking,
// beside a cliff, nothing is raised, and what lacks is returned.
double certify_curves(ClPath& path,
                      const drop_cutter::DropCutter& floor,
                      const ClPathSettings& settings,
                      bool closed);

}  // namespace cusp::contour_pocket
