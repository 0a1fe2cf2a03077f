// Open CASCADE divides faces and computes areas; what it makes of edges is judged at places along them.
#include "host_tools/import/cad_face_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/input_error/input_error.hpp"
#include "host_tools/job/loop_shape.hpp"

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
#include "opencascade/ShapeUpgrade_ShapeDivideAngle.hxx"
#include "opencascade/Standard_Failure.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"
#include "opencascade/gp_Vec.hxx"

namespace cusp::import {

namespace {

// Of an area: sums over a face with a seam are inexact.
constexpr double kSameArea = 1e-3;

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

Vec3d area_vector(const TopoDS_Face& face)
{
    constexpr int kChords = 256;
    Vec3d sum{};
    for (TopExp_Explorer at{face.Oriented(TopAbs_FORWARD), TopAbs_EDGE}; at.More(); at.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
        double from = 0;
        double to = 0;
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, from, to);
        if (curve.IsNull() || BRep_Tool::Degenerated(edge)) {
            continue;
        }
        const double sign = edge.Orientation() == TopAbs_REVERSED ? -0.5 : 0.5;
        Vec3d last = vec_of(curve->Value(from));
        for (int k = 1; k <= kChords; ++k) {
            const Vec3d next = vec_of(curve->Value(from + (to - from) * k / kChords));
            sum = sum + cross(last, next) * sign;
            last = next;
        }
    }
    return sum;
}

Vec3d area_vector(const nurbs::Surface& s)
{
    constexpr int kChords = 128;  // of a line in (u, v), which may be a whole circle
    constexpr double kLoop = 1e-4;
    const double size = std::max(s.u_end() - s.u_begin(), s.v_end() - s.v_begin());
    std::vector<std::vector<Vec2d>> loops;
    for (const auto& loop : s.trims) {
        loops.push_back(job::loop_polyline(loop, kLoop * size));
    }
    if (loops.empty()) {
        loops.push_back({{s.u_begin(), s.v_begin()},
                         {s.u_end(), s.v_begin()},
                         {s.u_end(), s.v_end()},
                         {s.u_begin(), s.v_end()}});
    }
    Vec3d sum{};
    for (std::vector<Vec2d>& loop : loops) {
        loop.push_back(loop.front());
        Vec3d last = derivatives_at(s, loop[0].x, loop[0].y).point;
        for (std::size_t i = 1; i < loop.size(); ++i) {
            for (int k = 1; k <= kChords; ++k) {
                const Vec2d at = loop[i - 1] + (loop[i] - loop[i - 1]) * (1.0 * k / kChords);
                const Vec3d next = derivatives_at(s, std::clamp(at.x, s.u_begin(), s.u_end()),
                                                  std::clamp(at.y, s.v_begin(), s.v_end()))
                                       .point;
                sum = sum + cross(last, next) * 0.5;
                last = next;
            }
        }
    }
    return sum;
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

std::vector<TopoDS_Face> pieces_of(const TopoDS_Face& face, double turn)
{
    std::vector<TopoDS_Face> out;
    try {
        ShapeUpgrade_ShapeDivideAngle divide{turn, face};
        if (!divide.Perform()) {
            return {};
        }
        for (TopExp_Explorer at{divide.Result(), TopAbs_FACE}; at.More(); at.Next()) {
            out.push_back(TopoDS::Face(at.Current()));
        }
        const double area = area_of(face);
        const bool same = std::abs(area_of(divide.Result()) - area) <= kSameArea * std::abs(area);
        return same ? out : std::vector<TopoDS_Face>{};
    } catch (const Standard_Failure&) {
        return {};
    }
}

}  // namespace cusp::import
