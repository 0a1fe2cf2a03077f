// Selects the reader by the ending of the file.
#include "host_tools/job/import/drawing.hpp"

#include <set>
#include <string_view>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing_notes.hpp"
#include "host_tools/job/import/dxf_curves.hpp"
#include "host_tools/job/import/excellon_drawing.hpp"
#include "host_tools/job/import/gerber_drawing.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/svg_drawing.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

DrawnLayers board_layers(const std::string& file, std::string_view format)
{
    return format == "Gerber" ? read_gerber_layers(file) : read_excellon_layers(file);
}

// layer  "": all that are shown
DrawnPaths board_paths(const std::string& file,
                       std::string_view format,
                       const std::string& layer,
                       std::vector<std::string>* notes)
{
    DrawnLayers drawing = board_layers(file, format);
    DrawnPaths drawn{{}, drawing.resolution};
    std::set<std::string> names;
    for (DrawnLayer& one : drawing.layers) {
        names.insert(one.name);
        if (layer.empty() ? !one.hidden : one.name == layer) {
            drawn.paths.insert(drawn.paths.end(), one.paths.begin(), one.paths.end());
        }
    }
    if (drawn.paths.empty()) {
        throw InputError(fmt::format("{}: no curve on the layer \"{}\"", file, layer) +
                         nearest_layers(layer, names));
    }
    if (notes != nullptr) {
        notes->insert(notes->end(), drawing.notes.begin(), drawing.notes.end());
        note_far(file, drawn.paths, *notes);
    }
    return drawn;
}

}  // namespace

DrawnPaths read_drawn_paths(const std::string& file,
                            double millimetres,
                            const std::string& layer,
                            std::vector<std::string>* notes)
{
    const std::string_view format = drawing_format(file);
    return format == "DXF"   ? read_dxf_paths(file, millimetres, layer, notes)
           : format == "SVG" ? read_svg_paths(file, layer, notes)
                             : board_paths(file, format, layer, notes);
}

DrawnPlaces read_drawn_places(const std::string& file,
                              double millimetres,
                              const std::string& layer,
                              std::vector<std::string>* notes)
{
    return drawing_format(file) == std::string_view{"DXF"}
               ? read_dxf_places(file, millimetres, layer, notes)
               : DrawnPlaces{{},
                             curves_of(read_drawn_paths(file, millimetres, layer, notes).paths)};
}

DrawnLayers read_drawn_layers(const std::string& file, double millimetres)
{
    const std::string_view format = drawing_format(file);
    return format == "DXF"   ? read_dxf_layers(file, millimetres)
           : format == "SVG" ? read_svg_layers(file)
                             : board_layers(file, format);
}

}  // namespace cusp::import
