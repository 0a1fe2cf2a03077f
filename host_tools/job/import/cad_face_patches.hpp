// Faces of spheres, rings, cones and cylinders, read from their edges in space.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

#include "opencascade/TopoDS_Face.hxx"

namespace cusp::import {

struct FacePatches {
    std::vector<nurbs::Surface> surfaces;
    double outwards;  // +1 if du x dv points out of the face's solid, -1 if into it
};

// None for a face of another kind. `place` begins the message.
// Errors: InputError where the edges bound no face on the surface.
std::optional<FacePatches> patches_of(const TopoDS_Face& face, const std::string& place);

}  // namespace cusp::import
