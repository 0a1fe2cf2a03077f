// Selects the reader by the ending of the file.
#include "host_tools/job/import/drawing.hpp"

#include "host_tools/job/import/dxf_curves.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/svg_drawing.hpp"

namespace cusp::import {
namespace {

bool is_svg(const std::string& file) { return path_ending(file) == ".svg"; }

}  // namespace

DrawnPaths read_drawn_paths(const std::string& file,
                            double millimetres,
                            const std::string& layer,
                            std::vector<std::string>* notes)
{
    return is_svg(file) ? read_svg_paths(file, layer, notes)
                        : read_dxf_paths(file, millimetres, layer, notes);
}

DrawnPlaces read_drawn_places(const std::string& file,
                              double millimetres,
                              const std::string& layer,
                              std::vector<std::string>* notes)
{
    return is_svg(file) ? DrawnPlaces{{}, curves_of(read_svg_paths(file, layer, notes).paths)}
                        : read_dxf_places(file, millimetres, layer, notes);
}

DrawnLayers read_drawn_layers(const std::string& file, double millimetres)
{
    return is_svg(file) ? read_svg_layers(file) : read_dxf_layers(file, millimetres);
}

}  // namespace cusp::import
