// Corners of the cells' way become runs; between runs the tool stays down where the way is cut.
#include "host_tools/grid_pocket/grid_passes.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/grid_pocket/zigzag_runs.hpp"

namespace cusp::host {
namespace {

// Points along the edge after its start. Chords of an arc stay on the pocket's side of it: inside
// an arc about a centre in the pocket, tangents around a corner of the wall.
void append_points(const Edge& edge,
                   double tolerance,
                   bool around_corner,
                   std::vector<Vec2d>& corners)
{
    if (edge.turn != 0) {
        const double step = 2 * std::sqrt(2 * std::min(tolerance / edge.radius, 0.5));
        const int pieces = static_cast<int>(std::ceil(sweep(edge) / step));
        const double out = 1 / std::cos(sweep(edge) / pieces / 2);
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

}  // namespace

GridPasses::GridPasses(PocketSpace& pocket, Toolpath& path)
    : pocket_{pocket},
      path_{path},
      moves_{path, pocket.job.stock_top + pocket.job.clearance, pocket.operation.entry,
             pocket.operation.tool.radius},
      metal_(pocket.grid.size(), static_cast<float>(pocket.job.stock_top))
{
}

void GridPasses::layer(double plane)
{
    NavigationRules rules;
    const auto deep = [&](Cell c) {
        return pocket_.grid.inside(c) && pocket_.rough_heights[pocket_.grid.index(c)] <= plane;
    };
    const auto level = [&](Cell a, Cell b) {
        return clear_at(plane, a, b);
    };
    rules.free = deep;
    rules.clear_step = level;
    rules.clear_link = level;
    const Navigation navigation = reversed(navigate(pocket_.grid, rules));
    count(navigation);
    for (std::size_t i = 0; i < navigation.steps.size(); ++i) {
        const Cell c = navigation.steps[i].cell;
        const Vec2d at = pocket_.grid.centre(c);
        if (navigation.steps[i].kind == StepKind::kEnter) {
            const std::vector<Vec3d> way = level_way(navigation, i, plane);
            moves_.enter_level(way, metal_at(c), can_link(way.front()));
        } else {
            const bool corner = i + 1 == navigation.steps.size() ||
                                navigation.steps[i + 1].kind == StepKind::kEnter ||
                                !straight(navigation, i);
            if (corner) {
                moves_.tip().line(MoveKind::kCut, {at.x, at.y, plane});
            }
        }
    }
    for (const NavigationStep& step : navigation.steps) {
        metal_[pocket_.grid.index(step.cell)] = static_cast<float>(plane);
    }
    wall_level(plane);
    last_plane_ = plane;
}

void GridPasses::main_path(const Navigation& navigation)
{
    count(navigation);
    for (std::size_t i = 0; i < navigation.steps.size();) {
        std::size_t end = i + 1;
        std::vector<Vec2d> corners{pocket_.grid.centre(navigation.steps[i].cell)};
        for (; end < navigation.steps.size() && navigation.steps[end].kind != StepKind::kEnter;
             ++end) {
            const bool last = end + 1 == navigation.steps.size() ||
                              navigation.steps[end + 1].kind == StepKind::kEnter;
            if (last || !straight(navigation, end)) {
                corners.push_back(pocket_.grid.centre(navigation.steps[end].cell));
            }
        }
        moves_.enter(pocket_.finish, corners, metal_at(navigation.steps[i].cell));
        const std::size_t before = path_.moves.size();
        pocket_.finish.follow(moves_.tip(), corners, MoveKind::kCut);
        main_moves_ += path_.moves.size() - before;
        i = end;
    }
}

void GridPasses::wall()
{
    for (const Contour& contour : pocket_.centres.contours) {
        const std::vector<Vec2d> corners = wall_corners(contour);
        approach(corners);
        pocket_.finish.follow(moves_.tip(), corners, MoveKind::kCut);
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
        pocket_.finish.follow(moves_.tip(), corners, MoveKind::kCut);
        ++passes_;
    }
}

void GridPasses::count(const Navigation& navigation)
{
    backtracks_ += navigation.backtracks;
    dead_ends_ += navigation.dead_ends;
    steps_ += static_cast<int>(navigation.steps.size());
    passes_ += static_cast<int>(
        std::count_if(navigation.steps.begin(), navigation.steps.end(),
                      [](const NavigationStep& s) { return s.kind == StepKind::kEnter; }));
}

bool GridPasses::straight(const Navigation& navigation, std::size_t i)
{
    const Cell a = navigation.steps[i - 1].cell;
    const Cell b = navigation.steps[i].cell;
    const Cell c = navigation.steps[i + 1].cell;
    return b.column - a.column == c.column - b.column && b.row - a.row == c.row - b.row;
}

bool GridPasses::clear_at(double plane, Cell a, Cell b) const
{
    if (!pocket_.clear(a, b)) {
        return false;
    }
    const Vec2d from = pocket_.grid.centre(a);
    const Vec2d to = pocket_.grid.centre(b);
    return pocket_.rough.clearance({from.x, from.y, plane}, {to.x, to.y, plane}, 0) >= -1e-6;
}

bool GridPasses::can_link(Vec3d to) const
{
    if (last_plane_ > pocket_.job.stock_top || moves_.lifted()) {
        return false;
    }
    const Vec3d from{here().x, here().y, last_plane_};
    const Vec3d end{to.x, to.y, last_plane_};
    return norm(end - from) < 8 * pocket_.operation.tool.radius && cut_along(from, end) &&
           pocket_.clear(here(), {to.x, to.y}) && pocket_.rough.clearance(from, end, 0) >= -1e-6;
}

bool GridPasses::cut_along(Vec3d from, Vec3d to) const
{
    const double step = std::min(pocket_.grid.gx(), pocket_.grid.gy()) / 2;
    const int count = 1 + static_cast<int>(norm(to - from) / step);
    for (int i = 0; i <= count; ++i) {
        const Vec3d p = from + (to - from) * (static_cast<double>(i) / count);
        const Cell c = pocket_.grid.nearest({p.x, p.y});
        if (!pocket_.grid.inside(c) || metal_at(c) > last_plane_ + 1e-3) {
            return false;
        }
    }
    return true;
}

std::vector<Vec3d> GridPasses::level_way(const Navigation& navigation,
                                         std::size_t first,
                                         double plane) const
{
    std::vector<Vec3d> way;
    double length = 0;
    for (std::size_t i = first; i < navigation.steps.size() && length < moves_.ramp_length() &&
                                (i == first || navigation.steps[i].kind != StepKind::kEnter);
         ++i) {
        const Vec2d at = pocket_.grid.centre(navigation.steps[i].cell);
        way.push_back({at.x, at.y, plane});
        length += way.size() > 1 ? norm(way[way.size() - 1] - way[way.size() - 2]) : 0;
    }
    return way;
}

std::vector<Vec2d> GridPasses::wall_corners(const Contour& contour) const
{
    // Boundary loops have the pocket on their left: counter-clockwise, as in the paper, which
    // with a spindle that turns clockwise leaves the wall on the right and climbs.
    const bool climb = pocket_.operation.direction_of_cut == CutDirection::kClimb;
    const Contour loop = climb ? contour : reversed(contour);
    std::vector<Vec2d> corners{loop.front().start};
    const double tolerance = std::max(pocket_.operation.plan_tolerance / 4, kWallRounding / 2);
    for (const Edge& edge : loop) {
        append_points(edge, tolerance, (edge.turn < 0) == climb, corners);
    }
    const auto nearest =
        std::min_element(corners.begin(), corners.end() - 1,
                         [&](Vec2d a, Vec2d b) { return norm(a - here()) < norm(b - here()); });
    corners.pop_back();
    std::rotate(corners.begin(), corners.begin() + (nearest - corners.begin()), corners.end());
    corners.push_back(corners.front());
    return corners;
}

Vec2d GridPasses::here() const
{
    const Vec3d at = moves_.tip_at();
    return {at.x, at.y};
}

void GridPasses::approach(const std::vector<Vec2d>& corners)
{
    const Vec2d start = corners.front();
    const double longest = std::max(8 * pocket_.operation.tool.radius, 2 * pocket_.job.clearance);
    if (moves_.tip().started() && !moves_.lifted() && norm(start - here()) < longest &&
        pocket_.clear(here(), start)) {
        pocket_.finish.follow(moves_.tip(), {here(), start}, MoveKind::kCut);
        return;
    }
    const Cell middle = pocket_.grid.nearest(start);
    Vec2d cut{};
    double least = 1e300;
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
    if (least < 1e300) {
        moves_.enter(pocket_.finish, {cut, start}, pocket_.finish.start_height(cut));
        pocket_.finish.follow(moves_.tip(), {cut, start}, MoveKind::kCut);
        return;
    }
    moves_.enter(pocket_.finish, corners, pocket_.job.stock_top);
}

void GridPasses::wall_level(double plane)
{
    for (const Contour& contour : pocket_.centres.contours) {
        std::vector<Vec3d> run;
        const std::vector<Vec2d> corners = wall_corners(contour);
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const double length = norm(corners[i] - corners[i - 1]);
            const int pieces = std::max(1, static_cast<int>(length / pocket_.grid.gx()));
            for (int k = 0; k < pieces; ++k) {
                const auto at = [&](int n) {
                    const Vec2d p = corners[i - 1] + (corners[i] - corners[i - 1]) *
                                                         (static_cast<double>(n) / pieces);
                    return Vec3d{p.x, p.y, plane};
                };
                if (pocket_.rough.clearance(at(k), at(k + 1), 0) < -1e-6) {
                    cut_level(run);
                    continue;
                }
                if (run.empty()) {
                    run.push_back(at(k));
                }
                if (k > 0 && run.size() > 1) {
                    run.pop_back();
                }
                run.push_back(at(k + 1));
            }
        }
        cut_level(run);
    }
}

void GridPasses::cut_level(std::vector<Vec3d>& run)
{
    if (run.size() > 1) {
        // The wall's pass of the layer above has been here.
        const Vec3d at = moves_.tip_at();
        const bool level = at.z == run.front().z && pocket_.clear(here(), {run[0].x, run[0].y}) &&
                           pocket_.rough.clearance(at, run.front(), 0) >= -1e-6;
        if (level) {
            moves_.tip().line(MoveKind::kCut, run.front());
        } else {
            moves_.enter_level(run, std::min(pocket_.job.stock_top, last_plane_),
                               can_link(run.front()));
        }
        for (const Vec3d& p : run) {
            moves_.tip().line(MoveKind::kCut, p);
        }
        ++passes_;
    }
    run.clear();
}

}  // namespace cusp::host
