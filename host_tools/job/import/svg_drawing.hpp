// Curves from SVG drawings: paths, basic shapes, groups, `use`, nested drawings, with their transforms.
//
// Millimetres follow from width, height and viewBox; without a physical size a unit is a pixel of CSS, 96 an inch. y is
// upwards from the lower edge of the page. A layer is a group by its label (of Inkscape) or its id; FILE.svg#NAME takes
// everything of that label or id, a single object too. Strokes count as their centre lines, fills as their outlines.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/drawing.hpp"

namespace cusp::import {

// layer  "": everything that is shown
// notes  receives sentences on the unit, texts, pictures, and coordinates far from the origin; may be null
//
// Bezier curves, and circles and ellipses as rational quadratics, are exact.
// Errors: InputError with file and line: no XML, no SVG, malformed values, `use` of what is not there or more than 16
// deep, elements more than 256 deep, more than 500000 of them, no curve at all.
DrawnPaths read_svg_paths(const std::string& file,
                          const std::string& layer,
                          std::vector<std::string>* notes);

// Each shape is on one layer: of Inkscape, the innermost; else the outermost group with a label or an id; "0": in none.
DrawnLayers read_svg_layers(const std::string& file);

}  // namespace cusp::import
