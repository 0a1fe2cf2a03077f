// Drawings: curves by layers, whatever the file's format.
//
//     const DrawnPaths drawn = read_drawn_paths("sign.svg", 1, "letters", &notes);
//
// path_ending.hpp says which files are drawings; dxf_curves.hpp, svg_drawing.hpp, gerber_drawing.hpp and
// excellon_drawing.hpp say what is read of each format.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

// Seen from above, mm; of a DXF drawing in x and z or in y and z, as its note says.
struct DrawnPaths {
    std::vector<DrawingPath> paths;  // in the order of the file; each of one curve or more
    // Value of the last decimal place that coordinates are written with; 0: not known, or whole numbers.
    double resolution{};
};

// Places to drill: points, and curves; either may be empty.
struct DrawnPlaces {
    std::vector<Vec2d> points;
    std::vector<nurbs::Curve> curves;
};

// One layer of a drawing.
struct DrawnLayer {
    std::string name;
    bool hidden{};                   // switched off or frozen
    std::vector<DrawingPath> paths;  // in the order of the file
    std::string problem;             // why it can't be read, with the line; else empty
};

struct DrawnLayers {
    double millimetres{};   // of one unit of the drawing
    std::string unit_name;  // as the drawing has it: "centimetres"; "": it names none
    double resolution{};    // mm, as in DrawnPaths
    std::vector<DrawnLayer> layers;
    std::vector<std::string> notes;
};

// millimetres  of one unit of a drawing that names none
// layer        its name in UTF-8; "": all layers that are shown
// notes        receives sentences on the unit and on what is not taken as drawn; may be null
//
// Errors: InputError with file and line: not of its format, malformed, no curve at all.
DrawnPaths read_drawn_paths(const std::string& file,
                            double millimetres,
                            const std::string& layer = "",
                            std::vector<std::string>* notes = nullptr);

// As read_drawn_paths(), with points beside the curves; without either there is no error.
DrawnPlaces read_drawn_places(const std::string& file,
                              double millimetres,
                              const std::string& layer = "",
                              std::vector<std::string>* notes = nullptr);

// Every layer that draws something.
// Errors: InputError if the file is not of its format or holds no curve.
DrawnLayers read_drawn_layers(const std::string& file, double millimetres);

}  // namespace cusp::import
