// Balls by exact distances, other ends and scallops by maps of heights.
#include <algorithm>
#include <map>

#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/judge/verify/finished_ground.hpp"
#include "host_tools/judge/verify/floor_judgement.hpp"
#include "host_tools/judge/verify/part_heights.hpp"
#include "host_tools/judge/verify/pocket_boundaries.hpp"
#include "host_tools/judge/verify/verdict.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

namespace cusp::verify {

using job::Job;
using job::Operation;
using part_model::PartModel;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// The tools that have to leave the scallop: a larger roughing tool may cut deeper into a valley
// than they can. All tools that cut if no operation has a scallop.
std::vector<Tool> finishing_tools(const Job& job, const std::vector<ToolPositions>& runs)
{
    std::vector<Tool> all;
    std::vector<Tool> finishing;
    for (const ToolPositions& run : runs) {
        all.push_back(run.tool);
        const bool owes =
            std::any_of(job.operations.begin(), job.operations.end(), [&](const Operation& o) {
                return o.tolerance.scallop.has_value() && o.tool.number == run.tool.number;
            });
        if (owes) {
            finishing.push_back(run.tool);
        }
    }
    return finishing.empty() ? all : finishing;
}

// Depth of gouges by balls, by exact distances.
std::optional<double> ball_gouge(const Scene& scene,
                                 const std::vector<ToolPositions>& runs,
                                 double top,
                                 std::optional<FaultPlace>& at)
{
    const PartModel model{scene.surfaces};
    const PartModel mesh{scene.mesh};
    std::optional<double> deepest;
    for (const ToolPositions& run : runs) {
        if (run.tool.shape != ToolShape::kBall) {
            continue;
        }
        deepest = deepest.value_or(0.0);
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const Vec3d tip = run.tips[k];
            const double depth = tip.z < top
                                     ? std::max(-model.distance(run.tool, tip, 0.0).distance,
                                                -mesh.distance(run.tool, tip, 0.0).distance)
                                     : 0.0;
            if (depth > *deepest) {
                deepest = depth;
                at = {tip, run.lines[k], run.tool.number};
            }
        }
    }
    return deepest;
}

// mm: the thickness that may be left anywhere, with the error between positions.
double most_left(const Scene& scene, const std::vector<Tool>& tools, double spacing)
{
    double least = tools.front().radius;
    for (const Tool& tool : tools) {
        least = std::min(least, tool.corner_radius > 0 ? tool.corner_radius : tool.radius);
    }
    return scene.scallop.value_or(0) + scene.floor_tolerance + kJudgement +
           spacing * spacing / (8 * least);
}

// The operations on surfaces that use the tool and have no walls.
std::vector<const Operation*> open_operations(const Job& job, const Tool& tool)
{
    std::vector<const Operation*> out;
    for (const Operation& o : job.operations) {
        const auto is_it = [&](const Tool& other) {
            return other.number == tool.number;
        };
        if (!o.prismatic && (is_it(o.tool) || std::any_of(o.tools.begin(), o.tools.end(), is_it)) &&
            (!o.outline.boundary || job::finishes_ground(o))) {
            out.push_back(&o);
        }
    }
    return out;
}

double wall_gouge(const Job& job,
                  const HeightGrid& grid,
                  const PocketBoundaries& walls,
                  const std::vector<ToolPositions>& runs,
                  double top,
                  std::optional<FaultPlace>& at)
{
    double worst = 0;
    std::map<const Operation*, FinishedGround> grounds;
    for (const ToolPositions& run : runs) {
        const std::vector<const Operation*> open = open_operations(job, run.tool);
        if (!std::all_of(open.begin(), open.end(),
                         [](const Operation* o) { return stays_with_ground(*o); })) {
            continue;
        }
        std::vector<std::vector<char>> finished;
        for (const Operation* o : open) {
            auto ground = grounds.find(o);
            if (ground == grounds.end()) {
                const PartHeights part = part_heights(o->part.floor, o->part.mesh, grid);
                ground = grounds.emplace(o, FinishedGround{*o, part.z, grid}).first;
            }
            finished.push_back(whole_cuts(run, top, [&](Vec3d tip) {
                return ground->second.room(tip.x, tip.y) >= run.tool.radius;
            }));
        }
        const auto is_finished = [&](std::size_t k) {
            return std::any_of(finished.begin(), finished.end(),
                               [k](const std::vector<char>& own) { return own[k] != 0; });
        };
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const Vec3d tip = run.tips[k];
            const double depth =
                tip.z < top - 1e-9 ? run.tool.radius - walls.at(tip.x, tip.y) : 0.0;
            if (depth > worst && !is_finished(k)) {
                worst = depth;
                at = {tip, run.lines[k], run.tool.number};
            }
        }
    }
    return worst;
}

PocketBoundaries boundaries_of(const Verifying& work)
{
    double widest = 0;
    for (const ToolPositions& run : work.runs) {
        widest = std::max(widest, run.tool.radius);
    }
    PocketBoundaries walls;
    for (const Wall& wall : work.scene.walls) {
        walls.add(wall.boundary,
                  WallDistance{wall.loop, wall.outer, widest + 2 * work.result.grid.pitch});
    }
    return walls;
}

}  // namespace

void judge_surfaces(Verifying& work)
{
    const Scene& scene = work.scene;
    if (!scene.has_floor() && scene.has_levels) {
        return;
    }
    const std::vector<ToolPositions>& runs = work.runs;
    const double top = work.job.stock_top;
    const PocketBoundaries walls = boundaries_of(work);
    const std::vector<Tool> tools = finishing_tools(work.job, runs);
    const OwedGround owed{work.job};
    Verification& result = work.result;
    VerifyFigures& figures = result.figures;
    if (!walls.empty()) {
        figures.wall_gouge_max =
            wall_gouge(work.job, result.grid, walls, runs, top, figures.wall_gouge_at);
    }
    figures.ball_gouge_max = ball_gouge(scene, runs, top, figures.ball_gouge_at);
    FloorMaps maps = judge_floor(
        {scene.surfaces, scene.mesh, tools, walls, result.grid, work.heights, top, *work.before,
         owed, scene.scallop, scene.path_clearance, runs, most_left(scene, tools, work.spacing)},
        figures);
    result.left = std::move(maps.left);
    result.gouge = std::move(maps.gouge);
    result.part = std::move(maps.part);
}

}  // namespace cusp::verify
