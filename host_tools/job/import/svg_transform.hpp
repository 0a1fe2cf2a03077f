// Affine maps of the plane, as the attribute `transform` of SVG writes them.
#pragma once

#include <string>
#include <string_view>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// p.x * x + p.y * y + at. The default is the identity.
struct PlaneMap {
    Vec2d x{1, 0};
    Vec2d y{0, 1};
    Vec2d at{0, 0};

    Vec2d of(Vec2d p) const { return p.x * x + p.y * y + at; }
    // z stays.
    nurbs::Curve of(nurbs::Curve curve) const;
    double determinant() const { return x.x * y.y - x.y * y.x; }
};

// First `inner`, then `outer`.
PlaneMap operator*(const PlaneMap& outer, const PlaneMap& inner);

PlaneMap moved_by(Vec2d way);
PlaneMap stretched_by(double along_x, double along_y);

// The value of the attribute: matrix, translate, scale, rotate, skewX, skewY, the last one first.
//
// place  file and line, for messages
// Errors: InputError with the function that is wrong.
PlaneMap plane_map(std::string_view text, const std::string& place);

}  // namespace cusp::import
