// The ending of a file name, which selects the reader.
#pragma once

#include <cstddef>
#include <string>

namespace cusp::import {

// With its dot, in lower case: ".step"; "" where there is none.
std::string path_ending(const std::string& file);

// Of a drawing, by its ending: "DXF", "SVG", "Gerber" (.gbr, .ger, .gtl, .gbl, .gko, .gm1), "Excellon" (.drl, .xln);
// else null.
const char* drawing_format(const std::string& file);

// Files that hold drawings, for messages.
inline constexpr const char* kDrawingEndings =
    ".dxf, .svg, .gbr, .gtl, .gbl, .gko, .gm1, .ger, .drl and .xln";

// True if it holds curves by layers.
bool is_drawing_file(const std::string& file);

// Place of "#layer" in the name of a drawing, or of "#region" in that of a part (part_regions.hpp): at the first # after its ending, since names of layers
// may hold more of them, and folders too. npos: none.
std::size_t layer_mark(const std::string& name);

// Files that hold parts, for messages.
inline constexpr const char* kPartEndings =
    ".json, .step, .stp, .iges, .igs, .brep, .brp, .stl, .obj, .3mf and .png";

// True if Open CASCADE reads it: .step, .stp, .iges, .igs, .brep, .brp.
bool is_cad_file(const std::string& file);

}  // namespace cusp::import
