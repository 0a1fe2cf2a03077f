// Curves from DXF drawings: LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE and POLYLINE with bulges,
// SPLINE, and blocks of them at each INSERT: translated, rotated, scaled, mirrored, in arrays,
// nested.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// millimetres  of one unit of the drawing, unless its $INSUNITS says millimetres or inches itself
//              (drawing programs write other units by default)
// layer        its name; "": all layers that are neither off nor frozen
// notes        receives a sentence on texts beside the curves; may be null
//
// Returns the curves of the ENTITIES section, in the order of the file. Arcs become rational
// quadratics, exactly; a spline is split at inner knots of multiplicity degree + 1. Objects of a
// block on layer "0" are on the layer of its INSERT.
// Errors: InputError with the line of the file: not DXF, an unknown block, blocks nested more than
// 16 deep, malformed numbers, an unsupported entity (hatches, text and dimensions are skipped), a
// mesh, a spline without control points.
std::vector<nurbs::Curve> read_dxf_curves(const std::string& file,
                                          double millimetres,
                                          const std::string& layer = "",
                                          std::vector<std::string>* notes = nullptr);

// The objects of a drawing that can be drilled: its POINTs, and its curves.
struct DxfPlaces {
    std::vector<Vec2d> points;
    std::vector<nurbs::Curve> curves;
};

// As read_dxf_curves(), with the POINTs beside the curves; either may be empty.
DxfPlaces read_dxf_places(const std::string& file,
                          double millimetres,
                          const std::string& layer = "");

// One layer of a drawing.
struct DxfLayer {
    std::string name;
    bool hidden{};                     // switched off or frozen
    std::vector<nurbs::Curve> curves;  // in the order of the file
    std::string problem;               // why it can't be read, with the line; else empty
};

struct DxfLayers {
    double millimetres{};  // of one unit of the drawing
    bool names_unit{};     // by $INSUNITS
    std::vector<DxfLayer> layers;
};

// Every layer that draws something, by name; curves as read_dxf_curves() makes them.
// Errors: InputError where the file is not DXF or holds no curve.
DxfLayers read_dxf_layers(const std::string& file, double millimetres);

}  // namespace cusp::import
