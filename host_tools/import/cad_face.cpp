// One face: its surface, its trims, and what is done where these do not fit together.
#include "host_tools/import/cad_face.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/import/cad_face_patches.hpp"
#include "host_tools/import/cad_face_repair.hpp"
#include "host_tools/import/nurbs_validity.hpp"
#include "host_tools/import/trim_cusps.hpp"
#include "host_tools/import/trim_loops.hpp"
#include "host_tools/import/trim_repair.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/job/loop_shape.hpp"
#include "host_tools/nurbs/knot_insertion.hpp"

#include "fmt/format.h"
#include "opencascade/BRepBuilderAPI_NurbsConvert.hxx"
#include "opencascade/BRepTools.hxx"
#include "opencascade/BRepTools_WireExplorer.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Geom2dConvert.hxx"
#include "opencascade/Geom2d_BSplineCurve.hxx"
#include "opencascade/Geom2d_TrimmedCurve.hxx"
#include "opencascade/GeomConvert.hxx"
#include "opencascade/Geom_BSplineSurface.hxx"
#include "opencascade/Geom_Plane.hxx"
#include "opencascade/Geom_RectangularTrimmedSurface.hxx"
#include "opencascade/Standard_Failure.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"
#include "opencascade/TopoDS_Wire.hxx"

namespace cusp::import {

using job::loop_polyline;
using job::signed_area;
using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

// Least z of a unit normal that counts as upward; a face with less everywhere is vertical.
constexpr double kLeastRise = 1e-6;

std::vector<double> list_of(const TColStd_Array1OfReal& knots)
{
    return {knots.begin(), knots.end()};
}

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

Curve trim_of(const TopoDS_Edge& edge, const TopoDS_Face& face, const std::string& place)
{
    double first = 0;
    double last = 0;
    const Handle(Geom2d_Curve) found = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (!found.IsNull() && !found->IsPeriodic()) {
        first = std::max(first, found->FirstParameter());  // an edge's range may be rounded up
        last = std::min(last, found->LastParameter());
    }
    if (found.IsNull() || !(first < last)) {
        throw InputError(place + ": an edge has no curve on the face");
    }
    const Handle(Geom2d_BSplineCurve) spline = Geom2dConvert::CurveToBSplineCurve(
        Handle(Geom2d_Curve)(new Geom2d_TrimmedCurve(found, first, last)));
    Curve curve;
    curve.degree = spline->Degree();
    curve.knots = list_of(spline->KnotSequence());
    for (int i = 1; i <= spline->NbPoles(); ++i) {
        curve.points.push_back({spline->Pole(i).X(), spline->Pole(i).Y(), 0});
        curve.weights.push_back(spline->Weight(i));
    }
    check_curve(curve, place);
    curve = clamped(curve);
    return edge.Orientation() == TopAbs_REVERSED ? reversed(curve) : curve;
}

// On a periodic surface the trims may be offset from the domain by whole periods.
void shift_into_domain(std::vector<Curve>& curves, const TopoDS_Face& face, const Surface& s)
{
    const Handle(Geom_Surface) whole = BRep_Tool::Surface(face);
    const auto shift = [&](double Vec3d::*axis, double period, double low, double high) {
        double least = curves.front().points.front().*axis;
        double most = least;
        for (const Curve& curve : curves) {
            for (const Vec3d& p : curve.points) {
                least = std::min(least, p.*axis);
                most = std::max(most, p.*axis);
            }
        }
        const double by = period * std::round((low + high - least - most) / (2 * period));
        for (Curve& curve : curves) {
            for (Vec3d& p : curve.points) {
                p.*axis += by;
            }
        }
    };
    if (!curves.empty() && whole->IsUPeriodic()) {
        shift(&Vec3d::x, whole->UPeriod(), s.u_begin(), s.u_end());
    }
    if (!curves.empty() && whole->IsVPeriodic()) {
        shift(&Vec3d::y, whole->VPeriod(), s.v_begin(), s.v_end());
    }
}

struct WireTrims {
    std::vector<Curve> curves;
    std::vector<bool> point_follows;  // for each curve: the next edge of the wire has no length
};

// The edges of a wire that have a length, in order. BRepTools_WireExplorer stops early where a seam
// meets a pole. Then each curve is followed by the one that starts nearest to its end in (u, v).
WireTrims trims_of(const TopoDS_Wire& wire, const TopoDS_Face& face, const std::string& place)
{
    WireTrims walked;
    bool begins_at_point = false;
    for (BRepTools_WireExplorer at{wire, face}; at.More(); at.Next()) {
        if (!BRep_Tool::Degenerated(at.Current())) {
            walked.curves.push_back(trim_of(at.Current(), face, place));
            walked.point_follows.push_back(false);
        } else if (walked.curves.empty()) {
            begins_at_point = true;
        } else {
            walked.point_follows.back() = true;
        }
    }
    if (begins_at_point && !walked.curves.empty()) {
        walked.point_follows.back() = true;
    }
    std::vector<Curve> all;
    for (TopExp_Explorer edges{wire.Oriented(TopAbs_FORWARD), TopAbs_EDGE}; edges.More();
         edges.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges.Current());
        if (!BRep_Tool::Degenerated(edge)) {
            all.push_back(trim_of(edge, face, place));
        }
    }
    if (walked.curves.size() >= all.size()) {
        return walked;
    }
    if (wire.Orientation() == TopAbs_REVERSED) {
        for (Curve& curve : all) {
            curve = reversed(curve);
        }
    }
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const Vec3d end = all[i].points.back();
        const auto next =
            std::min_element(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, all.end(),
                             [&](const Curve& a, const Curve& b) {
                                 return norm(a.points.front() - end) < norm(b.points.front() - end);
                             });
        std::swap(all[i + 1], *next);
    }
    return {all, std::vector<bool>(all.size(), false)};
}

// Whether the wire runs along seams and poles alone: the edge of the whole of a ball or ring, which
// trims nothing. Open CASCADE's curves of such seams are up to a tenth of a millimetre beside them.
bool bounds_all(const TopoDS_Wire& wire, const TopoDS_Face& face)
{
    bool any = false;
    for (TopExp_Explorer edges{wire, TopAbs_EDGE}; edges.More(); edges.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges.Current());
        if (!BRep_Tool::Degenerated(edge) && !BRep_Tool::IsClosed(edge, face)) {
            return false;
        }
        any = true;
    }
    return any;
}

// Adds how far edges of cusps were apart, mm, to the gaps of the model.
std::vector<std::vector<Curve>> trims_without_cusps(std::vector<std::vector<Curve>> loops,
                                                    double gap,
                                                    const Surface& surface,
                                                    const std::string& place,
                                                    CadModel& model)
{
    const auto grouped = [&] {
        std::vector<Curve> curves;
        for (const std::vector<Curve>& loop : loops) {
            curves.insert(curves.end(), loop.begin(), loop.end());
        }
        return trim_loops(curves, surface, place);
    };
    try {
        return grouped();
    } catch (const InputError&) {
        double widest = 0;
        for (std::vector<Curve>& loop : loops) {
            widest = std::max(widest, cut_cusps(loop, gap, surface));
        }
        if (widest <= 0) {
            throw;
        }
        std::vector<std::vector<Curve>> trims = grouped();
        model.gaps.add(widest);
        return trims;
    }
}

// gap  mm: how far the file lets ends that meet lie apart
void add_trims(const TopoDS_Face& face,
               double gap,
               const std::string& place,
               Surface& surface,
               CadModel& model)
{
    std::vector<std::vector<Curve>> loops;
    LoopRepair most;
    for (TopExp_Explorer wires{face, TopAbs_WIRE}; wires.More(); wires.Next()) {
        if (bounds_all(TopoDS::Wire(wires.Current()), face)) {
            continue;
        }
        auto [loop, point_follows] = trims_of(TopoDS::Wire(wires.Current()), face, place);
        shift_into_domain(loop, face, surface);
        if (loop.empty()) {
            continue;
        }
        tidy(loop, surface);
        const LoopRepair gaps = bridge_gaps(loop, point_follows, gap, surface);
        most = {std::max(most.longest_point, gaps.longest_point),
                std::max(most.widest_gap, gaps.widest_gap)};
        loops.push_back(std::move(loop));
    }
    surface.trims = trims_without_cusps(std::move(loops), gap, surface, place, model);
    model.points.add(most.longest_point);
    model.gaps.add(most.widest_gap);
    const double whole =
        (surface.u_end() - surface.u_begin()) * (surface.v_end() - surface.v_begin());
    constexpr double kWhole = 1e-9;
    if (surface.trims.size() == 1 &&
        std::abs(signed_area(loop_polyline(surface.trims[0], 1e-3 * std::sqrt(whole))) - whole) <=
            kWhole * whole) {
        surface.trims.clear();  // the boundary of the domain trims nothing
    }
}

// Whether any sampled normal of a solid's face points up. `outwards` is +1 if du x dv points out.
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
Surface trimmed_surface(
    const TopoDS_Face& face, double gap, Surface surface, const std::string& place, CadModel& model)
{
    check_surface(surface, place);
    surface = clamped(surface);
    add_trims(face, gap, place, surface, model);
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
    const double outwards = found.face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0;
    const bool is_below = found.solid && !looks_up(surface, outwards);
    if (is_below && !all_faces) {
        return;
    }
    try {
        const double beside = check_conversion(found.face, face, place);
        model.faces.push_back(
            trimmed_surface(face, allowed_gap(found.face), surface, place, model));
        model.beside.add(beside);
        model.outwards.push_back(found.solid ? outwards : 0.0);
    } catch (const InputError&) {
        if (!is_below) {
            throw;
        }
        ++model.unread;
    }
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

}  // namespace

// Wires that cross a seam or run round a pole may not close in (u, v), or leave the domain.
void add_face(const SolidFace& found, bool all_faces, const std::string& place, CadModel& model)
{
    try {
        add_whole_face(found, all_faces, place, model);
    } catch (const InputError&) {
        if (!add_unconverted(found, all_faces, place, model) &&
            !add_patches(found, all_faces, place, model)) {
            throw;
        }
    }
}

}  // namespace cusp::import
