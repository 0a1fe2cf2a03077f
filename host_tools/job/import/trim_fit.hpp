// Trimming curves fitted to the edges of a face in (u, v).
#pragma once

#include <functional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/face_edges.hpp"

namespace cusp::import {

// (u, v) of a point of an edge, z = 0, and the tangent there by the edge's parameter.
using UvOf = std::function<PointAndTangent(const PointAndTangent&)>;

// A curve for each edge of the loops: Bezier spans of degree 3 that meet the edge's places and tangents,
// halved until they are within `tolerance` of it in (u, v). The ends of curves meet exactly. Loops in which
// trim_loops() sees no area are left out: a cell may touch an edge, or cut off less than can be cut.
std::vector<nurbs::Curve> fitted_trims(const std::vector<FaceLoop>& loops,
                                       const UvOf& uv_of,
                                       double tolerance);

}  // namespace cusp::import
