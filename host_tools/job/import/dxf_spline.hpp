// The curves of a SPLINE: by control points and knots, or by fit points alone.
#pragma once

#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/dxf_drawing.hpp"

namespace cusp::import {

// In the coordinates of the drawing, mm. Split at inner knots of multiplicity degree + 1. Through fit
// points goes interpolated_curve(): with the tangents that are given, closed where the entity says so
// or the last point is the first and there are none.
//
// interpolated  grows by one where fit points alone are given
//
// Errors: InputError with the line, where neither makes a curve.
DrawingPath drawn_spline(const DxfDrawing& drawing,
                         const DxfEntity& entity,
                         std::size_t& interpolated);

}  // namespace cusp::import
