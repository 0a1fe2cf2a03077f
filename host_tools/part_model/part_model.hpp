// The part: trimmed NURBS surfaces or a mesh, and the distance of a tool from it, exact and proved.
//
//     const PartModel part{surfaces};
//     const ToolDistance d = part.distance(tool, tip, 1.0);       // d.nearest.point where d < 1 mm
//     part.is_distance_at_least(tool, tip, 0.1);                  // quicker than asking how far
//     part.move_clearance(tool, a, b, 0.1, 1e-4);                 // lower bound along a move
//     const std::optional<double> z = part.drop_height(tool, 10, 5);  // drop cutter
//
// Surfaces are cut into Bezier cells on which the distance is convex; everything else is pruned by
// bounds from the control points.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/toolpath/tool.hpp"

namespace cusp::part_model {

class SurfaceCut;

// The place of the model that is nearest to a tool.
struct NearestPoint {
    Vec3d point;
    double u{};
    double v{};
    int surface{-1};  // number of the surface; -1 where nothing is nearer than the limit asked for
};

struct ToolDistance {
    double distance{};  // mm between tool and model; negative: depth of the cut, square to the tool
    NearestPoint nearest;
};

class BezierCell;

// A ball whose centre is straight over a place of a surface, along the upward normal.
struct CcPoint {
    int surface;
    double u;
    double v;
    Vec3d point;
    Vec3d normal;
    double distance;  // mm from the point to the centre
    // The piece of surface it lies in, and how much farther than the contact all but the
    // surroundings of that is known to be; null and negative: not known.
    mutable const BezierCell* cell{nullptr};
    mutable double margin{-1};

    Vec3d centre() const { return point + normal * distance; }
};

// Derivatives of that centre by u and by v. `p` is the surface there, second derivatives included.
std::pair<Vec3d, Vec3d> centre_slopes(const nurbs::SurfacePoint& p, Vec3d normal, double distance);

// The tool is the whole rotating body: its end as `Tool` describes it and a cylindrical shank
// above, so a surface that overhangs the tool is seen, too. Model and tool meet from any side: a
// tool below a surface is in contact with it.
//
// Not for use by two threads at once: cells are cut further when a query first needs it.
class PartModel {
public:
    // surfaces    valid (as the reader in host_tools/import checks them); trims are honoured
    // edge_error  mm: how far the polylines that stand for trimmed edges may be from the edges;
    //             distances to trimmed surfaces are low by at most this
    explicit PartModel(const std::vector<nurbs::Surface>& surfaces, double edge_error = 1e-4);

    // A mesh: its triangles as they are, whichever way they look. None may be without area.
    explicit PartModel(const std::vector<std::array<Vec3d, 3>>& triangles);
    ~PartModel();
    PartModel(PartModel&&) noexcept;
    PartModel& operator=(PartModel&&) noexcept;
    PartModel(const PartModel&) = delete;
    PartModel& operator=(const PartModel&) = delete;

    // tip    of the tool, its axis upright
    // limit  mm: distances beyond it may be inexact
    //
    // Returns the smaller of `limit` and the distance. A tool with a corner (ball, bull) that cuts
    // deeper than its corner radius, or any cut of a flat tool, gives -corner_radius.
    // Accuracy: never above the true value by more than 1e-9 mm; below it by at most 1e-7 mm plus
    // `edge_error` near trims (`PartModelDistance` tests).
    ToolDistance distance(const toolpath::Tool& tool, Vec3d tip, double limit) const;

    // The clearance where it is between `least` and `most`, low by up to `max_error`; `most` where
    // it is more; else anything up to `least`, which it does not exceed by more than `max_error`.
    // All in mm. With flat and bull-nose tools, far quicker than the exact one, and with far fewer
    // cells kept.
    double distance_within(
        const toolpath::Tool& tool, Vec3d tip, double least, double most, double max_error) const;

    // Whether the clearance is at least so much, mm; quicker than asking for it where it is not.
    bool is_distance_at_least(const toolpath::Tool& tool, Vec3d tip, double least) const;

    // A lower bound of the clearance all along the straight move from `a` to `b`, never above
    // `sufficient`, which ends the search early. `resolution` (mm) is how far below the truth the
    // bound may be: smaller takes longer.
    //
    // Proof: the square of the distance to any set, less the square of the way along a line, is
    // concave along the line, so two exact distances bound all between them.
    double move_clearance(
        const toolpath::Tool& tool, Vec3d a, Vec3d b, double sufficient, double resolution) const;

    CcPoint cc_point(int surface, double u, double v, double distance) const;

    // The contact of a ball whose centre is over (x, y) to 1e-10 mm, by Newton's method from a
    // place in the domain; none where that does not settle inside the domain.
    std::optional<CcPoint> cc_point_under(
        double x, double y, int surface, Vec2d near, double distance) const;

    // `upward_normal`, but where it is level, as on the rim of a half torus: the side that faces up
    // beside it. `p` is the surface at (u, v).
    Vec3d facing_up(int surface, double u, double v, const nurbs::SurfacePoint& p) const;

    // A lower bound of the clearance of a ball along the straight way of its centre between two
    // contacts, without a search for the nearest place; none where that proves less than
    // `sufficient`: near creases, in valleys hardly wider than the ball, beside other surfaces.
    // Proof: see `MoveClearanceBound`.
    std::optional<double> move_clearance_between_contacts(const CcPoint& a,
                                                          const CcPoint& b,
                                                          double radius,
                                                          double sufficient) const;

    // Least height of the tip at (x, y) from which the tool can be lifted out: exact drop of the
    // tool on the model, shank included. None where it meets nothing.
    // Accuracy: clearance at the result is in [-1e-8, 1e-6] mm.
    //
    // guess  of the answer, mm: a near one makes the drop several times faster, any other costs
    //        time only
    std::optional<double> drop_height(const toolpath::Tool& tool,
                                      double x,
                                      double y,
                                      std::optional<double> guess = std::nullopt) const;

    // The same with the place that the tool rests on, or one near it.
    struct DroppedCutter {
        double tip;
        NearestPoint place;
    };
    std::optional<DroppedCutter> drop_cutter(const toolpath::Tool& tool,
                                             double x,
                                             double y,
                                             std::optional<double> guess = std::nullopt) const;

    bool is_mesh() const;

    // A ball dropped at (x, y) on a mesh; none where it misses the mesh.
    struct DroppedBall {
        Vec3d centre;
        Vec3d point;   // that it rests on
        Vec3d normal;  // of the facet there, never downward
    };
    std::optional<DroppedBall> drop_ball(double x, double y, double radius) const;

    // The highest place of a mesh at (x, y). None beside the mesh; upright facets have no height.
    struct TopPoint {
        Vec3d point;
        Vec3d normal;
    };
    std::optional<TopPoint> height_at(double x, double y) const;

    // Of the control points.
    Vec3d box_low() const;
    Vec3d box_high() const;

    // Height of the highest place, what trims cut off not counted; as accurate as a drop.
    double highest() const;

    // Drops the cells that queries have cut so far: they are cut again where they are needed. For
    // long series of queries at new places, each of which would stay. No `CcPoint` from before and
    // no `SurfaceCut` may be used after.
    void forget_cells() const;
    // The same where they are many: between queries of any long series.
    void forget_many_cells() const;

    // Whether (u, v) lies in the trimmed domain of the surface.
    bool inside_trims(int surface, double u, double v) const;

    // Whether all of a rectangle of the domain is trimmed away.
    bool outside_trims(int surface, Vec2d low, Vec2d high) const;

    // mm: how far below the truth distances to trimmed surfaces may be near their edges.
    double edge_error() const;

    // Evaluation by the cells: as `derivatives_at`, several times faster.
    nurbs::SurfacePoint evaluate(int surface, double u, double v) const;
    // The same; second derivatives may be left out.
    nurbs::SurfacePoint tangents(int surface, double u, double v) const;

    // The surface over one u, for many places of v.
    SurfaceCut cut_at(int surface, double u) const;

    struct State;

private:
    std::unique_ptr<State> state_;
};

}  // namespace cusp::part_model
