// Error bound of a polynomial patch that approximates the offset of a rational patch: a bound over
// the whole patch, not a maximum of samples.
#pragma once

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// Bound of |offset(s, t) - (patch(s, t) + distance * n(s, t))| over the unit square, with n the
// unit normal along `side` * (S_u x S_v). kInfinite where the normal is not proved to exist
// everywhere on the patch. Patches with a bound above `sufficient` are divided into four, at most
// three times.
//
// patch, offset  with one span in u and v, over the same domain; weights of `offset` are 1
// sufficient     mm: no division where the bound is lower
//
// With E = offset - patch, the error has a normal part, from bounds of E . E - distance^2, and a
// tangential part, from bounds of E . S_u and E . S_v. All of these are polynomials (times powers
// of the weight), bounded by their Bernstein coefficients.
double offset_error_bound(const nurbs::Surface& patch,
                          const nurbs::Surface& offset,
                          double distance,
                          double side,
                          double sufficient);

}  // namespace cusp::part_model
