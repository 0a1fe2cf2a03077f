// Drop cutter: the lowest position of a tool over surfaces (its CL point), and the clearance of a
// straight move.
//
//     const DropCutter cutter{surfaces, tool, 0.001};
//     if (const auto cl = cutter.drop({10.0, 5.0})) {        // cl->z: at most 0.001 mm too high
//         const Vec2d cc = cutter.cc_place({10.0, 5.0}, *cl);  // in plan: where the tool touches
//         const double gap = cutter.move_clearance({10.0, 5.0, cl->z}, {12.0, 5.0, cl->z});
//     }                                                      // gap < 0: depth of a gouge
//
// Method: branch and bound. A piece of a surface lies in the convex hull of its control points, so
// it lies below a plane through the highest of them. Dropping the tool on these planes bounds its
// true height from above. Pieces near the contact are halved until the bound is as accurate as
// requested. Nothing is iterated that could fail to converge. The tool rests on the highest piece,
// so several surfaces, walls and narrow valleys need no case of their own. Pieces across the edge
// of a trimmed surface end at a line along that edge. They are halved until they extend beyond the
// edge by no more than the accuracy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"

namespace cusp::drop_cutter {

// Not for use by two threads at once, const members included: queries halve pieces and keep the
// halves. Threads that work in parallel take one each.
class DropCutter {
public:
    // surfaces  valid, as the readers of host_tools/job/import check them; trims are honoured
    // accuracy  mm, > 0: how much too high an answer may be; answers are never too low
    DropCutter(const std::vector<nurbs::Surface>& surfaces,
               const toolpath::Tool& tool,
               double accuracy);
    ~DropCutter();
    DropCutter(DropCutter&&) noexcept;
    DropCutter& operator=(DropCutter&&) noexcept;
    DropCutter(const DropCutter&) = delete;
    DropCutter& operator=(const DropCutter&) = delete;

    // A cutter for another thread, as this one was before its queries and check_edge_gouges(). It
    // shares the surfaces and their trims; several threads may call this while none queries.
    DropCutter for_thread() const;

    struct ClPoint {
        double z;             // mm, of the tip
        Vec2d slope;          // gradient of z: that of the surface at the cutter contact
        std::uint32_t piece;  // for cc_place(), until the next query
    };
    // The lowest position of the tip over (x, y); none where no surface lies under the tool. It is
    // at most `accuracy` above the true one on smooth surfaces, or `max_error` (mm) where that is
    // more. At edges a ball rests no higher than one whose radius is ten times that larger.
    std::optional<ClPoint> drop(Vec2d at, double max_error = 0.0) const;

    // The z of drop() as a lower bound of the tip: -kUnbounded, no bound, where no surface lies under
    // the tool.
    double tip_height(Vec2d at, double max_error = 0.0) const;

    // The place in plan where the tool over `at` touches the surface, as drop() found it.
    Vec2d cc_place(Vec2d at, const ClPoint& cl) const;

    // From this call on, move_clearance() measures gouges of a ball into rims and creases along the
    // normal of the face that ends there, as tolerances do; see `EdgeGougeCheck`.
    //
    // allowed  mm, > 0: how deep moves may cut
    void check_edge_gouges(double allowed);

    // Lower bound of the clearance between the tool, moved straight from tip a to tip b, and the
    // surfaces with everything below them. 0: the move is clear. Negative (mm): how deep it may
    // cut, along the normal for a ball, along the axis for other tools. margin (mm, >= 0): how far
    // beside the straight line the tool may be.
    double move_clearance(Vec3d a, Vec3d b, double margin = 0.0) const;

    // True if the untrimmed part of some surface lies straight above or below (x, y), to a tenth of
    // the tool radius.
    bool covers(Vec2d at) const;

    // The surface at the cutter contact.
    struct CcPoint {
        double z;  // mm, of the tip
        nurbs::SurfacePoint surface;
        Vec3d normal;
    };
    // The contact as accurate as the thin piece that the tool rests on; none where no surface lies
    // under the tool, or the surface is vertical or singular there.
    std::optional<CcPoint> cc_point(Vec2d at, double max_error) const;
    // The exact contact on that piece, or none as above.
    std::optional<CcPoint> exact_cc_point(Vec2d at, double max_error) const;

    // The section through the surface at a contact, in a plan direction (unit vector) across a
    // path.
    struct Section {
        double curvature;    // 1/mm: normal curvature in the direction; > 0 where convex
        double slope;        // of the floor in the direction, across the path
        double slope_along;  // of the floor to the left of the direction, along the path
    };
    static Section section(const CcPoint& contact, Vec2d direction);

    const toolpath::Tool& tool() const { return tool_; }
    // Number of pieces of the surfaces that queries have halved, repeated ones included: a measure
    // of their cost.
    std::size_t halvings() const;
    // The memory of the halves that are kept. A query that finds more than about 20 MB forgets them.
    std::size_t kept_bytes() const;
    // mm: bounds of z over all surfaces, from their control points.
    double lowest() const;
    double highest() const;

private:
    struct State;
    DropCutter(const toolpath::Tool& tool, std::unique_ptr<State> state);
    toolpath::Tool tool_;
    std::unique_ptr<State> state_;
};

}  // namespace cusp::drop_cutter
