// Curves from DXF drawings: LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE and POLYLINE with bulges,
// SPLINE, and blocks of them at each INSERT: translated, rotated, scaled, mirrored, in arrays,
// nested.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/drawing.hpp"

namespace cusp::import {

// millimetres  of one unit of the drawing, unless it says so itself: by $INSUNITS, or by $MEASUREMENT
// layer        its name in UTF-8; "": all layers that are neither off nor frozen
// notes        receives sentences on the unit, the plane, entities that are no curves, splines that are
//              interpolated, texts, and coordinates far from the origin; may be null
//
// Returns the curves of the ENTITIES section. Arcs become rational quadratics, exactly; a spline is
// split at inner knots of multiplicity degree + 1. Objects of a block on layer "0" are on the layer of
// its INSERT. Coordinates are at most 1e10 mm.
// Errors: InputError with the line of the file: not DXF, an unknown unit or block, blocks nested more
// than 16 deep, malformed numbers, a spline without points, no curve at all.
DrawnPaths read_dxf_paths(const std::string& file,
                          double millimetres,
                          const std::string& layer = "",
                          std::vector<std::string>* notes = nullptr);

// As read_dxf_paths(), with the POINTs beside the curves; either may be empty.
DrawnPlaces read_dxf_places(const std::string& file,
                            double millimetres,
                            const std::string& layer = "",
                            std::vector<std::string>* notes = nullptr);

// Every layer that draws something, by name; curves as read_dxf_paths() makes them.
// Errors: InputError where the file is not DXF or holds no curve.
DrawnLayers read_dxf_layers(const std::string& file, double millimetres);

}  // namespace cusp::import
