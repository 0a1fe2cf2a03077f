// The basic shapes of SVG as paths: rect, circle, ellipse, line, polyline, polygon, and path.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"

namespace cusp::import {

// Without the prefix of its name space: "path" of "svg:path".
std::string svg_name(const pugi::xml_node& node);

// True for the names above.
bool is_svg_shape(const std::string& name);

// A length of an element in its own coordinates.
//
// whole  what 100 % is
// Errors: InputError with the attribute and its value: no length of SVG.
double svg_length_of(const pugi::xml_node& node,
                     const char* attribute,
                     double whole,
                     double otherwise,
                     const std::string& place);

// In the coordinates of the element; without length: none.
//
// viewport  what 100 % is along x and y
// place     file and line, for messages
// Errors: InputError with the attribute that is wrong.
std::vector<DrawingPath> paths_of_shape(const pugi::xml_node& node,
                                        Vec2d viewport,
                                        const std::string& place);

}  // namespace cusp::import
