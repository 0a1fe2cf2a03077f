// The floor prepared for isocurves: passes along u, and checked spacings.
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

// The floor's surfaces, with u and v exchanged if the operation's passes run along v.
std::vector<nurbs::Surface> surfaces_along_u(const job::Operation& operation);

// Throws InputError where neither scallop nor iso_distance is given, or where it does not suit the
// tool or the size of the part.
void check_spacing(const job::Job& job, const job::Operation& operation);

// True if the surface has no trim, crease or pole. Elsewhere scallops between neighbours alone do
// not bound what is left.
bool is_plain(const nurbs::Surface& s);

}  // namespace cusp::adaptive_isocurve
