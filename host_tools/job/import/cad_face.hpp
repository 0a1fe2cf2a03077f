// A face of a CAD model, as trimmed B-spline surfaces.
#pragma once

#include <string>

#include "host_tools/job/import/cad_surfaces.hpp"

#include "opencascade/TopoDS_Face.hxx"

namespace cusp::import {

// solid  whether the face bounds a solid, so that its orientation says where the outside is
struct SolidFace {
    TopoDS_Face face;
    bool solid;
};

// Adds the face's surfaces to the model: one, or several where it is read in patches or pieces.
// Faces of solids that face up nowhere are left out, unless `all_faces`; then one that cannot be
// read is counted in `unread`.
//
// Throws InputError, with `place` before it.
void add_face(const SolidFace& found, bool all_faces, const std::string& place, CadModel& model);

}  // namespace cusp::import
