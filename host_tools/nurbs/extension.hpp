// A surface beyond its domain.
#pragma once

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::nurbs {

// The surface on a larger domain: its outermost polynomials go on. The shape inside the old domain does not
// change.
//
// surface       clamped
// u_begin ...   of the new domain; what lies inside the old one leaves that end as it is
Surface extended(
    const Surface& surface, double u_begin, double u_end, double v_begin, double v_end);

}  // namespace cusp::nurbs
