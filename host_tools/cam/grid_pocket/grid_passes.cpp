// Corners of the path over cells become runs; between runs the tool links over material already
// cut.
#include "host_tools/cam/grid_pocket/grid_passes.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/cam/grid_pocket/run_entry.hpp"
#include "host_tools/cam/grid_pocket/zigzag_runs.hpp"

namespace cusp::grid_pocket {

using adaptive_clearing::AdaptivePathWriter;
using clearing::AxialDepthTracker;
using job::CutDirection;
using job::Operation;
using job::OutputForm;
using offset::Box2d;
using offset::Contour;
using offset::Edge;
using offset::reversed;
using toolpath::EntryKind;
using toolpath::EntrySettings;
using toolpath::MoveKind;
using toolpath::Tool;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;

namespace {

// Points along the edge after its start. Chords of an arc stay on the pocket's side of it: secants
// inside an arc around a centre in the pocket, tangents around a corner of the wall.
void append_chords(const Edge& edge,
                   double tolerance,
                   bool around_corner,
                   std::vector<Vec2d>& corners)
{
    if (edge.turn != 0) {
        const double step = 2 * std::sqrt(2 * std::min(tolerance / edge.radius, 0.5));
        const int pieces = static_cast<int>(std::ceil(sweep(edge) / step));
        const double out = 1 / elementary::cos(sweep(edge) / pieces / 2);
        for (int i = 0; around_corner && i < pieces; ++i) {
            const Vec2d on = point_on(edge, (i + 0.5) / pieces);
            corners.push_back(edge.centre + (on - edge.centre) * out);
        }
        for (int i = 1; !around_corner && i < pieces; ++i) {
            corners.push_back(point_on(edge, static_cast<double>(i) / pieces));
        }
    }
    corners.push_back(edge.end);
}

// Entries ramp along their run by default.
EntrySettings entry_settings(const PocketSpace& pocket)
{
    const Operation& operation = pocket.operation;
    const bool any = operation.passes.entry == EntryKind::kAuto;
    return {pocket.job.stock_top + pocket.job.clearance,
            any ? EntryKind::kRamp : operation.passes.entry, operation.tool.radius,
            operation.levels.max_depth.value_or(kUnbounded)};
}

}  // namespace

GridPasses::GridPasses(PocketSpace& pocket, Toolpath& path)
    : pocket_{pocket},
      path_{path},
      writer_{path.moves, entry_settings(pocket)},
      stock_tops_(pocket.grid.size(), static_cast<float>(pocket.job.stock_top))
{
    const Operation& operation = pocket.operation;
    if (operation.levels.max_depth || !operation.levels.layers.empty()) {
        const Box2d box = box_of(pocket.centres);
        const double radius = operation.tool.radius;
        const Box2d field{box.x0 - radius, box.y0 - radius, box.x1 + radius, box.y1 + radius};
        depth_.emplace(writer_, path,
                       AxialDepthTracker{field, operation.tool, pocket.job.stock_top,
                                         operation.levels.max_depth});
    }
}

void GridPasses::finish()
{
    writer_.retract();
    if (depth_) {
        depth_->track_moves();
    }
}

void GridPasses::follow(ClPathFitter& floor, const std::vector<Vec2d>& corners)
{
    if (depth_) {
        depth_->follow(floor, corners, circle_over(floor));
    } else {
        floor.follow(writer_, corners, MoveKind::kCut);
    }
}

void GridPasses::enter(ClPathFitter& floor,
                       const std::vector<Vec2d>& corners,
                       double stock_top,
                       bool link)
{
    if (depth_) {
        depth_->enter(floor, corners, stock_top, link, circle_over(floor));
    } else {
        enter_run(writer_, run_beginning(floor, corners, writer_.tool_radius()), stock_top, link,
                  circle_over(floor));
    }
}

void GridPasses::layer(double plane)
{
    // Cells that the layers above have cut down to the floor are omitted. The others are cut as low
    // as the layer and the floor allow, so that no fin is left between layers on a slope.
    const double above = std::min(last_plane_.value_or(kUnbounded), pocket_.job.stock_top);
    ClPathFitter floor = pocket_.rough.above(plane);
    cut_cells(
        plane, [&](Cell c) { return pocket_.rough_heights[pocket_.grid.index(c)] < above; }, floor);
    wall_level(above, floor);
    pocket_.finish.add_bound(floor.gouge_bound() - pocket_.rough_allowance);
    last_plane_ = plane;
}

void GridPasses::cut_cells(double plane, const std::function<bool(Cell)>& free, ClPathFitter& floor)
{
    NavigationRules rules;
    rules.free = [&](Cell c) {
        return pocket_.grid.inside(c) && free(c);
    };
    pocket_.add_clearances(rules);
    const Navigation navigation = reversed(navigate(pocket_.grid, rules));
    count(navigation);
    follow_navigation(navigation, floor);
    for (const NavigationStep& step : navigation.steps) {
        const std::size_t cell = pocket_.grid.index(step.cell);
        stock_tops_[cell] = static_cast<float>(std::max(plane, pocket_.rough_heights[cell]));
    }
}

void GridPasses::adaptive_layer(const AdaptiveLayers& layers, const AdaptiveLayer& layer)
{
    const Operation& operation = pocket_.operation;
    AdaptivePathWriter cutter{writer_,
                              {operation.output != OutputForm::kLines, layers.chord,
                               operation.passes.entry == EntryKind::kPlunge, layers.scallops}};
    cutter.write(layer.path, layer.above, layer.z);
    passes_ += static_cast<int>(layer.path.runs.size());
    adaptive_entries_ += cutter.entries();
    const std::vector<LayerReach> reached = reach_of(layer, layers, pocket_);
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (reached[i] == LayerReach::kCut) {
            stock_tops_[i] =
                std::min(stock_tops_[i], static_cast<float>(layer.z + layers.scallops));
        }
    }
    const double above = std::min(last_plane_.value_or(kUnbounded), pocket_.job.stock_top);
    ClPathFitter floor = pocket_.rough.above(layer.z);
    cut_cells(
        layer.z,
        [&](Cell c) {
            const std::size_t i = pocket_.grid.index(c);
            return reached[i] == LayerReach::kNone && pocket_.rough_heights[i] <= layer.z;
        },
        floor);
    wall_level(above, floor);
    pocket_.finish.add_bound(floor.gouge_bound() - pocket_.rough_allowance);
    last_plane_ = layer.z + layers.scallops;
}

void GridPasses::main_path(const Navigation& navigation)
{
    count(navigation);
    main_moves_ = follow_navigation(navigation, pocket_.finish);
}

std::size_t GridPasses::follow_navigation(const Navigation& navigation, ClPathFitter& floor)
{
    std::size_t cut = 0;
    for (std::size_t i = 0; i < navigation.steps.size();) {
        std::size_t end = i + 1;
        std::vector<Vec2d> corners{pocket_.grid.centre(navigation.steps[i].cell)};
        for (; end < navigation.steps.size() && navigation.steps[end].kind != StepKind::kEnter;
             ++end) {
            const auto& bends = navigation.steps[end].bends;
            corners.insert(corners.end(), bends.begin(), bends.end());
            const bool last = end + 1 == navigation.steps.size() ||
                              navigation.steps[end + 1].kind == StepKind::kEnter;
            if (last || !straight(navigation, end)) {
                corners.push_back(pocket_.grid.centre(navigation.steps[end].cell));
            }
        }
        begin_run(corners, stock_top_at(navigation.steps[i].cell), floor);
        const std::size_t before = path_.moves.size();
        follow(floor, corners);
        cut += path_.moves.size() - before;
        i = end;
    }
    return cut;
}

void GridPasses::begin_run(const std::vector<Vec2d>& corners, double stock_top, ClPathFitter& floor)
{
    const double over = std::max(stock_top, stock_top_under(corners.front()));
    enter(floor, corners, over, can_link(corners.front()));
}

void GridPasses::wall()
{
    for (const Contour& contour : pocket_.centres.contours) {
        const Contour loop = wall_loop(contour);
        approach(wall_corners(loop));
        std::vector<Vec2d> corners{loop.front().start};
        for (const Edge& edge : loop) {
            if (edge.turn != 0) {
                follow(pocket_.finish, corners);
                corners = {edge.start};
                if (follow_arc(pocket_.finish, edge)) {
                    corners = {edge.end};
                    continue;
                }
            }
            append_points(edge, corners);
        }
        follow(pocket_.finish, corners);
        ++passes_;
    }
}

void GridPasses::zigzag(char axis, Tracks& tracks)
{
    const auto clear = [&](Cell a, Cell b) {
        return pocket_.clear(a, b);
    };
    for (const GridRun& run : zigzag_runs(pocket_.grid, axis, tracks, clear)) {
        const std::vector<Vec2d> corners{pocket_.grid.centre(run.first),
                                         pocket_.grid.centre(run.last)};
        approach(corners);
        follow(pocket_.finish, corners);
        ++passes_;
    }
}

void GridPasses::count(const Navigation& navigation)
{
    backtracks_ += navigation.backtracks;
    dead_ends_ += navigation.dead_ends;
    lifts_ += navigation.lifts;
    steps_ += static_cast<int>(navigation.steps.size());
    passes_ += static_cast<int>(
        std::count_if(navigation.steps.begin(), navigation.steps.end(),
                      [](const NavigationStep& s) { return s.kind == StepKind::kEnter; }));
}

bool GridPasses::straight(const Navigation& navigation, std::size_t i)
{
    if (!navigation.steps[i].bends.empty() || !navigation.steps[i + 1].bends.empty()) {
        return false;
    }
    const Cell a = navigation.steps[i - 1].cell;
    const Cell b = navigation.steps[i].cell;
    const Cell c = navigation.steps[i + 1].cell;
    return b.column - a.column == c.column - b.column && b.row - a.row == c.row - b.row;
}

double GridPasses::stock_top_under(Vec2d at) const
{
    const CellGrid& grid = pocket_.grid;
    const Tool& tool = pocket_.operation.tool;
    // Between cells the stock has scallops, and a cell's own height extends to its corners.
    const double half = elementary::hypot(grid.gx(), grid.gy()) / 2;
    const double corner = tool.corner_radius;
    const double in = std::min(half, corner);
    const double scallop_height = corner - std::sqrt(corner * corner - in * in);
    const Cell middle = grid.nearest(at);
    const int columns = static_cast<int>((tool.radius + half) / grid.gx()) + 1;
    const int rows = static_cast<int>((tool.radius + half) / grid.gy()) + 1;
    double most = -kUnbounded;
    for (int j = -rows; j <= rows; ++j) {
        for (int i = -columns; i <= columns; ++i) {
            const Cell c{middle.column + i, middle.row + j};
            const double away = std::max(0.0, norm(grid.centre(c) - at) - half);
            if (grid.inside(c) && away < tool.radius) {
                most =
                    std::max(most, stock_top_at(c) + scallop_height - profile_height(tool, away));
            }
        }
    }
    return std::min(most, pocket_.job.stock_top);
}

bool GridPasses::can_link(Vec2d to) const
{
    if (!last_plane_ || *last_plane_ > pocket_.job.stock_top || writer_.is_retracted()) {
        return false;
    }
    // Links are higher than this above the layer above.
    constexpr double kOver = 0.01;  // mm
    const Vec3d from{here().x, here().y, *last_plane_ + kOver};
    const Vec3d end{to.x, to.y, *last_plane_ + kOver};
    return norm(end - from) < 8 * pocket_.operation.tool.radius && cut_along(from, end) &&
           pocket_.clear(here(), to) && pocket_.rough.move_clearance(from, end) >= -1e-6;
}

bool GridPasses::cut_along(Vec3d from, Vec3d to) const
{
    const double step = std::min(pocket_.grid.gx(), pocket_.grid.gy()) / 2;
    const int count = 1 + static_cast<int>(norm(to - from) / step);
    for (int i = 0; i <= count; ++i) {
        const Vec3d p = from + (to - from) * (static_cast<double>(i) / count);
        const Cell c = pocket_.grid.nearest({p.x, p.y});
        if (!pocket_.grid.inside(c) || stock_top_at(c) > *last_plane_ + 1e-3) {
            return false;
        }
    }
    return true;
}

Contour GridPasses::wall_loop(const Contour& contour) const
{
    // Boundary loops have the pocket on their left: counter-clockwise, as in the paper. With a
    // spindle that turns clockwise that leaves the wall on the right: climb milling.
    const bool climb = pocket_.operation.passes.direction_of_cut == CutDirection::kClimb;
    Contour loop = climb ? contour : reversed(contour);
    const auto nearest =
        std::min_element(loop.begin(), loop.end(), [&](const Edge& a, const Edge& b) {
            return distance_to(a, here()) < distance_to(b, here());
        });
    std::rotate(loop.begin(), nearest, loop.end());
    const Edge whole = loop.front();
    const Vec2d at = nearest_on(whole, here());
    if (std::min(norm(at - whole.start), norm(at - whole.end)) > pocket_.grid.gx() / 4) {
        loop.front() = between(whole, at, whole.end);
        loop.push_back(between(whole, whole.start, at));
    }
    return loop;
}

void GridPasses::append_points(const Edge& edge, std::vector<Vec2d>& corners) const
{
    const bool climb = pocket_.operation.passes.direction_of_cut == CutDirection::kClimb;
    const double tolerance = std::max(pocket_.operation.tolerance.plan / 4, kWallRounding / 2);
    append_chords(edge, tolerance, (edge.turn < 0) == climb, corners);
}

std::vector<Vec2d> GridPasses::wall_corners(const Contour& loop) const
{
    std::vector<Vec2d> corners{loop.front().start};
    for (const Edge& edge : loop) {
        append_points(edge, corners);
    }
    return corners;
}

bool GridPasses::follow_arc(ClPathFitter& floor, const Edge& arc)
{
    std::vector<Vec2d> corners{arc.start};
    append_points(arc, corners);
    return !(depth_ && depth_->too_deep(floor, corners)) &&
           floor.follow_level_arc(writer_, arc, MoveKind::kCut);
}

Vec2d GridPasses::here() const { return in_plan(writer_.at()); }

ToolpathWriter::HelixFloor GridPasses::circle_over(const ClPathFitter& floor) const
{
    return [this, &floor](Vec2d centre, double radius) -> std::optional<double> {
        constexpr int kSides = 16;
        constexpr int kMostLifts = 12;
        const double sagitta = radius * (1 - elementary::cos(kPi / kSides));
        if (pocket_.walls.clearance(centre) < pocket_.kept + radius + sagitta) {
            return std::nullopt;
        }
        // Chords outside the circle: whatever clearance they have, the arcs have too.
        const double out = (radius + sagitta) / elementary::cos(kPi / kSides);
        const auto at = [&](int i) {
            const double angle = 2 * kPi * i / kSides;
            return centre + Vec2d{elementary::cos(angle), elementary::sin(angle)} * out;
        };
        std::optional<double> highest;
        for (int i = 0; i < kSides; ++i) {
            const std::optional<double> here = floor.height(at(i));
            highest = here ? std::max(highest.value_or(*here), *here) : highest;
        }
        if (!highest) {
            return std::nullopt;
        }
        double z = *highest;
        for (int lift = 0; lift < kMostLifts; ++lift) {
            double least = 0.0;
            for (int i = 0; i < kSides; ++i) {
                const Vec2d a = at(i);
                const Vec2d b = at(i + 1);
                least = std::min(least,
                                 floor.move_clearance({a.x, a.y, z}, {b.x, b.y, z}, 2 * sagitta));
            }
            if (least >= -1e-6) {
                return z;
            }
            z += std::max(-least, 1e-3) * 1.5;
        }
        return std::nullopt;
    };
}

void GridPasses::approach(const std::vector<Vec2d>& corners)
{
    const Vec2d start = corners.front();
    const double longest = std::max(8 * pocket_.operation.tool.radius, 2 * pocket_.job.clearance);
    if (writer_.started() && !writer_.is_retracted() && norm(start - here()) < longest &&
        pocket_.clear(here(), start)) {
        follow(pocket_.finish, {here(), start});
        return;
    }
    const Cell middle = pocket_.grid.nearest(start);
    std::optional<Vec2d> cut;
    double least = kUnbounded;
    for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
            const Cell c{middle.column + i, middle.row + j};
            const double way = norm(pocket_.grid.centre(c) - start);
            if (pocket_.grid.inside(c) && way < least &&
                pocket_.clear(pocket_.grid.centre(c), start)) {
                least = way;
                cut = pocket_.grid.centre(c);
            }
        }
    }
    if (cut) {
        enter(pocket_.finish, {*cut, start}, pocket_.finish.start_height(*cut), false);
        follow(pocket_.finish, {*cut, start});
        return;
    }
    enter(pocket_.finish, corners, pocket_.job.stock_top, false);
}

void GridPasses::wall_level(double above, ClPathFitter& floor)
{
    for (const Contour& contour : pocket_.centres.contours) {
        std::vector<Vec2d> run;
        const std::vector<Vec2d> corners = wall_corners(wall_loop(contour));
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const Vec2d way = corners[i] - corners[i - 1];
            const int pieces = std::max(1, static_cast<int>(norm(way) / pocket_.grid.gx()));
            for (int k = 0; k < pieces; ++k) {
                const Vec2d from = corners[i - 1] + way * (static_cast<double>(k) / pieces);
                const Vec2d to = corners[i - 1] + way * (static_cast<double>(k + 1) / pieces);
                if (std::min(height_or(from), height_or(to)) >= above) {
                    cut_level(run, above, floor);
                    continue;
                }
                if (run.empty()) {
                    run.push_back(from);
                }
                if (k > 0 && run.size() > 1) {
                    run.pop_back();
                }
                run.push_back(to);
            }
        }
        cut_level(run, above, floor);
    }
}

double GridPasses::height_or(Vec2d at) const
{
    return pocket_.rough.height(at).value_or(pocket_.rough.lowest());
}

void GridPasses::cut_level(std::vector<Vec2d>& run, double above, ClPathFitter& floor)
{
    if (run.size() > 1) {
        const double longest =
            std::max(8 * pocket_.operation.tool.radius, 2 * pocket_.job.clearance);
        if (writer_.started() && !writer_.is_retracted() && norm(run.front() - here()) < longest &&
            pocket_.clear(here(), run.front())) {
            follow(floor, {here(), run.front()});
        } else {
            begin_run(run, above, floor);
        }
        follow(floor, run);
        ++passes_;
    }
    run.clear();
}

}  // namespace cusp::grid_pocket
