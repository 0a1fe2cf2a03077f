// The shapes of drawings, apart by what their layers are for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/one_line_job.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/import/sheet_layers.hpp"

namespace cusp::import {

// Shapes that operations name by a file and its layers.
struct SheetShapes {
    std::string boundary;             // FILE or FILE#LAYER
    std::vector<std::string> layers;  // of the file, where it is not one and not all
    std::string words;                // for people
    FileShapes shapes;                // placed, mm
    bool swapped{};  // its outlines lie in outlines of another drawing: they are holes
};

struct SheetLayer {
    LayerUse use;
    SheetShapes place;
};

struct SheetDrawing {
    std::vector<SheetLayer> named;      // by an option or by their names, but for those left out
    std::optional<SheetShapes> sorted;  // all others together
};

// One for each part of the request; layers that are hidden count where an option names them.
//
// millimetres  of one unit
//
// Errors: InputError: an option for a layer that no drawing has; lines that nearly close; shapes of one drawing
// partly in outlines of another; those of read_shapes().
std::vector<SheetDrawing> sheet_drawings(const OneLineRequest& request,
                                         const job::Strategies& strategies,
                                         double millimetres,
                                         PartFiles& parts);

}  // namespace cusp::import
