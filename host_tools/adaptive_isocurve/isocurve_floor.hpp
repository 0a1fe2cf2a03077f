// The floor as isocurves take it: passes along u, at spacings that make sense.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::adaptive_isocurve {

// The floor's surfaces, u and v exchanged where passes shall run along v.
std::vector<nurbs::Surface> surfaces_along_u(const job::Operation& operation);

// Throws InputError where neither a scallop nor a distance is given, or where it does not suit the
// tool or the part's size.
void check_spacing(const job::Job& job, const job::Operation& operation);

// Whether the surface has no trim, crease or pole: there the ridges between neighbours say too
// little.
bool is_plain(const nurbs::Surface& s);

}  // namespace cusp::adaptive_isocurve
