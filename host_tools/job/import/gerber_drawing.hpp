// Drawings of circuit boards from Gerber files (RS-274X, X2, X3): what is dark, and the lines that were drawn.
//
// Two layers: "copper" (by the attribute FileFunction "mask", "legend", ...) holds the borders of all that is dark,
// laid together; "lines" the middles of strokes, hidden. Of a board's profile (FileFunction Profile) the lines are the
// layer "outline", and what is dark is hidden. Strokes by round and rectangular apertures, flashes, macros, regions,
// clear polarity, block apertures, step and repeat, mirroring, turns and scales are read.
#pragma once

#include <string>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/drawing.hpp"

namespace cusp::import {

// Accuracy: that of region_overlay.hpp; arcs whose ends are not as far from their centre move it by as much.
// Errors: InputError with file and line: no Gerber file, malformed or unknown words, an aperture that is not defined,
// an arc without a radius, more than 1 000 000 objects, nothing drawn.
DrawnLayers read_gerber_layers(const std::string& file);

// A closed path.
DrawingPath path_along(const offset::Contour& contour);

}  // namespace cusp::import
