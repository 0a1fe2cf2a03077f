// The part: trimmed NURBS surfaces or a mesh, and the distance of a tool from it, exact and proved.
//
//     const PartModel part{surfaces};
//     const ToolDistance d = part.distance(tool, tip, 1.0);           // d.nearest: where d < 1 mm
//     part.is_distance_at_least(tool, tip, 0.1);                      // quicker than distance()
//     part.move_clearance(tool, a, b, 0.1, 1e-4);                     // lower bound along a move
//     const std::optional<double> z = part.drop_height(tool, 10, 5);  // drop cutter
//
// Method: branch and bound. Surfaces are divided into Bezier cells until the distance is convex on
// a cell. Bounds from the control points exclude all other cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::part_model {

struct Facet;
class SurfaceCut;

// The point of the model nearest to a tool.
struct NearestPoint {
    Vec3d point;
    double u{};
    double v{};
    int surface{-1};  // number of the surface; -1 where nothing is nearer than the limit
};

struct ToolDistance {
    double distance{};  // mm between tool and model; negative: depth of the gouge, along its normal
    NearestPoint nearest;
};

// Accuracy of distance_within(), all in mm.
struct DistanceOptions {
    double least;  // distances below this may be inexact, but do not exceed it by `max_error`
    double max_distance;  // greater distances are returned as this
    double max_error;     // how much too low distances between `least` and `max_distance` may be
};

// A ball whose centre is above a point of a surface, along the upward normal.
struct CcPoint {
    int surface;
    double u;
    double v;
    Vec3d point;
    Vec3d normal;
    double distance;  // mm from the point to the centre

    Vec3d centre() const { return point + normal * distance; }
};

// Derivatives of that centre by u and by v. `p` is the surface there, second derivatives included.
std::pair<Vec3d, Vec3d> centre_slopes(const nurbs::SurfacePoint& p, Vec3d normal, double distance);

// The tool is the whole rotating body: its end as `Tool` describes it (over surfaces a cone counts as
// the cylinder round it) and a cylindrical shank above, so surfaces that overhang the tool count. Model and tool meet from any side: a tool below
// a surface is in contact with it.
//
// For queries by several threads at once, within SharedQueries. Queries keep the halves of cells
// and start from the previous result of the thread, so results may differ in the last bits. After
// forget_queries() they depend only on later queries of the thread.
class PartModel {
public:
    // surfaces    valid (as the reader in host_tools/job/import checks them); trims are honoured
    // edge_error  mm: maximum distance between trimmed edges and the polylines for them; distances
    //             to trimmed surfaces are too low by at most this
    explicit PartModel(const std::vector<nurbs::Surface>& surfaces, double edge_error = 1e-4);

    // A mesh of triangles in either orientation. Each has an area > 0.
    explicit PartModel(const std::vector<std::array<Vec3d, 3>>& triangles);
    ~PartModel();
    PartModel(PartModel&&) noexcept;
    PartModel& operator=(PartModel&&) noexcept;
    PartModel(const PartModel&) = delete;
    PartModel& operator=(const PartModel&) = delete;

    // The smaller of `limit` and the distance, with the nearest point. A gouge deeper than the
    // corner radius, and any gouge of a flat tool, gives -corner_radius.
    //
    // tip    of the tool, its axis vertical
    // limit  mm: the search is limited to points nearer than this
    //
    // Accuracy: too high by at most 1e-9 mm; too low by at most 1e-7 mm, and `edge_error` near
    // trims (`PartModelDistance` tests).
    ToolDistance distance(const toolpath::Tool& tool, Vec3d tip, double limit) const;

    // The distance as accurate as the options require. With flat and bull-nose tools this is far
    // quicker than distance() and keeps far fewer cells.
    double distance_within(const toolpath::Tool& tool,
                           Vec3d tip,
                           const DistanceOptions& options) const;

    // True if the distance is at least `least` (mm); quicker than distance() where it is not.
    bool is_distance_at_least(const toolpath::Tool& tool, Vec3d tip, double least) const;

    // A lower bound of the clearance along the straight move from tip `a` to tip `b`, mm.
    //
    // sufficient  mm: the search ends once the bound reaches this, which it never exceeds
    // resolution  mm: how much too low the bound may be; smaller takes longer
    //
    // A tool without a corner radius has no depth: its clearance is proved where `sufficient` > 0.
    //
    // Proof over surfaces: the squared distance to any set, less the squared arc length along a line, is
    // concave along the line. Thus two exact distances bound all distances between them. Over a mesh:
    // see facet_move.hpp.
    double move_clearance(
        const toolpath::Tool& tool, Vec3d a, Vec3d b, double sufficient, double resolution) const;

    CcPoint cc_point(int surface, double u, double v, double distance) const;

    // The contact of a ball whose centre is over (x, y) to 1e-10 mm, by Newton's method from the
    // parameters `near`; none where that does not converge inside the domain.
    std::optional<CcPoint> cc_point_under(
        double x, double y, int surface, Vec2d near, double distance) const;

    // The upward normal. If it is horizontal, as on the rim of a half torus, the side that faces
    // up at neighbouring points decides. `p` is the surface at (u, v).
    Vec3d facing_up(int surface, double u, double v, const nurbs::SurfacePoint& p) const;

    // A lower bound of the clearance of a ball whose centre moves straight between two contacts,
    // without a search for the nearest point. None where it proves less than `sufficient`: near
    // creases, in valleys hardly wider than the ball, beside other surfaces. Quickest where moves
    // share a contact. Proof: see `MoveClearanceBound`.
    std::optional<double> move_clearance_between_contacts(const CcPoint& a,
                                                          const CcPoint& b,
                                                          double radius,
                                                          double sufficient) const;

    // Drop cutter: the lowest tip at (x, y) from which the tool, shank included, can be lifted out
    // of the model. None where the tool misses the model.
    // Accuracy: the clearance at the result is in [-1e-8, 1e-6] mm.
    //
    // guess  of the result, mm: a near one makes the drop several times faster, any other one
    //        slower
    std::optional<double> drop_height(const toolpath::Tool& tool,
                                      double x,
                                      double y,
                                      std::optional<double> guess = std::nullopt) const;

    // As drop_height(), with the point that the tool rests on, or one near it.
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
        Vec3d point;         // the contact
        Vec3d normal;        // of the facet there, never downward
        const Facet* facet;  // of this model
    };
    std::optional<DroppedBall> drop_ball(double x, double y, double radius) const;

    // Any tool dropped at (x, y) on a mesh; none where it misses the mesh.
    struct DroppedTool {
        Vec3d tip;
        Vec3d point;   // the contact
        Vec3d normal;  // of the facet there, never downward
        Vec3d lean;    // unit, from the contact into the tool; 0 for a tool without a corner radius
    };
    std::optional<DroppedTool> drop_tool(const toolpath::Tool& tool, double x, double y) const;

    // The block of a tool at three tips, and so at all tips between them, by a mesh: a facet nearer than
    // `least` (mm) to all of them blocks it, since a facet is convex.
    //
    // kFree: nothing is so near to the tool in the middle of the tips.
    enum class Blocked : std::uint8_t { kFree, kByOneFacet, kHere };
    Blocked blocked(const toolpath::Tool& tool,
                    const std::array<Vec3d, 3>& tips,
                    double least) const;

    // The highest point of a mesh at (x, y). None beside the mesh; vertical facets have no height.
    struct TopPoint {
        Vec3d point;
        Vec3d normal;
    };
    std::optional<TopPoint> height_at(double x, double y) const;

    // The box of the control points, or of the mesh.
    Vec3d box_low() const;
    Vec3d box_high() const;

    // z of the highest point inside the trims; as accurate as a drop.
    double highest() const;

    // Releases the halves of cells that queries have made; later queries make them again. Only while
    // no other thread queries. Bounds the memory of long series of queries at new points. Invalidates every `SurfaceCut`.
    void forget_cells() const;
    // forget_cells() if there are many and no SharedQueries: to be called between queries of any long
    // series.
    void forget_many_cells() const;
    // Number of halves kept now; some 1 kB each.
    std::size_t kept_cells() const;
    // Calls forget_many_cells(). While one lives, several threads may query, and that does nothing.
    class SharedQueries {
    public:
        explicit SharedQueries(const PartModel& model);
        ~SharedQueries();
        SharedQueries(const SharedQueries&) = delete;
        SharedQueries& operator=(const SharedQueries&) = delete;

        // One part of a loop on several threads, begun before its queries. Answers do not depend on
        // queries before. If many cells are kept it waits until all parts under way have ended, and
        // releases them: a loop keeps no more than a part of each thread needs.
        class Part {
        public:
            explicit Part(const PartModel& model);
            ~Part();
            Part(const Part&) = delete;
            Part& operator=(const Part&) = delete;

            // Ends this part and begins the next: call it between queries of a part that may be
            // long, at places that do not depend on the threads.
            void next() const;

        private:
            void begin() const;
            const PartModel& model_;
        };

    private:
        const PartModel& model_;
    };
    // Forgets what the last queries of this thread found; quick. To be called before each part of a
    // parallel loop, and after the loop.
    void forget_queries() const;

    // True if (u, v) lies inside the trims of the surface.
    bool inside_trims(int surface, double u, double v) const;

    // True if a whole rectangle of the domain is trimmed away.
    bool outside_trims(int surface, Vec2d low, Vec2d high) const;

    // A place inside the trims, in a rectangle of the domain that an edge cuts; none found in others.
    std::optional<TrimRegion::Beside> beside_trims(int surface, Vec2d low, Vec2d high) const;

    // mm: how much too low distances near trimmed edges may be.
    double edge_error() const;

    // derivatives_at() by the cells, several times faster.
    nurbs::SurfacePoint evaluate(int surface, double u, double v) const;
    // As evaluate(), but second derivatives may be left zero.
    nurbs::SurfacePoint tangents(int surface, double u, double v) const;

    // The surface at one u, for queries at many v.
    SurfaceCut cut_at(int surface, double u) const;

    struct State;

private:
    std::unique_ptr<State> state_;
};

}  // namespace cusp::part_model
