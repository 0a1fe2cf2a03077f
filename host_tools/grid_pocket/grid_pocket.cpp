// Puts the passes together: cells and heights first, then layers, navigation, wall and zigzags.
#include "host_tools/grid_pocket/grid_pocket.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "host_tools/grid_pocket/floor_follower.hpp"
#include "host_tools/grid_pocket/grid_input.hpp"
#include "host_tools/grid_pocket/grid_moves.hpp"
#include "host_tools/grid_pocket/grid_navigation.hpp"
#include "host_tools/grid_pocket/grid_roughness.hpp"

namespace cusp::host {
namespace {

// Beyond the radius, so that G-code rounded to its last digit still keeps it.
constexpr double kWallRounding = 5e-4;

constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

FollowSettings follow_settings(const Operation& operation)
{
    FollowSettings s;
    s.tolerance = std::max(operation.floor_tolerance, 1e-3);
    s.both_sides = operation.tolerance_side == ToleranceSide::kBoth;
    s.arcs = operation.output == OutputForm::kArcs;
    s.arc_tolerance = operation.arc_tolerance > 0 ? operation.arc_tolerance : s.tolerance;
    s.max_arc_radius = operation.max_arc_radius > 0 ? operation.max_arc_radius : 1e3;
    // Between places this far apart the tip's height rises over a chord by about an eighth of the
    // band.
    const double bend = std::sqrt(0.5 * std::max(operation.tool.corner_radius, 0.1) * s.tolerance);
    s.sample = std::min(std::max(operation.grid_x, operation.grid_y), bend);
    return s;
}

// Everything about the pocket that the passes share.
struct Pocket {
    const Job& job;
    const Operation& operation;
    double kept;  // mm from the axis to the walls
    RegionOffset walls;
    Region2d centres;
    CellGrid grid;
    SurfaceModel model;
    FloorFollower finish;
    FloorFollower rough;          // leaves the allowance
    std::vector<double> heights;  // finish heights over cells
    std::vector<double> rough_heights;

    Pocket(const Job& j, const Operation& o, const PocketWalls& pocket)
        : job{j},
          operation{o},
          kept{o.tool.radius + pocket.wall_error},
          walls{pocket.region},
          centres{walls.at(kept + kWallRounding)},
          grid{walls, o.grid_x, o.grid_y, kept},
          model{o.floor},
          finish{model, o.tool, 0, follow_settings(o)},
          rough{model, o.tool, o.allowance, follow_settings(o)}
    {
    }

    // Whether the axis may go straight from a to b: the distance from the walls changes by no more
    // than the way along the line.
    bool clear(Vec2d a, Vec2d b) const
    {
        const double length = norm(b - a);
        for (double s = 0; s < length;) {
            const double room = walls.clearance(a + (b - a) * (s / length)) - kept;
            if (room < -kOnTheWall) {
                return false;
            }
            s += std::max(room, kLeastStep);
        }
        return walls.clearance(b) >= kept - kOnTheWall;
    }

    bool clear(Cell a, Cell b) const { return clear(grid.centre(a), grid.centre(b)); }

private:
    static constexpr double kOnTheWall = 1e-4;
    static constexpr double kLeastStep = 0.01;
};

std::vector<double> heights_over(const Pocket& pocket, const FloorFollower& follower)
{
    std::vector<double> out(pocket.grid.size(), kNoHeight);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Cell c = pocket.grid.cell(i);
        if (!pocket.grid.inside(c)) {
            continue;
        }
        const Vec2d at = pocket.grid.centre(c);
        const auto height = follower.height(at);
        if (!height) {
            refuse_grid_pocket(pocket.job, "no floor lies under the pocket at x " +
                                               length_text(pocket.job, at.x) + ", y " +
                                               length_text(pocket.job, at.y));
        }
        out[i] = *height;
    }
    return out;
}

Navigation finish_navigation(const Pocket& pocket)
{
    NavigationRules rules;
    rules.free = [&](Cell c) {
        return pocket.grid.inside(c);
    };
    rules.clear_step = [&](Cell a, Cell b) {
        return pocket.clear(a, b);
    };
    rules.clear_link = rules.clear_step;
    return reversed(navigate(pocket.grid, rules));
}

Tracks tracks_of(const CellGrid& grid, const Navigation& navigation)
{
    Tracks tracks{grid};
    for (std::size_t i = 1; i < navigation.steps.size(); ++i) {
        if (navigation.steps[i].kind == StepKind::kNeighbour) {
            tracks.add(navigation.steps[i - 1].cell, navigation.steps[i].cell);
        }
    }
    return tracks;
}

// Steps between neighbours that only the zigzags along `axis` cut.
void add_zigzag(const Pocket& pocket, char axis, Tracks& tracks)
{
    for (std::size_t i = 0; i < pocket.grid.size(); ++i) {
        const Cell c = pocket.grid.cell(i);
        const Cell next = axis == 'x' ? Cell{c.column + 1, c.row} : Cell{c.column, c.row + 1};
        if (pocket.grid.inside(c) && pocket.grid.inside(next) && pocket.clear(c, next)) {
            tracks.add(c, next);
        }
    }
}

double roughness_of(const Pocket& pocket, const Navigation& navigation)
{
    Tracks tracks = tracks_of(pocket.grid, navigation);
    for (const char axis : pocket.operation.zigzag) {
        add_zigzag(pocket, axis, tracks);
    }
    return grid_roughness(pocket.grid, pocket.heights, tracks, pocket.operation.tool);
}

// A grid of the same shape that keeps max_roughness, tried out; the height between tracks goes with
// the square of their distance.
std::string grid_that_would_do(const Pocket& pocket, const PocketWalls& walls, double roughness)
{
    Operation finer = pocket.operation;
    for (int attempt = 0; attempt < 4; ++attempt) {
        const double factor = 0.98 * std::sqrt(*finer.max_roughness / roughness);
        finer.grid_x *= factor;
        finer.grid_y *= factor;
        if (static_cast<double>(pocket.grid.count_inside()) / (factor * factor) > 1e6) {
            break;
        }
        Pocket tried{pocket.job, finer, walls};
        tried.heights = heights_over(tried, tried.finish);
        roughness = roughness_of(tried, finish_navigation(tried));
        if (roughness <= *finer.max_roughness) {
            return "grid " + length_text(pocket.job, finer.grid_x) + " x " +
                   length_text(pocket.job, finer.grid_y) + " would do";
        }
    }
    return "grid " + length_text(pocket.job, finer.grid_x) + " x " +
           length_text(pocket.job, finer.grid_y) + " would be needed at least";
}

std::vector<double> layer_planes(const Pocket& pocket)
{
    double lowest = 1e300;
    for (const double z : pocket.rough_heights) {
        lowest = std::isnan(z) ? lowest : std::min(lowest, z);
    }
    std::vector<double> planes;
    const Operation& operation = pocket.operation;
    if (!operation.layers.empty()) {
        for (const double depth : operation.layers) {
            planes.push_back(pocket.job.stock_top - depth);
        }
    } else if (operation.max_depth) {
        // A layer leaves ridges between its tracks, and the finish meets the allowance: both add to
        // the next depth of cut.
        const double corner = operation.tool.corner_radius;
        const double half = std::min(corner, std::hypot(operation.grid_x, operation.grid_y) / 2);
        const double ridge = corner - std::sqrt(corner * corner - half * half);
        const double step =
            std::max(*operation.max_depth - ridge - operation.allowance, *operation.max_depth / 4);
        if ((pocket.job.stock_top - lowest) / step > 1e4) {
            refuse_grid_pocket(pocket.job, "max_depth " +
                                               length_text(pocket.job, *operation.max_depth) +
                                               " makes more than 10000 layers");
        }
        for (int i = 1; pocket.job.stock_top - i * step > lowest; ++i) {
            planes.push_back(pocket.job.stock_top - i * step);
        }
    }
    planes.erase(
        std::remove_if(planes.begin(), planes.end(), [&](double z) { return z <= lowest; }),
        planes.end());
    return planes;
}

class Planner {
public:
    Planner(Pocket& pocket, Toolpath& path)
        : pocket_{pocket},
          path_{path},
          moves_{path, pocket.job.stock_top + pocket.job.clearance, pocket.operation.entry,
                 pocket.operation.tool.radius},
          metal_(pocket.grid.size(), static_cast<float>(pocket.job.stock_top))
    {
    }

    void layer(double plane)
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
                moves_.enter_level(level_way(navigation, i, plane), metal_at(c));
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

    void main_path(const Navigation& navigation)
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

    void wall()
    {
        for (const Contour& contour : pocket_.centres.contours) {
            const std::vector<Vec2d> corners = wall_corners(contour);
            approach(corners);
            pocket_.finish.follow(moves_.tip(), corners, MoveKind::kCut);
            ++passes_;
        }
    }

    // Runs along the rows (or columns) over the steps that no track has cut yet, back and forth.
    void zigzag(char axis, Tracks& tracks)
    {
        const bool rows = axis == 'x';
        const int lines = rows ? pocket_.grid.rows() : pocket_.grid.columns();
        const int places = rows ? pocket_.grid.columns() : pocket_.grid.rows();
        bool forth = true;
        for (int line = 0; line < lines; ++line) {
            std::vector<std::pair<Cell, Cell>> runs;
            for (int k = 0; k + 1 < places; ++k) {
                const Cell a = rows ? Cell{k, line} : Cell{line, k};
                const Cell b = rows ? Cell{k + 1, line} : Cell{line, k + 1};
                if (!pocket_.grid.inside(a) || !pocket_.grid.inside(b) || !pocket_.clear(a, b)) {
                    continue;
                }
                const bool cut = rows ? tracks.east(a) : tracks.north(a);
                tracks.add(a, b);
                if (cut) {
                    continue;
                }
                if (!runs.empty() && runs.back().second == a) {
                    runs.back().second = b;
                } else {
                    runs.push_back({a, b});
                }
            }
            if (!forth) {
                std::reverse(runs.begin(), runs.end());
            }
            for (auto& [a, b] : runs) {
                const std::vector<Vec2d> corners{pocket_.grid.centre(forth ? a : b),
                                                 pocket_.grid.centre(forth ? b : a)};
                approach(corners);
                pocket_.finish.follow(moves_.tip(), corners, MoveKind::kCut);
                ++passes_;
            }
            forth = runs.empty() ? forth : !forth;
        }
    }

    void finish() { moves_.retract(); }
    std::size_t main_moves() const { return main_moves_; }
    int backtracks() const { return backtracks_; }
    int dead_ends() const { return dead_ends_; }
    int passes() const { return passes_; }
    int steps() const { return steps_; }
    int retracts() const { return moves_.retracts(); }
    int plunges() const { return moves_.plunges(); }

private:
    Pocket& pocket_;
    Toolpath& path_;
    GridMoves moves_;
    std::vector<float> metal_;  // top of what stands over each cell
    double last_plane_{1e300};
    std::size_t main_moves_{0};
    int backtracks_{0};
    int dead_ends_{0};
    int passes_{0};
    int steps_{0};

    double metal_at(Cell c) const { return static_cast<double>(metal_[pocket_.grid.index(c)]); }

    void count(const Navigation& navigation)
    {
        backtracks_ += navigation.backtracks;
        dead_ends_ += navigation.dead_ends;
        steps_ += static_cast<int>(navigation.steps.size());
        passes_ += static_cast<int>(
            std::count_if(navigation.steps.begin(), navigation.steps.end(),
                          [](const NavigationStep& s) { return s.kind == StepKind::kEnter; }));
    }

    // True where the steps before and after `i` go the same way, one cell each.
    static bool straight(const Navigation& navigation, std::size_t i)
    {
        const Cell a = navigation.steps[i - 1].cell;
        const Cell b = navigation.steps[i].cell;
        const Cell c = navigation.steps[i + 1].cell;
        return b.column - a.column == c.column - b.column && b.row - a.row == c.row - b.row;
    }

    bool clear_at(double plane, Cell a, Cell b) const
    {
        if (!pocket_.clear(a, b)) {
            return false;
        }
        const Vec2d from = pocket_.grid.centre(a);
        const Vec2d to = pocket_.grid.centre(b);
        return pocket_.rough.clearance({from.x, from.y, plane}, {to.x, to.y, plane}, 0) >= -1e-6;
    }

    std::vector<Vec3d> level_way(const Navigation& navigation,
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

    std::vector<Vec2d> wall_corners(const Contour& contour) const
    {
        // Boundary loops have the pocket on their left: counter-clockwise, as in the paper, which
        // with a spindle that turns clockwise leaves the wall on the right and climbs.
        const bool climb = pocket_.operation.direction_of_cut == CutDirection::kClimb;
        const Contour loop = climb ? contour : reversed(contour);
        std::vector<Vec2d> corners{loop.front().start};
        for (const Edge& edge : loop) {
            int pieces = 1;
            if (edge.turn != 0) {
                // Chords around a corner of the wall may take up what rounding and free curves
                // leave.
                const double sagitta =
                    std::max(pocket_.operation.plan_tolerance / 4, kWallRounding / 2);
                const double step = 2 * std::sqrt(2 * std::min(sagitta / edge.radius, 0.5));
                pieces = static_cast<int>(std::ceil(sweep(edge) / step));
            }
            append_arc(edge, pieces, corners);
        }
        const auto nearest =
            std::min_element(corners.begin(), corners.end() - 1,
                             [&](Vec2d a, Vec2d b) { return norm(a - here()) < norm(b - here()); });
        corners.pop_back();
        std::rotate(corners.begin(), corners.begin() + (nearest - corners.begin()), corners.end());
        corners.push_back(corners.front());
        return corners;
    }

    // Where the arc goes around a corner of the wall its chords are tangents, which stay outside.
    static void append_arc(const Edge& edge, int pieces, std::vector<Vec2d>& corners)
    {
        const double half = pieces > 0 ? sweep(edge) / pieces / 2 : 0;
        for (int i = 0; edge.turn != 0 && i < pieces; ++i) {
            const Vec2d on = point_on(edge, (i + 0.5) / pieces);
            corners.push_back(edge.centre + (on - edge.centre) * (1 / std::cos(half)));
        }
        corners.push_back(edge.end);
    }

    Vec2d here() const
    {
        const Vec3d at = moves_.tip_at();
        return {at.x, at.y};
    }

    // To the first corner: along the floor where the way is clear, else over the clearance height.
    void approach(const std::vector<Vec2d>& corners)
    {
        const double longest =
            std::max(8 * pocket_.operation.tool.radius, 2 * pocket_.job.clearance);
        if (moves_.tip().started() && !moves_.lifted() &&
            norm(corners.front() - here()) < longest && pocket_.clear(here(), corners.front())) {
            pocket_.finish.follow(moves_.tip(), {here(), corners.front()}, MoveKind::kCut);
            return;
        }
        // The main path has cut every cell: over any other place stands at most what it left there.
        moves_.enter(pocket_.finish, corners,
                     pocket_.finish.start_height(corners.front()) + pocket_.operation.tool.radius);
    }

    // Along the wall where the floor lies below the plane.
    void wall_level(double plane)
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

    void cut_level(std::vector<Vec3d>& run)
    {
        if (run.size() > 1) {
            // The wall's pass of the layer above has been here.
            const Vec3d at = moves_.tip_at();
            const bool level = at.z == run.front().z &&
                               pocket_.clear(here(), {run[0].x, run[0].y}) &&
                               pocket_.rough.clearance(at, run.front(), 0) >= -1e-6;
            if (level) {
                moves_.tip().line(MoveKind::kCut, run.front());
            } else {
                moves_.enter_level(run, std::min(pocket_.job.stock_top, last_plane_));
            }
            for (const Vec3d& p : run) {
                moves_.tip().line(MoveKind::kCut, p);
            }
            ++passes_;
        }
        run.clear();
    }
};

}  // namespace

std::vector<PlannedOperation> plan_grid_pocket(const Job& job, const Operation& operation)
{
    const auto start = std::chrono::steady_clock::now();
    check_grid_input(job, operation);
    const PocketWalls walls = pocket_walls(job, operation);
    Pocket pocket{job, operation, walls};
    const std::size_t cells = pocket.grid.count_inside();
    if (cells == 0) {
        refuse_grid_pocket(job, "no cell of the pocket is " + length_text(job, pocket.kept) +
                                    " from its walls: the tool does not fit");
    }
    pocket.heights = heights_over(pocket, pocket.finish);
    const Navigation navigation = finish_navigation(pocket);
    const double roughness = roughness_of(pocket, navigation);
    if (operation.max_roughness && roughness > *operation.max_roughness) {
        refuse_grid_pocket(job, "roughness " + length_text(job, roughness) +
                                    " is over max_roughness " +
                                    length_text(job, *operation.max_roughness) + "; " +
                                    grid_that_would_do(pocket, walls, roughness));
    }
    PlannedOperation out;
    out.path.tool = operation.tool;
    out.path.feed = job.feed;
    out.path.plunge_feed = job.plunge_feed;
    out.path.spindle = job.spindle;
    Planner planner{pocket, out.path};
    std::vector<double> planes;
    if (!operation.layers.empty() || operation.max_depth) {
        pocket.rough_heights =
            operation.allowance > 0 ? heights_over(pocket, pocket.rough) : pocket.heights;
        planes = layer_planes(pocket);
        for (const double plane : planes) {
            planner.layer(plane);
        }
    }
    planner.main_path(navigation);
    const std::size_t main_moves = planner.main_moves();
    planner.wall();
    Tracks tracks = tracks_of(pocket.grid, navigation);
    for (const char axis : operation.zigzag) {
        planner.zigzag(axis, tracks);
    }
    planner.finish();
    OperationStats& stats = out.stats;
    stats.strategy = "grid_pocket";
    stats.passes = planner.passes();
    stats.levels = static_cast<int>(planes.size()) + 1;
    stats.cl_points = static_cast<int>(out.path.moves.size());
    stats.retracts = planner.retracts();
    stats.gouge_bound_mm = pocket.finish.gouge_bound();
    const FollowSettings settings = follow_settings(operation);
    stats.scallop_bound_mm =
        roughness + (settings.arcs ? settings.arc_tolerance : settings.tolerance);
    stats.counts = {{"cells", static_cast<double>(cells)},
                    {"steps", planner.steps()},
                    {"dead_ends", planner.dead_ends()},
                    {"backtracks", planner.backtracks()},
                    {"main_path_moves", static_cast<double>(main_moves)},
                    {"layers", static_cast<double>(planes.size())},
                    {"roughness_mm", roughness}};
    out.path.comments = {"grid_pocket: " + std::to_string(cells) + " cells, roughness " +
                         length_text(job, roughness) + ", gouge at most " +
                         length_text(job, stats.gouge_bound_mm)};
    if (planner.plunges() > 0) {
        stats.warnings.push_back(std::to_string(planner.plunges()) +
                                 " entries plunge straight down");
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    stats.planning_s = spent.count();
    std::vector<PlannedOperation> result;
    result.push_back(std::move(out));
    return result;
}

}  // namespace cusp::host
