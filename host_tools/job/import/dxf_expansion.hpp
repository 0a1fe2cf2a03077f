// The curves that the entities of a drawing draw, with blocks drawn at each INSERT.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/dxf_drawing.hpp"

namespace cusp::import {

// In the coordinates of the drawing, mm, in the order of the file.
struct DxfPieces {
    std::vector<DrawingPath> paths;
    std::vector<DrawingPath> points, texts;       // places: paths without length
    std::map<std::string, std::size_t> left_out;  // entities that draw no curve, by their kinds
    std::size_t interpolated{};                   // splines of fit points alone
};

// layer  "": all that are neither off nor frozen
//
// Objects of a block on layer "0" are on the layer of its INSERT.
// Errors: InputError with the line: an unknown block, blocks nested more than 16 deep, more than 100000
// objects, curves with values that make none.
DxfPieces expanded(const DxfDrawing& drawing, const std::string& layer);

// All layers, hidden ones too; what can't be drawn is left out.
DxfPieces all_that_can_be_drawn(const DxfDrawing& drawing);

// Layer of an object: its own, or that of the block's reference, for objects on layer "0".
//
// within  the layer of the reference; "": not in a block
std::string_view layer_of(const DxfEntity& entity, std::string_view within);

}  // namespace cusp::import
