// How far a tool keeps from a model of trimmed NURBS surfaces, exactly and with a proof: the
// surfaces are cut into Bezier cells on which the distance is convex, and everything else is pruned
// by bounds from the control points.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::host {

class SurfaceCut;

// The place of the model that is nearest to a tool.
struct NearestPlace {
    Vec3d point;
    double u{};
    double v{};
    int surface{-1};  // number of the surface; -1 where nothing is nearer than the limit asked for
};

struct Clearance {
    double distance{};  // mm between tool and model; negative: depth of the cut, square to the tool
    NearestPlace nearest;
};

class BezierCell;

// A ball whose centre is straight over a place of a surface, along the upward normal.
struct Contact {
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
std::pair<Vec3d, Vec3d> centre_slopes(const SurfacePoint& p, Vec3d normal, double distance);

// The tool is the whole rotating body: its end as `Tool` describes it and a cylindrical shank
// above, so a surface that overhangs the tool is seen, too. Model and tool meet from any side: a
// tool below a surface is in contact with it.
//
// Not for use by two threads at once: cells are cut further when a query first needs it.
class SurfaceModel {
public:
    // surfaces    valid (as the reader in host_tools/import checks them); trims are honoured
    // edge_error  mm: how far the polylines that stand for trimmed edges may be from the edges;
    //             distances to trimmed surfaces are low by at most this
    explicit SurfaceModel(const std::vector<Surface>& surfaces, double edge_error = 1e-4);

    // A mesh: its triangles as they are, whichever way they look. None may be without area.
    explicit SurfaceModel(const std::vector<std::array<Vec3d, 3>>& triangles);
    ~SurfaceModel();
    SurfaceModel(SurfaceModel&&) noexcept;
    SurfaceModel& operator=(SurfaceModel&&) noexcept;
    SurfaceModel(const SurfaceModel&) = delete;
    SurfaceModel& operator=(const SurfaceModel&) = delete;

    // tip    of the tool, its axis upright
    // limit  mm: distances from here on are not told apart
    //
    // Returns the smaller of `limit` and the distance. A tool with a corner (ball, bull) that cuts
    // deeper than its corner radius, or any cut of a flat tool, gives -corner_radius.
    // Accuracy: never above the true value by more than 1e-9 mm; below it by at most 1e-7 mm plus
    // `edge_error` near trims (`SurfaceModelDistance` tests).
    Clearance clearance(const Tool& tool, Vec3d tip, double limit) const;

    // The clearance where it is between `least` and `most`, low by up to `slack`; `most` where it
    // is more; else anything up to `least`, which it does not exceed by more than `slack`. All in
    // mm. With flat and bull-nose tools, far quicker than the exact one, and with far fewer cells
    // kept.
    double clearance_within(
        const Tool& tool, Vec3d tip, double least, double most, double slack) const;

    // Whether the clearance is at least so much, mm; quicker than asking for it where it is not.
    bool keeps_clear(const Tool& tool, Vec3d tip, double least) const;

    // A lower bound of the clearance all along the straight move from `a` to `b`, never above
    // `enough`, which ends the search early. `resolution` (mm) is how far below the truth the
    // bound may be: smaller takes longer.
    //
    // Proof: the square of the distance to any set, less the square of the way along a line, is
    // concave along the line, so two exact distances bound all between them.
    double clearance_along(
        const Tool& tool, Vec3d a, Vec3d b, double enough, double resolution) const;

    Contact contact(int surface, double u, double v, double distance) const;

    // The contact of a ball whose centre is over (x, y) to 1e-10 mm, by Newton's method from a
    // place in the domain; none where that does not settle inside the domain.
    std::optional<Contact> contact_under(
        double x, double y, int surface, Vec2d near, double distance) const;

    // `upward_normal`, but where it is level, as on the rim of a half torus: the side that faces up
    // beside it. `p` is the surface at (u, v).
    Vec3d facing_up(int surface, double u, double v, const SurfacePoint& p) const;

    // A lower bound of the clearance of a ball along the straight way of its centre between two
    // contacts, without a search for the nearest place; none where that proves less than `enough`:
    // near creases, in valleys hardly wider than the ball, beside other surfaces.
    // Proof: see `RollingBall`.
    std::optional<double> clearance_between(const Contact& a,
                                            const Contact& b,
                                            double radius,
                                            double enough) const;

    // Least height of the tip at (x, y) from which the tool can be lifted out: exact drop of the
    // tool on the model, shank included. None where it meets nothing.
    // Accuracy: clearance at the result is in [-1e-8, 1e-6] mm.
    //
    // guess  of the answer, mm: a near one makes the drop several times faster, any other costs
    //        time only
    std::optional<double> drop(const Tool& tool,
                               double x,
                               double y,
                               std::optional<double> guess = std::nullopt) const;

    // The same with the place that the tool rests on, or one near it.
    struct Rest {
        double tip;
        NearestPlace place;
    };
    std::optional<Rest> rest(const Tool& tool,
                             double x,
                             double y,
                             std::optional<double> guess = std::nullopt) const;

    bool is_mesh() const;

    // A ball let down at (x, y) on a mesh; none where it misses the mesh.
    struct MeshRest {
        Vec3d centre;
        Vec3d point;   // that it rests on
        Vec3d normal;  // of the facet there, never downward
    };
    std::optional<MeshRest> rest_on_mesh(double x, double y, double radius) const;

    // The highest place of a mesh at (x, y). None beside the mesh; upright facets have no height.
    struct MeshTop {
        Vec3d point;
        Vec3d normal;
    };
    std::optional<MeshTop> top_of_mesh(double x, double y) const;

    // Of the control points.
    Vec3d box_low() const;
    Vec3d box_high() const;

    // Height of the highest place, what trims cut off not counted; as accurate as a drop.
    double highest() const;

    // Drops the cells that queries have cut so far: they are cut again where they are needed. For
    // long series of queries at new places, each of which would stay. No `Contact` from before and
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
    SurfacePoint evaluate(int surface, double u, double v) const;
    // The same; second derivatives may be left out.
    SurfacePoint tangents(int surface, double u, double v) const;

    // The surface over one u, for many places of v.
    SurfaceCut cut_at(int surface, double u) const;

    struct State;

private:
    std::unique_ptr<State> state_;
};

}  // namespace cusp::host
