// A Gerber file as objects in order, and the lines that it draws.
//
//     const GerberImage image = gerber_image("top.gbr", text);
//     const offset::Region2d copper = dark_region(image.objects);
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/gerber_plotter.hpp"

namespace cusp::import {

struct GerberImage {
    std::vector<GerberObject> objects;
    std::vector<DrawingPath> lines;  // the middles of strokes
    std::string function;            // "Profile", "Copper"; "": the file does not say
    double unit{1};                  // mm
    double resolution{};             // mm
};

// text  of the file
//
// Errors: InputError, as read_gerber_layers(), but for a file that draws nothing.
GerberImage gerber_image(const std::string& file, const std::string& text);

}  // namespace cusp::import
