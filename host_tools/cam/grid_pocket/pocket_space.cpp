// Moves are decided by distances: along a line the distance from the walls changes no faster than
// the position.
#include "host_tools/cam/grid_pocket/pocket_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"

namespace cusp::grid_pocket {

using job::Job;
using job::Operation;
using job::OutputForm;
using job::ToleranceSide;
using offset::Contour;
using offset::Edge;

namespace {

constexpr double kHeightsShare = 0.15;  // of the planning time
// Share of max_depth for the distance of layers: where even that is too deep, passes are added.
constexpr double kLeastStep = 0.85;

// Bends of links around an arc of the wall pass: the intersections of its tangents, one for each
// third of a turn; near wide corners also points on the arc, for narrow pockets.
void add_corner(const Edge& arc, std::vector<Vec2d>& out)
{
    constexpr double kLeastSweep = 0.1;  // flatter arcs belong to a curved wall
    constexpr double kMostSweep = 2.1;
    constexpr double kOutside = 1e-3;  // mm
    const double angle = sweep(arc);
    if (angle < kLeastSweep) {
        return;
    }
    const int pieces = 1 + static_cast<int>(angle / kMostSweep);
    for (int i = 0; i < pieces; ++i) {
        const Vec2d middle = point_on(arc, (i + 0.5) / pieces);
        const Vec2d out_of_centre = (middle - arc.centre) * (1 / arc.radius);
        const double apex = arc.radius / elementary::cos(angle / pieces / 2) + kOutside;
        out.push_back(arc.centre + out_of_centre * apex);
    }
    for (const double share : {0.0, 0.5, 1.0}) {
        const Vec2d on = point_on(arc, share);
        out.push_back(on + (on - arc.centre) * (kOutside / arc.radius));
    }
}

// Extra height of the stock beside a new track between cells, compared with a repeated one, since
// the tool was only at the cells.
double ridge_over_tracks(const Operation& operation)
{
    const double corner = operation.tool.corner_radius;
    const auto rise = [&](double along, double across) {
        const double beside = std::max(0.0, corner * corner - across * across / 4);
        return std::sqrt(beside) - std::sqrt(std::max(0.0, beside - along * along / 4));
    };
    return std::max(rise(grid_keys(operation).grid_x, grid_keys(operation).grid_y),
                    rise(grid_keys(operation).grid_y, grid_keys(operation).grid_x));
}

// Bisects the half with the larger step until it is too short to be a slope.
Cliff steepest_between(const ClPathFitter& floor, Vec2d a, Vec2d b)
{
    constexpr double kNoSlope = 0.01;  // mm
    double za = floor.start_height(a);
    double zb = floor.start_height(b);
    while (norm(b - a) > kNoSlope) {
        const Vec2d middle = (a + b) * 0.5;
        const double z = floor.start_height(middle);
        if (std::abs(z - za) > std::abs(zb - z)) {
            b = middle;
            zb = z;
        } else {
            a = middle;
            za = z;
        }
    }
    return {a, std::abs(zb - za)};
}

// Steps between neighbours that are cut only by zigzags along `axis`.
void add_zigzag(const PocketSpace& pocket, char axis, Tracks& tracks)
{
    for (std::size_t i = 0; i < pocket.grid.size(); ++i) {
        const Cell c = pocket.grid.cell(i);
        const Cell next = axis == 'x' ? Cell{c.column + 1, c.row} : Cell{c.column, c.row + 1};
        if (pocket.grid.inside(c) && pocket.grid.inside(next) && pocket.clear(c, next)) {
            tracks.add(c, next);
        }
    }
}

}  // namespace

double roughing_allowance(const Operation& operation)
{
    constexpr double kOfRadius = 0.1;  // over the pitch of the map
    constexpr double kOfDepth = 0.25;  // most, of max_depth
    if (!operation.passes.max_engagement) {
        return operation.passes.allowance;
    }
    return std::max(operation.passes.allowance,
                    std::min(kOfRadius * operation.tool.radius,
                             kOfDepth * operation.levels.max_depth.value_or(kUnbounded)));
}

FollowSettings follow_settings(const Operation& operation)
{
    FollowSettings s;
    s.tolerance = std::max(operation.tolerance.floor, 1e-3);
    s.both_sides = operation.tolerance.side == ToleranceSide::kBoth;
    s.arcs = operation.output == OutputForm::kArcs;
    s.arc_tolerance =
        grid_keys(operation).arc_tolerance > 0 ? grid_keys(operation).arc_tolerance : s.tolerance;
    s.max_arc_radius =
        grid_keys(operation).max_arc_radius > 0 ? grid_keys(operation).max_arc_radius : 1e3;
    // At this distance of samples the tip's height rises above a chord by about an eighth of the
    // band.
    const double bend = std::sqrt(0.5 * bend_radius(operation.tool) * band_height(s));
    s.sample = std::min(std::max(grid_keys(operation).grid_x, grid_keys(operation).grid_y), bend);
    return s;
}

PocketSpace::PocketSpace(const Job& j, const Operation& o, const PocketWalls& pocket)
    : job{j},
      operation{o},
      kept{o.tool.radius + pocket.wall_error},
      rough_allowance{roughing_allowance(o)},
      walls{pocket.region},
      centres{walls.at(kept + kWallRounding)},
      centre_edges{edges_of(centres)},
      grid{walls, grid_keys(o).grid_x, grid_keys(o).grid_y, kept},
      finish{o.part.floor, o.tool, 0, follow_settings(o)},
      rough{rough_allowance > 0
                ? ClPathFitter{o.part.floor, o.tool, rough_allowance, follow_settings(o)}
                : finish}
{
}

Vec2d PocketSpace::on_wall_pass(Vec2d p) const { return centre_edges.nearest_edge(p).point; }

bool PocketSpace::clear(Vec2d a, Vec2d b) const
{
    constexpr double kOnTheWall = 1e-4;
    constexpr double kLeastStep = 0.01;
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

void PocketSpace::add_clearances(NavigationRules& rules) const
{
    rules.clear_step = [this](Cell a, Cell b) {
        return clear(a, b);
    };
    rules.clear_link = [this](Vec2d a, Vec2d b) {
        return clear(a, b);
    };
    for (const Contour& contour : centres.contours) {
        for (const Edge& edge : contour) {
            // The wall pass goes clockwise around corners of the wall.
            if (edge.turn < 0) {
                add_corner(edge, rules.corners);
            }
        }
    }
}

std::vector<double> heights_over(const PocketSpace& pocket, const ClPathFitter& follower)
{
    std::vector<double> out(pocket.grid.size(), kNoValue);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Cell c = pocket.grid.cell(i);
        if (c.column == 0) {
            pocket.job.report_progress(kHeightsShare * static_cast<double>(i) /
                                       static_cast<double>(out.size()));
        }
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

Navigation finish_navigation(const PocketSpace& pocket)
{
    NavigationRules rules;
    rules.free = [&](Cell c) {
        return pocket.grid.inside(c);
    };
    pocket.add_clearances(rules);
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

double roughness_of(const PocketSpace& pocket, const Navigation& navigation)
{
    Tracks tracks = tracks_of(pocket.grid, navigation);
    for (const char axis : grid_keys(pocket.operation).zigzag) {
        add_zigzag(pocket, axis, tracks);
    }
    const TipSurface surface{pocket.heights, [&](Vec2d p) { return pocket.finish.height(p); },
                             [&](Vec2d p) { return pocket.walls.clearance(p) - pocket.kept; },
                             [&](Vec2d p) {
                                 return pocket.on_wall_pass(p);
                             }};
    return grid_roughness(pocket.grid, surface, tracks, pocket.operation.tool);
}

std::optional<Cliff> highest_cliff(const PocketSpace& pocket)
{
    std::optional<Cliff> highest;
    const CellGrid& grid = pocket.grid;
    const auto look = [&](Cell a, Cell b) {
        if (!grid.inside(a) || !grid.inside(b)) {
            return;
        }
        const double step = std::abs(pocket.heights[grid.index(a)] - pocket.heights[grid.index(b)]);
        if (step > std::max(pocket.operation.tool.radius, highest ? highest->height : 0.0)) {
            const Cliff found = steepest_between(pocket.finish, grid.centre(a), grid.centre(b));
            if (found.height >
                std::max(pocket.operation.tool.radius, highest ? highest->height : 0.0)) {
                highest = found;
            }
        }
    };
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Cell c = grid.cell(i);
        look(c, {c.column + 1, c.row});
        look(c, {c.column, c.row + 1});
    }
    return highest;
}

double lowest_of_tip(const PocketSpace& pocket)
{
    double lowest = kUnbounded;
    for (const double z : pocket.rough_heights) {
        lowest = std::isnan(z) ? lowest : std::min(lowest, z);
    }
    for (const Edge& edge : edges_of(pocket.centres)) {
        for (const Vec2d p : {edge.start, point_on(edge, 0.5)}) {
            lowest = std::min(lowest, pocket.rough.height(p).value_or(lowest));
        }
    }
    return lowest;
}

LayerPlanes layer_planes(const PocketSpace& pocket)
{
    const double lowest = lowest_of_tip(pocket);
    std::vector<double> planes;
    const Operation& operation = pocket.operation;
    if (!operation.levels.layers.empty()) {
        for (const double depth : operation.levels.layers) {
            planes.push_back(pocket.job.stock_top - depth);
        }
    } else if (operation.levels.max_depth) {
        // A layer leaves scallops between its tracks, is above the floor by its tolerance, and the
        // finish also cuts the allowance: all add to the next depth of cut.
        const double scallop_height = ridge_over_tracks(operation);
        const FollowSettings follow = follow_settings(operation);
        const double over = band_height(follow) * (follow.both_sides ? 2 : 1);
        // With min_depth, more passes may be added to keep max_depth.
        const double step = std::max(
            {*operation.levels.max_depth - scallop_height - over - operation.passes.allowance,
             *operation.levels.max_depth * kLeastStep, operation.levels.min_depth.value_or(0)});
        if ((pocket.job.stock_top - lowest) / step > 1e4) {
            refuse_grid_pocket(pocket.job,
                               "max_depth " + length_text(pocket.job, *operation.levels.max_depth) +
                                   " makes more than 10000 layers");
        }
        for (int i = 1; pocket.job.stock_top - i * step > lowest; ++i) {
            planes.push_back(pocket.job.stock_top - i * step);
        }
    }
    const auto below =
        std::remove_if(planes.begin(), planes.end(), [&](double z) { return z <= lowest; });
    const auto left_out = static_cast<int>(planes.end() - below);
    planes.erase(below, planes.end());
    return {std::move(planes), left_out, lowest};
}

}  // namespace cusp::grid_pocket
