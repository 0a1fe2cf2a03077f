// The tip follows the medial axis at the depth where both flanks touch a wall. If that is below the
// floor, the tip stays on the floor, and loops along the walls clear the rest.
#include <algorithm>
#include <array>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/prismatic/contour_run.hpp"
#include "host_tools/cam/prismatic/cut_levels.hpp"
#include "host_tools/cam/prismatic/medial_axis.hpp"
#include "host_tools/cam/prismatic/prismatic.hpp"
#include "host_tools/cam/prismatic/profile_contours.hpp"
#include "host_tools/cam/prismatic/way_graph.hpp"
#include "host_tools/geometry/offset/offset.hpp"

#include "fmt/format.h"

namespace cusp::prismatic {

using job::CutDirection;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::Prismatic;
using offset::Contour;
using offset::Edge;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

// A path of the tip: along a branch of the axis, or a loop at one height.
struct Way {
    std::vector<Vec3d> points;  // both ends of a loop alone
    std::vector<Edge> loop;
};

// The branch with a point added wherever its radius passes one of two values, in rising order.
AxisBranch with_crossings(const AxisBranch& branch, std::array<double, 2> limits)
{
    AxisBranch out;
    for (const AxisPoint& p : branch) {
        if (!out.empty()) {
            const AxisPoint from = out.back();
            const double rise = p.radius - from.radius;
            if (rise < 0) {
                std::swap(limits[0], limits[1]);
            }
            for (const double limit : limits) {
                const double share = rise != 0 ? (limit - from.radius) / rise : 0.0;
                if (share > 0 && share < 1) {
                    out.push_back({from.at + share * (p.at - from.at), limit});
                }
            }
            std::sort(limits.begin(), limits.end());
        }
        out.push_back(p);
    }
    return out;
}

// The ends of all ways, to find those that lie on another one: forks of the axis.
class Forks {
public:
    explicit Forks(const std::vector<Way>& ways)
    {
        for (const Way& way : ways) {
            ends_.push_back(way.points.front());
            ends_.push_back(way.points.back());
        }
        std::sort(ends_.begin(), ends_.end(), [](Vec3d a, Vec3d b) { return a.x < b.x; });
    }

    // The first one on a line, away from the line's own ends.
    std::optional<Vec3d> on(Vec3d a, Vec3d b) const
    {
        std::optional<Vec3d> first;
        for (auto at = from(std::min(a.x, b.x));
             at != ends_.end() && at->x <= std::max(a.x, b.x) + kEndsMeet; ++at) {
            const double share =
                dot(*at - a, b - a) / std::max(dot(b - a, b - a), kEndsMeet * kEndsMeet);
            const Vec3d foot = a + std::clamp(share, 0.0, 1.0) * (b - a);
            const bool inside = norm(*at - a) > kEndsMeet && norm(*at - b) > kEndsMeet;
            if (inside && norm(*at - foot) < kEndsMeet &&
                (!first || norm(foot - a) < norm(*first - a))) {
                first = foot;
            }
        }
        return first;
    }

    bool is_at(Vec3d p) const
    {
        for (auto at = from(p.x); at != ends_.end() && at->x <= p.x + kEndsMeet; ++at) {
            if (norm(*at - p) < kEndsMeet) {
                return true;
            }
        }
        return false;
    }

private:
    std::vector<Vec3d>::const_iterator from(double low) const
    {
        return std::lower_bound(ends_.begin(), ends_.end(), low - kEndsMeet,
                                [](Vec3d p, double x) { return p.x < x; });
    }

    std::vector<Vec3d> ends_;  // by x
};

// The open ways, divided at their forks.
std::vector<Way> divided_at_forks(std::vector<Way> ways)
{
    const Forks forks{ways};
    std::vector<Way> out;
    for (Way& way : ways) {
        if (!way.loop.empty()) {
            out.push_back(std::move(way));
            continue;
        }
        Way part;
        part.points.push_back(way.points.front());
        const auto end_part = [&] {
            const Vec3d at = part.points.back();
            out.push_back(std::move(part));
            part = {{at}, {}};
        };
        for (std::size_t k = 1; k < way.points.size(); ++k) {
            while (const auto fork = forks.on(part.points.back(), way.points[k])) {
                part.points.push_back(*fork);
                end_part();
            }
            part.points.push_back(way.points[k]);
            if (k + 1 < way.points.size() && forks.is_at(way.points[k])) {
                end_part();
            }
        }
        out.push_back(std::move(part));
    }
    return out;
}

std::vector<WayGraph::Way> ends_of(const std::vector<Way>& ways)
{
    std::vector<WayGraph::Way> out;
    for (const Way& way : ways) {
        double length = 0;
        for (std::size_t k = 1; k < way.points.size(); ++k) {
            length += norm(way.points[k] - way.points[k - 1]);
        }
        out.push_back({way.points.front(), way.points.back(), length});
    }
    return out;
}

// The way that is not cut whose start or end is nearest.
WayGraph::Step nearest_of(const std::vector<Way>& ways, const WayGraph& graph, Vec3d at)
{
    WayGraph::Step best{};
    double least = kUnbounded;
    for (std::size_t k = 0; k < ways.size(); ++k) {
        if (graph.is_cut(k)) {
            continue;
        }
        const double from_start = norm(ways[k].points.front() - at);
        const double from_end = norm(ways[k].points.back() - at);
        if (std::min(from_start, from_end) < least) {
            least = std::min(from_start, from_end);
            best = {k, from_end < from_start};
        }
    }
    return best;
}

class Carver {
public:
    Carver(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          cut_{*operation.prismatic},
          slope_{1 / elementary::tan(operation.tool.tip_angle / 2)},
          tip_{operation.tool.tip_radius},
          region_{material_of(cut_)},
          axis_{medial_axis(region_.source())}
    {
        for (const AxisBranch& branch : axis_) {
            for (const AxisPoint& p : branch) {
                if (!(p.radius <= widest_.radius)) {
                    widest_ = p;
                }
            }
        }
    }

    PlannedOperation plan();

private:
    double depth_of(double radius) const { return (radius - tip_) * slope_; }
    double radius_at(double depth) const { return tip_ + depth / slope_; }
    void check_width() const;
    std::vector<double> depths() const;
    void add_branches(double above, double depth, std::vector<Way>& ways) const;
    void add_loops(double above, double depth, bool last, std::vector<Way>& ways);
    double worth_of_lift(double above, double z) const;
    void write(const std::vector<Way>& ways, double above, ToolpathWriter& writer) const;

    const Job& job_;
    const Operation& operation_;
    const Prismatic& cut_;
    double slope_;  // of the flank
    double tip_;    // mm: radius of its flat
    RegionOffset region_;
    std::vector<AxisBranch> axis_;
    AxisPoint widest_{{0, 0}, 0};
    int loops_{0};
};

void Carver::check_width() const
{
    if (!(depth_of(widest_.radius) > 0)) {
        throw InputError(fmt::format(
            "{}{}: the tip of tool {}, {:g} mm wide, fits nowhere between the outlines: the widest "
            "place, at x {:.6g} y {:.6g} mm, has {:.4g} mm",
            operation_text(job_, operation_), cut_.file, operation_.tool.number, 2 * tip_,
            widest_.at.x, widest_.at.y, 2 * widest_.radius));
    }
}

// Depths of the levels below the top; the last is that of the widest place, or of the floor.
std::vector<double> Carver::depths() const
{
    const double deepest = std::min(cut_.depth, depth_of(widest_.radius));
    std::vector<double> depths;
    for (const double z : cut_levels(job_, operation_, deepest)) {
        depths.push_back(cut_.top - z);
    }
    return depths;
}

// The parts of the axis deeper than `above`, limited to `depth`.
void Carver::add_branches(double above, double depth, std::vector<Way>& ways) const
{
    constexpr double kSame = 1e-9;  // mm
    for (const AxisBranch& branch : axis_) {
        Way way;
        double deepest = 0;
        const auto end_way = [&] {
            if (deepest > above + kSame) {
                ways.push_back(std::move(way));
            }
            way = {};
            deepest = 0;
        };
        for (const AxisPoint& p : with_crossings(branch, {radius_at(above), radius_at(depth)})) {
            const double down = depth_of(p.radius);
            if (down < above - kSame) {
                end_way();
                continue;
            }
            way.points.push_back({p.at.x, p.at.y, cut_.top - std::min(down, depth)});
            deepest = std::max(deepest, down);
        }
        end_way();
    }
}

// Loops on the floor at a depth, from the walls inward. Between them scallops of the height allowed
// remain; above the last level they reach the level before at most.
void Carver::add_loops(double above, double depth, bool last, std::vector<Way>& ways)
{
    constexpr double kMostLoops = 20000;
    const double ridge = last ? *operation_.tolerance.scallop
                              : std::max(*operation_.tolerance.scallop, depth - above);
    const double step = operation_.passes.step_over && last ? *operation_.passes.step_over
                                                            : 2 * (tip_ + ridge / slope_);
    const double room = widest_.radius - radius_at(depth);
    if (room / step > kMostLoops) {
        throw InputError(
            fmt::format("{}a scallop of {:g} mm needs {:.0f} loops on the floor, the "
                        "limit is {:g}: a larger one, or step_over",
                        operation_text(job_, operation_), ridge, room / step, kMostLoops));
    }
    for (double away = radius_at(depth); away < widest_.radius; away += step) {
        for (const Contour& contour : region_.at(away).contours) {
            const bool climb = operation_.passes.direction_of_cut == CutDirection::kClimb;
            const Contour way = climb ? contour : offset::reversed(contour);
            const Vec2d start = way.front().start;
            const Vec3d end{start.x, start.y, cut_.top - depth};
            ways.push_back({{end, end}, way});
            ++loops_;
        }
    }
}

// mm of travel at the feed that take as long as to lift the tool and to come down on a place at a height again.
double Carver::worth_of_lift(double above, double z) const
{
    constexpr double kRapid = 6000;  // mm/min, of a usual mill
    const toolpath::CuttingRates rates = rates_of(job_, operation_.tool);
    const double down = rapid_end(job_, cut_.top - above);
    const double lift = job_.stock_top + job_.clearance - z;
    return rates.feed * (std::max(0.0, down - z) / rates.plunge_feed + 2 * lift / kRapid);
}

// Continues through what is cut where that is quicker than a lift; else by the nearest neighbour.
void Carver::write(const std::vector<Way>& ways, double above, ToolpathWriter& writer) const
{
    const EdgeForm form{operation_.output != OutputForm::kLines, chord_tolerance(operation_),
                        operation_.passes.direction_of_cut == CutDirection::kClimb};
    WayGraph graph{ends_of(ways)};
    const auto follow = [&](std::size_t k, bool backward, MoveKind kind) {
        std::vector<Vec3d> points = ways[k].points;
        if (backward) {
            std::reverse(points.begin(), points.end());
        }
        for (const Vec3d& p : points) {
            const bool down = kind == MoveKind::kCut && p.z < writer.at().z;
            writer.line(down ? MoveKind::kPlungingCut : kind, p);
        }
    };
    std::optional<WayGraph::Step> last;
    for (std::size_t left = ways.size(); left > 0; --left) {
        std::optional<WayGraph::Link> link;
        if (last) {
            link = graph.link_to_uncut(last->way, !last->backward,
                                       worth_of_lift(above, writer.at().z));
        }
        WayGraph::Step next{};
        if (link) {
            for (const WayGraph::Step& step : link->steps) {
                follow(step.way, step.backward, MoveKind::kLink);
            }
            next = {link->way, link->backward};
        } else {
            next = nearest_of(ways, graph, writer.at());
        }
        const Way& way = ways[next.way];
        const Vec3d start = next.backward ? way.points.back() : way.points.front();
        if (!writer.started() || (!link && norm(start - writer.at()) > kEndsMeet)) {
            writer.approach(in_plan(start), rapid_end(job_, cut_.top - above));
            writer.line(MoveKind::kPlunge, start);
        }
        if (!way.loop.empty()) {
            write_edges(way.loop, start.z, start.z, form, writer);
        }
        follow(next.way, next.backward, MoveKind::kCut);
        graph.mark_cut(next.way);
        last = next;
    }
}

PlannedOperation Carver::plan()
{
    check_width();
    const std::vector<double> levels = depths();
    const double deepest = levels.back();
    PlannedOperation planned =
        begun(job_, operation_,
              fmt::format("{}, {:.4g} mm deep at most", counted(axis_.size(), "branch", "branches"),
                          deepest));
    ToolpathWriter writer{planned.path.moves, {job_.stock_top + job_.clearance}};
    double above = 0;
    std::size_t ways_written = 0;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        std::vector<Way> ways;
        add_loops(above, levels[k], k + 1 == levels.size(), ways);
        add_branches(above, levels[k], ways);
        ways = divided_at_forks(std::move(ways));
        ways_written += ways.size();
        write(ways, above, writer);
        above = levels[k];
    }
    writer.retract();
    count_moves(writer, static_cast<int>(ways_written), static_cast<int>(levels.size()), planned);
    const double too_deep = depth_of(widest_.radius) - cut_.depth;
    if (!cut_.given_depth && too_deep > kAxisTolerance) {
        planned.stats.warnings.push_back(fmt::format(
            "tool {} is too narrow for the whole width at x {:.6g} y {:.6g} mm: a level floor "
            "{:.4g} mm deep in place of a groove {:.4g} mm deep",
            operation_.tool.number, widest_.at.x, widest_.at.y, cut_.depth, cut_.depth + too_deep));
    }
    planned.stats.counts.emplace_back("branches", static_cast<double>(axis_.size()));
    planned.stats.counts.emplace_back("floor_loops", loops_);
    planned.stats.counts.emplace_back("depth_mm", deepest);
    planned.stats.gouge_bound_mm = kFit;
    planned.stats.scallop_bound_mm = loops_ > 0 ? *operation_.tolerance.scallop : 0.0;
    return planned;
}

}  // namespace

std::vector<PlannedOperation> plan_v_carve(const Job& job, const Operation& operation)
{
    return {Carver{job, operation}.plan()};
}

}  // namespace cusp::prismatic
