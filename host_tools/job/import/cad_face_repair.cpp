// Edges as Open CASCADE converts them are judged at places along them.
#include "host_tools/job/import/cad_face_repair.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"
#include "opencascade/BRepAdaptor_Surface.hxx"
#include "opencascade/BRepGProp.hxx"
#include "opencascade/BRepTools.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/GProp_GProps.hxx"
#include "opencascade/Geom2d_Curve.hxx"
#include "opencascade/Geom_Curve.hxx"
#include "opencascade/Geom_Surface.hxx"
#include "opencascade/ShapeCustom.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"
#include "opencascade/gp_Vec.hxx"

namespace cusp::import {

namespace {

// mm: how far the edges' curves in (u, v) lie beside the edges at most.
double off_edges(const TopoDS_Face& face)
{
    constexpr int kLooks = 24;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    double most = 0;
    for (TopExp_Explorer at{face, TopAbs_EDGE}; at.More(); at.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
        double from = 0;
        double to = 0;
        double from_uv = 0;
        double to_uv = 0;
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, from, to);
        const Handle(Geom2d_Curve) trim = BRep_Tool::CurveOnSurface(edge, face, from_uv, to_uv);
        if (curve.IsNull() || trim.IsNull() || BRep_Tool::Degenerated(edge) ||
            !BRep_Tool::SameParameter(edge)) {
            continue;
        }
        for (int k = 0; k <= kLooks; ++k) {
            const double t = 1.0 * k / kLooks;
            const gp_Pnt2d uv = trim->Value(from_uv + t * (to_uv - from_uv));
            most = std::max(
                most,
                curve->Value(from + t * (to - from)).Distance(surface->Value(uv.X(), uv.Y())));
        }
    }
    return most;
}

// mm: how far the surfaces of two faces with the same (u, v) lie apart at most, in the bounds of the first.
double apart(const TopoDS_Face& face, const TopoDS_Face& other)
{
    constexpr int kLooks = 60;
    const Handle(Geom_Surface) a = BRep_Tool::Surface(face);
    const Handle(Geom_Surface) b = BRep_Tool::Surface(other);
    double u0 = 0;
    double u1 = 0;
    double v0 = 0;
    double v1 = 0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    double most = 0;
    for (int k = 0; k <= kLooks; ++k) {
        for (int m = 0; m <= kLooks; ++m) {
            const double u = u0 + (u1 - u0) * k / kLooks;
            const double v = v0 + (v1 - v0) * m / kLooks;
            most = std::max(most, a->Value(u, v).Distance(b->Value(u, v)));
        }
    }
    return most;
}

}  // namespace

double area_of(const TopoDS_Shape& shape)
{
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(shape, properties);
    return properties.Mass();
}

double allowed_off(const TopoDS_Face& face)
{
    constexpr double kLeast = 0.01;  // mm
    constexpr double kMost = 1.0;    // mm
    constexpr double kMore = 1.5;    // of the file's own tolerance
    return std::clamp(kMore * BRep_Tool::MaxTolerance(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE),
                      kLeast, kMost);
}

double allowed_gap(const TopoDS_Face& face)
{
    constexpr double kLeast = 0.01;  // mm
    constexpr double kMost = 0.1;    // mm
    const double tolerance = BRep_Tool::MaxTolerance(face.Oriented(TopAbs_FORWARD), TopAbs_VERTEX);
    return std::clamp(2 * tolerance, kLeast, kMost);
}

std::vector<FaceEdge> edges_in_space(const TopoDS_Face& face, bool backwards)
{
    std::vector<FaceEdge> edges;
    for (TopExp_Explorer at{face.Oriented(TopAbs_FORWARD), TopAbs_EDGE}; at.More(); at.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
        double from = 0;
        double to = 0;
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, from, to);
        if (curve.IsNull() || BRep_Tool::Degenerated(edge) || BRep_Tool::IsClosed(edge, face)) {
            continue;
        }
        if ((edge.Orientation() == TopAbs_REVERSED) != backwards) {
            std::swap(from, to);
        }
        edges.push_back(
            {[curve](double t) {
                 gp_Pnt point;
                 gp_Vec tangent;
                 curve->D1(t, point, tangent);
                 return PointAndTangent{vec_of(point), {tangent.X(), tangent.Y(), tangent.Z()}};
             },
             from, to});
    }
    return edges;
}

double check_conversion(const TopoDS_Face& original,
                        const TopoDS_Face& converted,
                        const std::string& place)
{
    const double off = off_edges(converted);
    const double allowed = allowed_off(original);
    if (off > allowed) {
        throw InputError(
            fmt::format("{}: Open CASCADE puts an edge {:.3g} mm beside its place, "
                        "allowed {:.3g}",
                        place, off, allowed));
    }
    return off;
}

std::optional<TopoDS_Face> spline_with_same_trims(const TopoDS_Face& face)
{
    constexpr double kSame = 1e-4;  // mm
    const GeomAbs_SurfaceType type = BRepAdaptor_Surface{face}.GetType();
    const TopoDS_Shape forward = face.Oriented(TopAbs_FORWARD);
    if (type == GeomAbs_BSplineSurface || type == GeomAbs_Plane) {
        return TopoDS::Face(forward);
    }
    if (type != GeomAbs_SurfaceOfExtrusion && type != GeomAbs_SurfaceOfRevolution) {
        return std::nullopt;
    }
    const TopoDS_Shape splines = ShapeCustom::ConvertToBSpline(forward, true, true, true, false);
    const TopExp_Explorer at{splines, TopAbs_FACE};
    if (!at.More()) {
        return std::nullopt;
    }
    const TopoDS_Face spline = TopoDS::Face(at.Current().Oriented(TopAbs_FORWARD));
    return apart(face, spline) <= kSame ? std::optional{spline} : std::nullopt;
}

}  // namespace cusp::import
