// Edges are halved until straight moves are proved to follow curve and surface: curves within the chord
// tolerance, surfaces within half the floor tolerance. The other half is for the flank beside the curve.
#include "host_tools/cam/prismatic/engrave_floor.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/drop_cutter/line_heights.hpp"
#include "host_tools/geometry/drop_cutter/surface_bounds.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using drop_cutter::DropCutter;
using drop_cutter::LineHeights;
using drop_cutter::SurfaceBounds;
using job::Job;
using job::Operation;
using offset::Edge;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kLongest = 4.0;    // mm, of a move
constexpr double kShortest = 1e-3;  // mm: at a vertical step of the floor no shorter move is tried

class FloorChain {
public:
    FloorChain(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          tip_{toolpath::tip_of(operation.tool)},
          allowed_{operation.tolerance.floor / 2},
          accuracy_{operation.tolerance.floor / 16},
          cutter_{operation.part.floor, tip_, accuracy_},
          bounds_{operation.part.floor}
    {
    }

    // Places of the tip on the floor.
    std::vector<Vec3d> along(const std::vector<Edge>& edges)
    {
        points_ = {on_floor(edges.front().start)};
        for (const Edge& edge : edges) {
            const int parts =
                std::max(1, static_cast<int>(std::ceil(offset::length(edge) / kLongest)));
            for (int i = 1; i <= parts; ++i) {
                const double end = static_cast<double>(i) / parts;
                add(edge, static_cast<double>(i - 1) / parts, end, on_floor(point_on(edge, end)));
            }
        }
        return std::move(points_);
    }

private:
    Vec3d on_floor(Vec2d at) const
    {
        const auto found = cutter_.drop(at);
        if (!found) {
            throw InputError(fmt::format("{}there is no floor under x {:.3f} y {:.3f} mm",
                                         operation_text(job_, operation_), at.x, at.y));
        }
        return {at.x, at.y, found->z};
    }

    // From the last point to `end`.
    void add(const Edge& edge, double from, double to, Vec3d end)
    {
        const Vec3d begin = points_.back();
        const double share = (from + to) / 2;
        const Vec2d chord = 0.5 * (in_plan(begin) + in_plan(end));
        const double size = norm(in_plan(end) - in_plan(begin));
        const bool on_curve = norm(point_on(edge, share) - chord) <= chord_tolerance(operation_);
        if (size < kShortest || (on_curve && follows(begin, end))) {
            points_.push_back(end);
            return;
        }
        add(edge, from, share, on_floor(point_on(edge, share)));
        add(edge, share, to, end);
    }

    // True if the straight line is proved to keep the tolerance.
    bool follows(Vec3d begin, Vec3d end) const
    {
        const Vec2d from = in_plan(begin);
        const Vec2d half = 0.5 * (in_plan(end) - from);
        const double z = on_floor(from + half).z;
        const Vec2d reach{std::abs(half.x) + tip_.radius, std::abs(half.y) + tip_.radius};
        if (std::abs(z - 0.5 * (begin.z + end.z)) > allowed_) {
            return false;
        }
        LineHeights h{{0, begin.z, z, end.z, 0}, norm(half), accuracy_};
        const SurfaceBounds::Bounds wide = bounds_.over(from + half - reach - half_box(half),
                                                        from + half + reach + half_box(half));
        const auto before = cutter_.drop(from - half);
        const auto beyond = cutter_.drop(from + 3.0 * half);
        if (!wide.edges && before && beyond && wide.down < kInfinite) {
            h.z[0] = before->z;
            h.z[4] = beyond->z;
            return off_by_curvature(h, wide.down) <= allowed_;
        }
        const SurfaceBounds::Bounds near = bounds_.over(from + half - reach, from + half + reach);
        return near.slope < kInfinite && off_by_slope(h, near.slope) <= allowed_;
    }

    static Vec2d half_box(Vec2d half) { return {std::abs(half.x), std::abs(half.y)}; }

    const Job& job_;
    const Operation& operation_;
    toolpath::Tool tip_;
    double allowed_;   // mm, of heights
    double accuracy_;  // mm
    DropCutter cutter_;
    SurfaceBounds bounds_;
    std::vector<Vec3d> points_;
};

}  // namespace

std::vector<PlannedOperation> engraved_on_floor(const Job& job,
                                                const Operation& operation,
                                                const std::vector<std::vector<Edge>>& chains)
{
    const double depth = operation.prismatic->depth;
    PlannedOperation planned =
        begun(job, operation,
              fmt::format("{}, {:g} mm below the floor", counted(chains.size(), "curve"), depth));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    FloorChain floor{job, operation};
    // below a top of 0
    std::vector<double> levels = cut_levels(job, operation, depth);
    for (double& level : levels) {
        level -= operation.prismatic->top;
    }
    for (const std::vector<Edge>& edges : chains) {
        const std::vector<Vec3d> points = floor.along(edges);
        for (std::size_t pass = 0; pass < levels.size(); ++pass) {
            const Vec3d start = points.front();
            if (pass == 0 || norm(in_plan(writer.at()) - in_plan(start)) > kShortest) {
                // what is above the floor may not be cut yet
                writer.approach(in_plan(start), rapid_end(job, job.stock_top));
            }
            writer.line(MoveKind::kPlunge, {start.x, start.y, start.z + levels[pass]});
            for (std::size_t k = 1; k < points.size(); ++k) {
                const bool down = points[k].z < points[k - 1].z;
                writer.line(down ? MoveKind::kPlungingCut : MoveKind::kCut,
                            {points[k].x, points[k].y, points[k].z + levels[pass]});
            }
        }
    }
    writer.retract();
    count_moves(writer, static_cast<int>(chains.size() * levels.size()),
                static_cast<int>(levels.size()), planned);
    planned.stats.counts.emplace_back("curves", static_cast<double>(chains.size()));
    // half by follows(), half by the chord of a curve on the flank
    planned.stats.gouge_bound_mm = operation.tolerance.floor;
    return {planned};
}

}  // namespace cusp::prismatic
