// The trimming loops of a face of a CAD model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"

#include "opencascade/TColStd_Array1OfReal.hxx"
#include "opencascade/TopoDS_Face.hxx"

namespace cusp::import {

inline std::vector<double> list_of(const TColStd_Array1OfReal& knots)
{
    return {knots.begin(), knots.end()};
}

// Differences allowed between a face and the file, mm: of its edges from it, and of their ends from
// each other.
struct FaceTolerance {
    double off;
    double gap;
};

// face     forward oriented, with a spline for its surface
// surface  of the face, without trims
//
// Adds to the model's faults what was mended.
// Errors: InputError, with `place` before it.
void add_trims(const TopoDS_Face& face,
               FaceTolerance allowed,
               const std::string& place,
               nurbs::Surface& surface,
               CadModel& model);

// The surface on a domain that holds the trims, which CAD kernels may let leave a spline that they extrapolate;
// by a fifth of the domain at most. None where it holds them, or is periodic.
std::optional<nurbs::Surface> extended_to_trims(const TopoDS_Face& face,
                                                const std::string& place,
                                                const nurbs::Surface& surface);

}  // namespace cusp::import
