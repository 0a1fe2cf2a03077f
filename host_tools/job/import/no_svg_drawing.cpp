// In place of svg_drawing.cpp and svg_shapes.cpp in WebAssembly, for which Debian has no pugixml.
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_drawing.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

[[noreturn]] void refuse(const std::string& file)
{
    throw InputError(fmt::format(
        "{}: SVG can't be read in the page: cusp studio and the program read it; or save it as DXF",
        file));
}

}  // namespace

DrawnPaths read_svg_paths(const std::string& file,
                          const std::string& /*layer*/,
                          std::vector<std::string>* /*notes*/)
{
    refuse(file);
}

DrawnLayers read_svg_layers(const std::string& file) { refuse(file); }

}  // namespace cusp::import
