// Curves from DXF drawings: LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE and POLYLINE with bulges,
// SPLINE, and blocks of them at each INSERT: translated, rotated, scaled, mirrored, in arrays,
// nested.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

// Seen from above, mm; of a drawing in x and z or in y and z, as its note says.
struct DxfPaths {
    std::vector<DrawingPath> paths;  // in the order of the file; each of one curve or more
    // Value of the last decimal place that coordinates are written with; 0: they are whole numbers.
    double resolution{};
};

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
DxfPaths read_dxf_paths(const std::string& file,
                        double millimetres,
                        const std::string& layer = "",
                        std::vector<std::string>* notes = nullptr);

// The objects of a drawing that can be drilled: its POINTs, and its curves.
struct DxfPlaces {
    std::vector<Vec2d> points;
    std::vector<nurbs::Curve> curves;
};

// As read_dxf_paths(), with the POINTs beside the curves; either may be empty.
DxfPlaces read_dxf_places(const std::string& file,
                          double millimetres,
                          const std::string& layer = "",
                          std::vector<std::string>* notes = nullptr);

// One layer of a drawing.
struct DxfLayer {
    std::string name;
    bool hidden{};                   // switched off or frozen
    std::vector<DrawingPath> paths;  // in the order of the file
    std::string problem;             // why it can't be read, with the line; else empty
};

struct DxfLayers {
    double millimetres{};   // of one unit of the drawing
    std::string unit_name;  // as the drawing has it: "centimetres"; "": it names none
    double resolution{};    // mm, as in DxfPaths
    std::vector<DxfLayer> layers;
    std::vector<std::string> notes;
};

// Every layer that draws something, by name; curves as read_dxf_paths() makes them.
// Errors: InputError where the file is not DXF or holds no curve.
DxfLayers read_dxf_layers(const std::string& file, double millimetres);

}  // namespace cusp::import
