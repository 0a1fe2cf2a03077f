// Apertures of Gerber files: the standard ones, and those that macros describe.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::import {

struct Aperture {
    offset::Region2d shape;        // mm, about its origin
    double diameter{};             // mm, of a solid circle; 0: it is none
    std::vector<Vec2d> corners{};  // of a solid rectangle, counter-clockwise; else none
};

// Macros by their names, each as its words without the first.
using ApertureMacros = std::map<std::string, std::vector<std::string>>;

// text    behind the D code of an AD command: "C,0.8", "R,1X0.5X0.2", a macro's name with its parameters
// unit    mm
// macros  of the file so far
// place   file and line, for messages
//
// Errors: InputError: neither a standard aperture nor a macro, parameters that are missing, malformed or out of their
// range, a primitive of a macro that is not known, expressions more than 64 deep.
Aperture aperture_of(std::string_view text,
                     double unit,
                     const ApertureMacros& macros,
                     const std::string& place);

}  // namespace cusp::import
