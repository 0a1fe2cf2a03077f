// Faces of a CAD model that Open CASCADE converts to splines badly: how badly, and other ways to read them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/job/import/face_edges.hpp"

#include "opencascade/TopoDS_Face.hxx"
#include "opencascade/TopoDS_Shape.hxx"
#include "opencascade/gp_Pnt.hxx"

namespace cusp::import {

inline Vec3d vec_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

// mm2, of all faces; negative where edges run round a face the wrong way.
double area_of(const TopoDS_Shape& shape);

// mm: how far its edges may lie beside a face: 0.01, and 1.5 times the tolerance of the file, 1 at most.
double allowed_off(const TopoDS_Face& face);

// mm: how far ends of edges that meet may lie apart: 0.01, and twice the tolerance of the file's vertices,
// 0.1 at most.
double allowed_gap(const TopoDS_Face& face);

// The edges of a face, forward oriented, without seams and poles. Seen from where the normal of its
// surface points to, the face lies on their left; on their right with `backwards`.
std::vector<FaceEdge> edges_in_space(const TopoDS_Face& face, bool backwards);

// Refuses what Open CASCADE's conversion has spoilt: on cones, balls and rings it makes curves in
// (u, v) that lie millimetres beside their edges. allowed_off() is allowed.
//
// Returns how far an edge lies beside its place at most, mm.
// Throws InputError, with `place` before it.
double check_conversion(const TopoDS_Face& original,
                        const TopoDS_Face& converted,
                        const std::string& place);

// The face, forward oriented, with a spline for its surface and the same (u, v): a spline, a plane, and
// what is swept along a line or about an axis, if it can be had within 1e-4 mm. None for others.
std::optional<TopoDS_Face> spline_with_same_trims(const TopoDS_Face& face);

}  // namespace cusp::import
