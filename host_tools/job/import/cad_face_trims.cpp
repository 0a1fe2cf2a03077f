// Trims of a face, and what is done where they do not bound one.
#include "host_tools/job/import/cad_face_trims.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"
#include "host_tools/job/import/trim_cusps.hpp"
#include "host_tools/job/import/trim_lobes.hpp"
#include "host_tools/job/import/trim_loops.hpp"
#include "host_tools/job/import/trim_repair.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "opencascade/BRepTools_WireExplorer.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Geom2dConvert.hxx"
#include "opencascade/Geom2d_BSplineCurve.hxx"
#include "opencascade/Geom2d_TrimmedCurve.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"
#include "opencascade/TopoDS_Wire.hxx"

namespace cusp::import {

using job::loop_polyline;
using job::signed_area;
using nurbs::Curve;
using nurbs::Surface;

namespace {

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

// True if the wire runs along seams and poles alone: the edge of the whole of a ball or ring, which
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

std::vector<std::vector<Curve>> grouped(const std::vector<std::vector<Curve>>& loops,
                                        const Surface& surface,
                                        const std::string& place)
{
    std::vector<Curve> curves;
    for (const std::vector<Curve>& loop : loops) {
        curves.insert(curves.end(), loop.begin(), loop.end());
    }
    return trim_loops(curves, surface, place);
}

// Trims of loops that cross themselves: first cusps are cut, then lobes. None where that does not help.
std::optional<std::vector<std::vector<Curve>>> uncrossed(std::vector<std::vector<Curve>> loops,
                                                         FaceTolerance allowed,
                                                         const Surface& surface,
                                                         CadModel& model)
{
    double cusp = 0;
    for (std::vector<Curve>& loop : loops) {
        cusp = std::max(cusp, cut_cusps(loop, allowed.gap, surface));
    }
    try {
        std::vector<std::vector<Curve>> trims = grouped(loops, surface, "");
        model.gaps.add(cusp);
        return trims;
    } catch (const InputError&) {
    }
    std::vector<std::vector<Curve>> cut;
    double lobe = 0;
    for (const std::vector<Curve>& loop : loops) {
        const std::optional<LobeCut> found = cut_lobes(loop, allowed.off, surface);
        if (found) {
            lobe = std::max(lobe, found->widest);
            cut.insert(cut.end(), found->loops.begin(), found->loops.end());
        } else {
            cut.push_back(loop);
        }
    }
    try {
        std::vector<std::vector<Curve>> trims = grouped(cut, surface, "");
        model.gaps.add(cusp);
        model.lobes.add(lobe);
        return trims;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

std::vector<std::vector<Curve>> mended_trims(const std::vector<std::vector<Curve>>& loops,
                                             FaceTolerance allowed,
                                             const Surface& surface,
                                             const std::string& place,
                                             CadModel& model)
{
    try {
        return grouped(loops, surface, place);
    } catch (const InputError&) {
        auto trims = uncrossed(loops, allowed, surface, model);
        if (!trims) {
            throw;
        }
        return *std::move(trims);
    }
}

// The loops of all wires that trim something.
std::vector<WireTrims> all_trims_of(const TopoDS_Face& face,
                                    const Surface& surface,
                                    const std::string& place)
{
    std::vector<WireTrims> found;
    for (TopExp_Explorer wires{face, TopAbs_WIRE}; wires.More(); wires.Next()) {
        if (!bounds_all(TopoDS::Wire(wires.Current()), face)) {
            WireTrims trims = trims_of(TopoDS::Wire(wires.Current()), face, place);
            shift_into_domain(trims.curves, face, surface);
            if (!trims.curves.empty()) {
                found.push_back(std::move(trims));
            }
        }
    }
    return found;
}

}  // namespace

void add_trims(const TopoDS_Face& face,
               FaceTolerance allowed,
               const std::string& place,
               Surface& surface,
               CadModel& model)
{
    std::vector<std::vector<Curve>> loops;
    LoopRepair most;
    for (auto& [loop, point_follows] : all_trims_of(face, surface, place)) {
        tidy(loop, surface);
        const LoopRepair gaps = bridge_gaps(loop, point_follows, allowed.gap, surface);
        most = {std::max(most.longest_point, gaps.longest_point),
                std::max(most.widest_gap, gaps.widest_gap)};
        loops.push_back(std::move(loop));
    }
    surface.trims = mended_trims(loops, allowed, surface, place, model);
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

std::optional<Surface> extended_to_trims(const TopoDS_Face& face,
                                         const std::string& place,
                                         const Surface& surface)
{
    constexpr double kMost = 0.2;    // of the domain, at an end
    constexpr double kChord = 1e-6;  // of the domain's longer side
    const Handle(Geom_Surface) whole = BRep_Tool::Surface(face);
    if (whole->IsUPeriodic() || whole->IsVPeriodic()) {
        return std::nullopt;
    }
    const Vec2d begin{surface.u_begin(), surface.v_begin()};
    const Vec2d end{surface.u_end(), surface.v_end()};
    const Vec2d size = end - begin;
    Vec2d low = begin;
    Vec2d high = end;
    for (const WireTrims& trims : all_trims_of(face, surface, place)) {
        for (const Vec2d p : loop_polyline(trims.curves, kChord * std::max(size.x, size.y))) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }
    const auto most = [&](Vec2d more) {
        return std::max(more.x / size.x, more.y / size.y);
    };
    const double beyond = std::max(most(begin - low), most(high - end));
    if (!(beyond > 0 && beyond <= kMost)) {
        return std::nullopt;
    }
    return extended(surface, low.x, high.x, low.y, high.y);
}

}  // namespace cusp::import
