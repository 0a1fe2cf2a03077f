// Edges are halved until straight moves follow curve and surface.
#include "host_tools/prismatic/engrave_floor.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/prismatic/contour_run.hpp"
#include "host_tools/prismatic/cut_levels.hpp"
#include "host_tools/toolpath/tool_tip.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using drop_cutter::DropCutter;
using job::Job;
using job::Operation;
using offset::Edge;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kLongest = 0.5;    // mm between places that are looked at
constexpr double kShortest = 0.01;  // mm, of a move

class FloorChain {
public:
    FloorChain(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          cutter_{operation.floor, toolpath::tip_of(operation.tool), operation.floor_tolerance / 4}
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
        const Vec3d middle = on_floor(point_on(edge, share));
        const Vec3d chord = 0.5 * (begin + end);
        const bool follows = std::abs(middle.z - chord.z) <= operation_.floor_tolerance / 4 &&
                             norm(in_plan(middle) - in_plan(chord)) <= chord_tolerance(operation_);
        if (follows || norm(end - begin) < kShortest) {
            points_.push_back(end);
            return;
        }
        add(edge, from, share, middle);
        add(edge, share, to, end);
    }

    const Job& job_;
    const Operation& operation_;
    DropCutter cutter_;
    std::vector<Vec3d> points_;
};

// Leaves out places on a straight line between others, within the tolerance.
std::vector<Vec3d> thinned(const std::vector<Vec3d>& points, double tolerance)
{
    constexpr std::size_t kMost = 200;
    std::vector<Vec3d> out{points.front()};
    std::size_t begin = 0;
    for (std::size_t end = 2; end < points.size(); ++end) {
        const Vec3d way = points[end] - points[begin];
        const double squared = dot(way, way);
        bool straight = end - begin < kMost && squared > 0;
        for (std::size_t k = begin + 1; k < end && straight; ++k) {
            const Vec3d d = points[k] - points[begin];
            straight = norm(d - (dot(d, way) / squared) * way) <= tolerance;
        }
        if (!straight) {
            begin = end - 1;
            out.push_back(points[begin]);
        }
    }
    out.push_back(points.back());
    return out;
}

}  // namespace

std::vector<PlannedOperation> engraved_on_floor(const Job& job,
                                                const Operation& operation,
                                                const std::vector<std::vector<Edge>>& chains)
{
    const double depth = operation.prismatic->depth;
    PlannedOperation planned = begun(
        job, operation, fmt::format("{} curves, {:g} mm below the floor", chains.size(), depth));
    ToolpathWriter writer{planned.path.moves, {job.stock_top + job.clearance}};
    FloorChain floor{job, operation};
    // below a top of 0
    std::vector<double> levels = cut_levels(job, operation, depth);
    for (double& level : levels) {
        level -= operation.prismatic->top;
    }
    for (const std::vector<Edge>& edges : chains) {
        std::vector<Vec3d> points = thinned(floor.along(edges), operation.floor_tolerance / 4);
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
    return {planned};
}

}  // namespace cusp::prismatic
