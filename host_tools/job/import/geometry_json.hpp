// Curves and surfaces in the JSON form of NURBS-Python (geomdl) and rw3dm.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// millimetres  of one unit of the file: 1 or 25.4
//
// Returns valid shapes with clamped ends (nurbs_validity.hpp), surfaces with their trims.
// Errors: InputError naming file, shape, quantity, value and limit.
std::vector<nurbs::Surface> read_json_surfaces(const std::string& file, double millimetres);
std::vector<nurbs::Curve> read_json_curves(const std::string& file, double millimetres);

// Surfaces or curves, as the file declares.
std::variant<std::vector<nurbs::Surface>, std::vector<nurbs::Curve>> read_json_shapes(
    const std::string& file, double millimetres);

}  // namespace cusp::import
