// Borders of the dark region as paths.
#include "host_tools/job/import/gerber_drawing.hpp"

#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/gerber_image.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr const char* kProfile = "Profile";
constexpr const char* kStrokes = "lines";

std::string dark_name(const std::string& function)
{
    return function == "Soldermask" ? "mask"
           : function == "Paste"    ? "paste"
           : function == "Legend"   ? "legend"
           : function == kProfile   ? "dark"
                                    : "copper";
}

}  // namespace

DrawingPath path_along(const offset::Contour& contour)
{
    DrawingPath path{{}, true};
    for (const offset::Edge& edge : contour) {
        const Vec2d out = edge.start - edge.centre;
        path.curves.push_back(edge.turn == 0 ? line_curve(edge.start, edge.end)
                                             : arc_curve(edge.centre, edge.radius,
                                                         elementary::atan2(out.y, out.x),
                                                         edge.turn * offset::sweep(edge)));
    }
    return path;
}

DrawnLayers read_gerber_layers(const std::string& file)
{
    GerberImage image = gerber_image(file, files::text_of_file(file));
    const bool profile = image.function == kProfile;
    DrawnLayers drawn{
        image.unit, image.unit == 1.0 ? "millimetres" : "inches", image.resolution, {}, {}};
    DrawnLayer dark{dark_name(image.function), profile, {}, {}};
    for (const offset::Contour& contour : dark_region(image.objects).contours) {
        dark.paths.push_back(path_along(contour));
    }
    DrawnLayer lines{profile ? "outline" : kStrokes, !profile, std::move(image.lines), {}};
    for (DrawnLayer* const layer : {&dark, &lines}) {
        if (!layer->paths.empty()) {
            drawn.layers.push_back(std::move(*layer));
        }
    }
    if (drawn.layers.empty()) {
        throw InputError(fmt::format("{}: nothing is drawn", file));
    }
    return drawn;
}

}  // namespace cusp::import
