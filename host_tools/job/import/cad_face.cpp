// One face: its surface, its trims, and what is done where these do not fit together.
#include "host_tools/job/import/cad_face.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/job/import/cad_face_patches.hpp"
#include "host_tools/job/import/cad_face_repair.hpp"
#include "host_tools/job/import/cad_face_trims.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"

#include "fmt/format.h"
#include "opencascade/BRepBuilderAPI_NurbsConvert.hxx"
#include "opencascade/BRepTools.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Geom2d_Curve.hxx"
#include "opencascade/GeomConvert.hxx"
#include "opencascade/Geom_BSplineSurface.hxx"
#include "opencascade/Geom_Plane.hxx"
#include "opencascade/Geom_RectangularTrimmedSurface.hxx"
#include "opencascade/Standard_Failure.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"

namespace cusp::import {

using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

// Least z of a unit normal that counts as upward; a face with less everywhere is vertical.
constexpr double kLeastRise = 1e-6;

// The least u and v of all ends of edges.
gp_Pnt2d least_corner(const TopoDS_Face& face)
{
    gp_Pnt2d least{kUnbounded, kUnbounded};
    for (TopExp_Explorer edges{face, TopAbs_EDGE}; edges.More(); edges.Next()) {
        double first = 0;
        double last = 0;
        const Handle(Geom2d_Curve) curve =
            BRep_Tool::CurveOnSurface(TopoDS::Edge(edges.Current()), face, first, last);
        for (const double t : {first, last}) {
            if (!curve.IsNull()) {
                const gp_Pnt2d p = curve->Value(t);
                least.SetCoord(std::min(least.X(), p.X()), std::min(least.Y(), p.Y()));
            }
        }
    }
    return least;
}

// The part of the surface that the face uses, with clamped ends.
Surface surface_of(const TopoDS_Face& face)
{
    double u0 = 0;
    double u1 = 0;
    double v0 = 0;
    double v1 = 0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    Handle(Geom_Surface) whole = BRep_Tool::Surface(face);
    if (whole->IsKind(STANDARD_TYPE(Geom_Plane))) {
        whole = new Geom_RectangularTrimmedSurface(whole, u0, u1, v0, v1);  // it has no end
    }
    const Handle(Geom_BSplineSurface) found = GeomConvert::SurfaceToBSplineSurface(whole);
    const Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(found->Copy());
    double low_u = 0;
    double high_u = 0;
    double low_v = 0;
    double high_v = 0;
    spline->Bounds(low_u, high_u, low_v, high_v);
    // The bounds of a periodic face may exceed the period by a tolerance. Then the least parameter
    // of its edges is the start.
    const gp_Pnt2d first = least_corner(face);
    const auto keep_within = [](bool periodic, double low, double high, double least, double& from,
                                double& to) {
        if (!periodic) {
            from = std::max(from, low);
            to = std::min(to, high);
        } else if (to - from > high - low) {
            from = least;
            to = least + (high - low);
        }
    };
    keep_within(spline->IsUPeriodic(), low_u, high_u, first.X(), u0, u1);
    keep_within(spline->IsVPeriodic(), low_v, high_v, first.Y(), v0, v1);
    spline->Segment(u0, u1, v0, v1);
    Surface surface;
    surface.degree_u = spline->UDegree();
    surface.degree_v = spline->VDegree();
    surface.size_u = spline->NbUPoles();
    surface.size_v = spline->NbVPoles();
    surface.knots_u = list_of(spline->UKnotSequence());
    surface.knots_v = list_of(spline->VKnotSequence());
    for (int i = 1; i <= surface.size_u; ++i) {
        for (int j = 1; j <= surface.size_v; ++j) {
            surface.points.push_back(vec_of(spline->Pole(i, j)));
            surface.weights.push_back(spline->Weight(i, j));
        }
    }
    return surface;
}

// True if any sampled normal of a solid's face points up. `outwards` is +1 if du x dv points out.
bool looks_up(const Surface& s, double outwards)
{
    constexpr int kLooks = 16;
    for (int k = 0; k < kLooks * kLooks; ++k) {
        const double a = (k % kLooks + 0.5) / kLooks;
        const double b = (k / kLooks + 0.5) / kLooks;
        const SurfacePoint p = derivatives_at(s, s.u_begin() + a * (s.u_end() - s.u_begin()),
                                              s.v_begin() + b * (s.v_end() - s.v_begin()));
        const Vec3d n = cross(p.du, p.dv);
        if (outwards * n.z > kLeastRise * norm(n)) {
            return true;
        }
    }
    return false;
}

// One face with its trims.
Surface trimmed_surface(const TopoDS_Face& face,
                        FaceTolerance allowed,
                        Surface surface,
                        const std::string& place,
                        CadModel& model)
{
    check_surface(surface, place);
    surface = clamped(surface);
    try {
        add_trims(face, allowed, place, surface, model);
    } catch (const InputError&) {
        std::optional<Surface> larger = extended_to_trims(face, place, surface);
        if (!larger) {
            throw;
        }
        surface = *std::move(larger);
        add_trims(face, allowed, place, surface, model);
    }
    return surface;
}

// The face with a spline for its surface. The wires of a forward-oriented face have its interior on their
// left in (u, v).
TopoDS_Face converted(const TopoDS_Face& face)
{
    const TopoDS_Shape forward = face.Oriented(TopAbs_FORWARD);
    const TopoDS_Shape spline = BRepBuilderAPI_NurbsConvert{forward, true}.Shape();
    return TopoDS::Face(spline.Oriented(TopAbs_FORWARD));
}

// +1 if du x dv points out of the solid.
double outwards_of(const SolidFace& found)
{
    return found.face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
}

// face  the found one or its conversion, forward oriented
void add_spline_face(const SolidFace& found,
                     const TopoDS_Face& face,
                     bool all_faces,
                     const std::string& place,
                     CadModel& model)
{
    // Sewing has also reversed such a face, so its normal can't be trusted.
    if (area_of(face) < 0) {
        throw InputError(place + ": its edges run round it the wrong way");
    }
    const Surface surface = surface_of(face);
    const double outwards = outwards_of(found);
    if (found.solid && !all_faces && !looks_up(surface, outwards)) {
        return;
    }
    const double beside = check_conversion(found.face, face, place);
    model.faces.push_back(trimmed_surface(face, {allowed_off(found.face), allowed_gap(found.face)},
                                          surface, place, model));
    model.beside.add(beside);
    model.outwards.push_back(found.solid ? outwards : 0.0);
}

// As add_spline_face(); what Open CASCADE cannot convert is an InputError, too.
void add_whole_face(const SolidFace& found,
                    bool all_faces,
                    const std::string& place,
                    CadModel& model)
{
    try {
        add_spline_face(found, converted(found.face), all_faces, place, model);
    } catch (const Standard_Failure& failure) {
        throw InputError(
            fmt::format("{}: Open CASCADE failed: {}", place, failure.GetMessageString()));
    }
}

// As add_whole_face(), for a face whose (u, v) need no conversion; that may spoil them. Returns false for
// others.
bool add_unconverted(const SolidFace& found,
                     bool all_faces,
                     const std::string& place,
                     CadModel& model)
{
    try {
        const std::optional<TopoDS_Face> face = spline_with_same_trims(found.face);
        if (!face) {
            return false;
        }
        add_spline_face(found, *face, all_faces, place, model);
    } catch (const InputError&) {
        return false;
    } catch (const Standard_Failure&) {
        return false;
    }
    return true;
}

// As add_whole_face(), for a face whose edges in space are good. Returns false for others.
bool add_patches(const SolidFace& found, bool all_faces, const std::string& place, CadModel& model)
{
    try {
        std::optional<FacePatches> patches = patches_of(found.face, place);
        if (!patches) {
            return false;
        }
        for (Surface& patch : patches->surfaces) {
            if (all_faces || !found.solid || looks_up(patch, patches->outwards)) {
                model.faces.push_back(std::move(patch));
                model.outwards.push_back(found.solid ? patches->outwards : 0.0);
            }
        }
    } catch (const InputError&) {
        return false;
    }
    return true;
}

// True if a face of a solid has no upward normal; false where its edges run round it the wrong way.
bool looks_down(const SolidFace& found)
{
    if (!found.solid) {
        return false;
    }
    try {
        const TopoDS_Face face = converted(found.face);
        return area_of(face) >= 0 && !looks_up(surface_of(face), outwards_of(found));
    } catch (const Standard_Failure&) {
        return false;
    }
}

}  // namespace

// Wires that cross a seam or run round a pole may not close in (u, v), or leave the domain.
void add_face(const SolidFace& found, bool all_faces, const std::string& place, CadModel& model)
{
    try {
        add_whole_face(found, all_faces, place, model);
    } catch (const InputError&) {
        if (!add_unconverted(found, all_faces, place, model) &&
            !add_patches(found, all_faces, place, model)) {
            if (!looks_down(found)) {
                throw;
            }
            ++model.unread;
        }
    }
}

}  // namespace cusp::import
