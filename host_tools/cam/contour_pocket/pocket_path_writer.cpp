// Passes in order, each linked from the end of the one before where a link exists.
#include "host_tools/cam/contour_pocket/pocket_path_writer.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/cam/clearing/clear_path.hpp"
#include "host_tools/cam/clearing/path_inside_region.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"

namespace cusp::contour_pocket {

using cl_path::ClMove;
using cl_path::ClPath;
using cl_path::ClPathSettings;
using cl_path::drop_path;
using cl_path::flattened;
using cl_path::kWrittenStep;
using cl_path::repeated_plan_tolerance;
using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::is_path_clear;
using clearing::PassStart;
using clearing::path_inside_region;
using job::EntryKind;
using offset::distance;
using offset::Edge;
using offset::length;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using offset::reversed;
using toolpath::kLeastTurn;
using toolpath::MoveKind;

namespace {

constexpr double kSamePlace = kWrittenStep;  // paths are rounded to it
constexpr double kBarelyOver = 0.03;         // mm above a pass: no slope is needed

double lowest_of(const ClPath& path)
{
    double lowest = path.start.z;
    for (const ClMove& move : path.moves) {
        lowest = std::min(lowest, move.end.z);
        for (const Vec3d p : move.curve.points) {
            lowest = std::min(lowest, p.z);
        }
    }
    return lowest;
}

// The entry from one layer of a pass to the next: along the pass.
EntryKind layer_entry(EntryKind entry)
{
    return entry == EntryKind::kPlunge ? entry : EntryKind::kRamp;
}

bool is_open(const ClearingPass& pass)
{
    return distance(pass.path.front().start, pass.path.back().end) > 1e-9;
}

bool is_set(const std::vector<bool>& flags, std::size_t i) { return i < flags.size() && flags[i]; }

}  // namespace

Region2d reach_of(const RegionOffset& walls, double wall_clearance)
{
    return walls.at(wall_clearance - kWrittenStep);
}

ClPath PocketPathWriter::project(const std::vector<Edge>& plan, const ClPathSettings& path_settings)
{
    ClPath path = drop_path(plan, floor_, path_settings);
    if (!path.over_floor) {
        refuse_uncovered(operation_, path.missing);
    }
    return path;
}

void PocketPathWriter::enter(const ProjectedPass& cut, const CutSettings& settings)
{
    const ClearingPass& pass = cut.pass;
    ClPathSettings path_settings = cut.settings;
    const double tool = operation_.tool.radius;
    const double radius = std::min(0.6 * tool, pass.wall_distance - settings.wall_clearance - 1e-3);
    const double round = length(pass.path);
    const Vec2d start = pass.path.front().start;
    const bool is_above = moves_.is_over(cut.path.start);
    // On a very short pass a ramp is nearly a plunge. A small helix is better, though more is cut
    // by the middle of the tool.
    const bool helix = (settings.entry == EntryKind::kHelix && !is_above) ||
                       (settings.entry == EntryKind::kAuto && round < 6.0 * tool && !is_above) ||
                       (settings.entry != EntryKind::kPlunge && round < 0.5 * tool);
    const bool curves = path_settings.nurbs;
    path_settings.nurbs = false;
    const ClPath path = curves ? project(pass.path, path_settings) : cut.path;
    EntryHeights heights = settings.entry_heights(path.start.z);
    const bool open = is_open(pass);
    if (depth_ != nullptr) {
        const EntryHeights over = heights_over(depth_->stock_top_at(start));
        // Closed passes have already cut the stock around open ones.
        heights.stock_top = open ? over.stock_top : heights.stock_top;
        heights.raise_over(over);
        heights.rapid =
            settings.rapid_to_stock ? std::max(over.rapid, heights.stock_top) : heights.rapid;
    }
    const double around = helix ? stock_top_around(start, radius) : 0.0;
    // A helix extends beyond the pass, into stock that no pass has cut.
    const bool shallow =
        depth_ == nullptr || around - path.start.z <= depth_->max_depth().value_or(kUnbounded);
    const bool wide = radius > 0.2 * tool || (radius > 0.02 * tool && 2 * kPi * radius > round);
    if (helix && wide && shallow) {
        heights.raise_over(heights_over(around));
        heights.stock_top = moves_.enter_by_helix(
            {path.start, radius, round < radius, heights, path_settings.arcs},
            {[&](Vec2d at) {
                 return std::max(floor_.tip_height(at) + path_settings.allowance,
                                 path_settings.min_z);
             },
             [&](Vec3d a, Vec3d b) {
                 return floor_.move_clearance(a, b);
             }});
    }
    moves_.enter_along(path, heights, kLeastTurn * tool, settings.entry == EntryKind::kPlunge);
}

double PocketPathWriter::stock_top_around(Vec2d start, double radius) const
{
    return depth_ == nullptr ? -kUnbounded : depth_->stock_top_around(start, radius);
}

bool PocketPathWriter::too_deep(const ClPath& path, const CutSettings& settings) const
{
    return depth_ != nullptr && allowed_height_over(path, settings).has_value();
}

// Precondition: a depth tracker.
std::optional<double> PocketPathWriter::allowed_height_over(const ClPath& path,
                                                            const CutSettings& settings) const
{
    return depth_->allowed_height_over(path.start, tool_moves(path, MoveKind::kCut),
                                       settings.depth_share);
}

// Precondition: a depth tracker.
double PocketPathWriter::stock_top_over(const ClPath& path) const
{
    return depth_->stock_top_over(path.start, tool_moves(path, MoveKind::kCut));
}

PocketPathWriter::ProjectedPass PocketPathWriter::project_pass(const ClearingPass& pass,
                                                               const CutSettings& settings,
                                                               bool repeated)
{
    ProjectedPass result{pass, settings.path_settings, {}};
    if (repeated) {
        result.settings.plan_tolerance =
            repeated_plan_tolerance(settings.path_settings.plan_tolerance);
    }
    result.path = project(pass.path, result.settings);
    return result;
}

// False if the link would cut too deep.
bool PocketPathWriter::link(const ProjectedPass& projected_pass, const CutSettings& settings)
{
    ClPathSettings linking = settings.path_settings;
    linking.nurbs = false;
    linking.even = true;
    const ClPath link = project(projected_pass.pass.link, linking);
    if (too_deep(link, settings)) {
        return false;
    }
    least_clearance_ = std::min(least_clearance_, link.least_clearance);
    moves_.link(link);
    return true;
}

// True if the path above the stock is no longer than a retract and a descent.
bool PocketPathWriter::is_shorter_than_retract(const std::vector<Edge>& way) const
{
    constexpr double kLongest = 8.0;  // radii
    return depth_ != nullptr && !way.empty() &&
           length(way) <= 2.0 * moves_.below_clearance() + kLongest * operation_.tool.radius;
}

// Follows the path above the stock along it, and above `z`.
void PocketPathWriter::follow_above(const std::vector<Edge>& way,
                                    double z,
                                    const CutSettings& settings)
{
    ClPathSettings path_settings = settings.path_settings;
    path_settings.nurbs = false;
    path_settings.even = true;
    const double stock = depth_ != nullptr ? stock_top_over(project(way, path_settings))
                                           : settings.entry_heights(z).stock_top;
    path_settings.min_z = heights_over(std::max({stock, z, moves_.place().z})).stock_top;
    const ClPath path = project(way, path_settings);
    least_clearance_ = std::min(least_clearance_, path.least_clearance);
    moves_.link(path);
}

// A straight link to the start of the pass; false if a wall is in the way, or it is too long.
bool PocketPathWriter::link_above_stock(const ProjectedPass& projected_pass,
                                        const CutSettings& settings)
{
    const Vec2d from = in_plan(moves_.place());
    const Edge way = line_edge(from, projected_pass.pass.path.front().start);
    const bool entered = layer_entry(settings.entry) == settings.entry;
    if ((projected_pass.pass.start == PassStart::kPlungeEntry && !entered) ||
        !is_shorter_than_retract({way}) ||
        !is_path_clear(walls_, way,
                       settings.wall_clearance - settings.path_settings.plan_tolerance)) {
        return false;
    }
    follow_above({way}, projected_pass.path.start.z, settings);
    return true;
}

// The link may have any length; false if no path exists.
bool PocketPathWriter::link_around(const ProjectedPass& projected_pass, const CutSettings& settings)
{
    if (!reach_) {
        reach_ = reach_of(walls_, settings.wall_clearance);
    }
    const std::vector<Edge> way = path_inside_region(*reach_, in_plan(moves_.place()),
                                                     projected_pass.pass.path.front().start);
    if (way.empty()) {
        return false;
    }
    CutSettings nearer = settings;
    nearer.path_settings.plan_tolerance =
        std::max(settings.path_settings.plan_tolerance - kWrittenStep, kWrittenStep);
    follow_above(way, projected_pass.path.start.z, nearer);
    return true;
}

// From the end of one pass to the start of an earlier one: straight, or back along the links
// between.
void PocketPathWriter::return_over(const std::vector<ClearingPass>& passes,
                                   std::size_t from,
                                   std::size_t to,
                                   const CutSettings& settings)
{
    const Edge straight = line_edge(passes[from].path.back().end, passes[to].path.front().start);
    std::vector<Edge> way;
    if (is_path_clear(walls_, straight,
                      settings.wall_clearance - settings.path_settings.plan_tolerance)) {
        way.push_back(straight);
    } else {
        for (std::size_t i = from; i > to; --i) {
            const std::vector<Edge> back = reversed(passes[i].link);
            way.insert(way.end(), back.begin(), back.end());
        }
    }
    if (is_shorter_than_retract(way)) {
        follow_above(way, -kUnbounded, settings);
    }
}

// By the pass's link if the tool is at its start and it does not cut too deep, else by an entry.
void PocketPathWriter::begin(const ProjectedPass& projected_pass, const CutSettings& settings)
{
    const ClearingPass& pass = projected_pass.pass;
    const bool at_link = pass.start == PassStart::kLink && moves_.is_down() &&
                         distance(pass.link.front().start, in_plan(moves_.place())) < kSamePlace;
    const bool here =
        moves_.is_down() &&
        distance(in_plan(projected_pass.path.start), in_plan(moves_.place())) < kSamePlace &&
        moves_.place().z < projected_pass.path.start.z + kBarelyOver;
    if (!here && (!at_link || !link(projected_pass, settings))) {
        if (moves_.is_down() && !moves_.is_over(projected_pass.path.start) &&
            !link_above_stock(projected_pass, settings) && moves_.retracts() >= allowed_retracts_) {
            link_around(projected_pass, settings);
        }
        enter(projected_pass, settings);
    }
    least_clearance_ = std::min(least_clearance_, projected_pass.path.least_clearance);
    moves_.cut(projected_pass.path);
    track_moves();
}

void PocketPathWriter::track_moves()
{
    if (depth_ != nullptr) {
        depth_->track(moves_.moves());
    }
}

// Cuts the pass at heights above it, as low as the stock allows, until the pass itself is not too
// deep; open passes alternate in direction. Returns the final pass, from the same plan path.
PocketPathWriter::ProjectedPass PocketPathWriter::cut_above(const ProjectedPass& deep,
                                                            const CutSettings& settings,
                                                            bool repeated)
{
    constexpr int kMostCuts = 1000;
    ClearingPass flat = deep.pass;
    if (!repeated) {
        flat.path = flattened(flat.path, settings.path_settings.plan_tolerance,
                              settings.path_settings.spacing, settings.path_settings.arcs);
    }
    ProjectedPass last = project_pass(flat, settings, true);
    CutSettings entering = settings;
    entering.path_settings.nurbs = false;
    entering.rapid_to_stock = false;
    double before = kUnbounded;
    for (int i = 0; i < kMostCuts; ++i) {
        const auto height = allowed_height_over(last.path, settings);
        if (!height || *height > before - kWrittenStep) {
            break;
        }
        before = std::max(*height, settings.path_settings.min_z);
        entering.path_settings.min_z = before;
        entering.entry_heights = [highest = stock_top_over(last.path)](double pass) {
            return heights_over(std::max(highest, pass));
        };
        begin(project_pass(flat, entering, true), entering);
        entering.entry = layer_entry(settings.entry);
        if (is_open(flat)) {
            flat.path = reversed(flat.path);
            last = project_pass(flat, settings, true);
        }
    }
    return last;
}

void PocketPathWriter::cut_pass(ClearingPass& pass, const CutSettings& settings, bool repeated)
{
    ProjectedPass now = project_pass(pass, settings, repeated);
    if (lowest_of(now.path) >= settings.skip_above) {
        return;
    }
    track_moves();
    CutSettings entering = settings;
    entering.rapid_to_stock = settings.rapid_to_stock && !repeated;
    if (too_deep(now.path, settings)) {
        now = cut_above(now, settings, repeated);
        entering.entry = layer_entry(settings.entry);
    }
    begin(now, entering);
    if (is_open(now.pass)) {
        pass.path = reversed(now.pass.path);
    }
}

// Cuts the path as many times as its depth requires, and the end of the pass once.
void PocketPathWriter::cut_final(ClearingPass& pass, const CutSettings& settings, bool repeated)
{
    if (!pass.final_path.empty()) {
        track_moves();
        const ProjectedPass deep = project_pass(pass, settings, repeated);
        if (too_deep(deep.path, settings)) {
            cut_above(deep, settings, repeated);
        }
        pass.path = pass.final_path;
    }
    cut_pass(pass, settings, repeated);
}

// Stock left by roughing beside these passes is cut level by level.
void PocketPathWriter::cut_beside_stock(std::vector<ClearingPass>& passes,
                                        const CutSettings& settings)
{
    CutSettings over = settings;
    over.path_settings.nurbs = false;
    over.depth_share = 1.0;
    std::vector<double> lowest;
    for (const ClearingPass& pass : passes) {
        lowest.push_back(lowest_of(project_pass(pass, settings, true).path));
    }
    double above = settings.stock_beside.top;
    std::size_t last = 0;
    for (const double height : settings.stock_beside.heights) {
        over.path_settings.min_z = height;
        over.entry_heights = [above](double pass) {
            return heights_over(std::max(above, pass));
        };
        for (std::size_t i = 0; i < passes.size(); ++i) {
            if (lowest[i] < height - kWrittenStep) {
                if (last > i) {
                    return_over(passes, last, i, over);
                }
                cut_pass(passes[i], over, true);
                over.entry = layer_entry(settings.entry);
                last = i;
            }
        }
        above = height;
    }
    if (last > 0) {
        return_over(passes, last, 0, over);
    }
}

void PocketPathWriter::cut(const ClearedRegion& cleared, const CutSettings& settings)
{
    const std::size_t n = cleared.passes.size();
    const auto is_entry = [](const ClearingPass& pass) {
        return pass.start == PassStart::kPlungeEntry;
    };
    allowed_retracts_ =
        settings.retracts - 1 -
        static_cast<int>(std::count_if(cleared.passes.begin(), cleared.passes.end(), is_entry));
    for (std::size_t first = 0, end = 0; first < n; first = end) {
        end = first + 1;
        allowed_retracts_ += is_entry(cleared.passes[first]) ? 1 : 0;
        const bool stock_beside = is_set(settings.stock_beside.passes, first);
        while (stock_beside && end < n && is_set(settings.stock_beside.passes, end) &&
               cleared.passes[end].start == PassStart::kLink) {
            ++end;
        }
        const auto at = [&](std::size_t i) {
            return cleared.passes.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::vector<ClearingPass> passes{at(first), at(end)};
        if (stock_beside) {
            cut_beside_stock(passes, settings);
        }
        for (std::size_t i = first; i < end; ++i) {
            if (is_set(settings.skipped, i)) {
                continue;
            }
            cut_final(passes[i - first], settings, is_set(settings.repeated, i));
        }
        if (settings.progress) {
            settings.progress(static_cast<double>(end) / static_cast<double>(n));
        }
    }
}

void PocketPathWriter::end()
{
    moves_.retract();
    track_moves();
}

}  // namespace cusp::contour_pocket
