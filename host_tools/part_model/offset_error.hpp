// How far a polynomial patch is from the exact offset of a rational patch: a computed bound over
// all of it, not the most of samples.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_model {

// Bound of |offset(s, t) - (patch(s, t) + distance * n(s, t))| over the square, n the unit normal
// along `side` * (S_u x S_v); infinity where the patch is so degenerate that it has no normal
// everywhere, or where the bound can't be brought under `sufficient` by quartering (at most three
// times).
//
// patch, offset  with one span each way, over the same part of the domain; weights of `offset` are
// 1 enough         mm: no quartering where the bound is lower
//
// With E = offset - patch the error splits into that across the tangent plane, from bounds of
// E . E - distance^2, and that along it, from bounds of E . S_u and E . S_v: all of them are
// polynomials (times powers of the weight), bounded by their Bernstein coefficients.
double offset_error_bound(const nurbs::Surface& patch,
                          const nurbs::Surface& offset,
                          double distance,
                          double side,
                          double sufficient);

}  // namespace cusp::part_model
