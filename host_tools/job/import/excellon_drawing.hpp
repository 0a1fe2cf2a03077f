// Holes and slots of circuit boards from Excellon files (NC drill).
//
// Two layers: "holes", a circle each, and "slot_holes", the borders of slots (G85) and of routed ways. Coordinates with a
// point, or digits by LZ, TZ and the format of the header or of `;FILE_FORMAT=`; inches or millimetres; absolute.
#pragma once

#include <string>

#include "host_tools/job/import/drawing.hpp"

namespace cusp::import {

// Its notes say how digits without a point were read if the file does not.
//
// Errors: InputError with file and line: no Excellon file, malformed words, a tool that has no diameter, incremental
// coordinates, nothing drilled.
DrawnLayers read_excellon_layers(const std::string& file);

}  // namespace cusp::import
