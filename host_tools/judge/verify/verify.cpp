// Reads the program, cuts the stock tool by tool, and evaluates every bound.
#include "host_tools/judge/verify/verify.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/job/fixture_clearance.hpp"
#include "host_tools/judge/verify/cut_regions.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/engagement_windows.hpp"
#include "host_tools/judge/verify/floor_judgement.hpp"
#include "host_tools/judge/verify/level_judgement.hpp"
#include "host_tools/judge/verify/pocket_boundaries.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"
#include "host_tools/judge/verify/verdict.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;
using job::Loop;
using job::Operation;
using job::ToleranceSide;
using nurbs::Surface;
using part_model::PartModel;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// Share of the floor that may be above the scallop bound: the corners between loops.
constexpr double kUncoveredAllowed = 0.01;

struct Wall {
    std::string boundary;  // the pocket's; empty where it has none
    Loop loop;
    bool outer;  // the boundary itself
};

// The parts and walls of all operations, each file once.
struct Scene {
    std::vector<Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> mesh;
    std::vector<Wall> walls;
    double floor_tolerance{};
    double plan_tolerance{};
    std::optional<double> scallop;
    double path_clearance{};  // mm: the floor tolerance where it is one-sided
    bool has_levels{false};   // some operation is 2.5-D

    bool has_floor() const { return !surfaces.empty() || !mesh.empty(); }
};

Scene scene_of(const Job& job)
{
    Scene scene;
    using Files = std::vector<std::string>;
    std::set<std::pair<Files, Files>> floors;
    std::set<Files> meshes;
    std::set<std::string> boundaries;
    std::set<std::pair<std::string, std::string>> islands;  // each of its boundary
    for (const Operation& operation : job.operations) {
        scene.floor_tolerance = std::max(scene.floor_tolerance, operation.tolerance.floor);
        scene.plan_tolerance = std::max(scene.plan_tolerance, operation.tolerance.plan);
        if (operation.prismatic) {
            scene.has_levels = true;
            continue;
        }
        if (!operation.part.mesh.empty()) {
            if (meshes.insert(operation.part.floor_files).second) {
                scene.mesh.insert(scene.mesh.end(), operation.part.mesh.begin(),
                                  operation.part.mesh.end());
            }
        } else if (floors.insert({operation.part.floor_files, operation.part.intersect_files})
                       .second) {
            scene.surfaces.insert(scene.surfaces.end(), operation.part.floor.begin(),
                                  operation.part.floor.end());
        }
        const std::string pocket =
            operation.outline.boundary ? operation.outline.boundary_file : "";
        if (operation.outline.boundary && boundaries.insert(pocket).second) {
            scene.walls.push_back({pocket, *operation.outline.boundary, true});
        }
        for (std::size_t i = 0; i < operation.outline.islands.size(); ++i) {
            if (islands.emplace(pocket, operation.outline.island_files[i]).second) {
                scene.walls.push_back({pocket, operation.outline.islands[i], false});
            }
        }
        if (operation.tolerance.scallop) {
            scene.scallop = operation.tolerance.scallop;
            scene.path_clearance =
                operation.tolerance.side == ToleranceSide::kOutside ? operation.tolerance.floor : 0;
        }
    }
    return scene;
}

const Tool& tool_of(const Job& job, int number, const std::string& program)
{
    if (number == 0) {
        return job.tools.front();
    }
    for (const Tool& tool : job.tools) {
        if (tool.number == number) {
            return tool;
        }
    }
    throw InputError(fmt::format("{}: T{} is no tool of the job {}", program, number, job.file));
}

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

ToolFigures& figures_of(const Tool& tool, VerifyFigures& figures)
{
    for (ToolFigures& known : figures.tools) {
        if (known.tool.number == tool.number) {
            return known;
        }
    }
    figures.tools.push_back({tool});
    return figures.tools.back();
}

// Runs of positions, a new one at every change of tool; adds up lengths.
std::vector<ToolPositions> positions_of(const Job& job,
                                        const Program& program,
                                        const std::string& file,
                                        double spacing,
                                        VerifyFigures& figures)
{
    std::vector<ToolPositions> runs;
    int current = -1;
    for (std::size_t k = 0; k < program.moves.size(); ++k) {
        const ProgramMove& m = program.moves[k];
        if (m.tool != current) {
            current = m.tool;
            runs.push_back({tool_of(job, m.tool, file), {}, {}});
        }
        const bool rapid = m.move.kind == path::MoveKind::kRapid;
        ToolPositions& run = runs.back();
        if (k == 0) {  // the machine's start position is unknown
            run.tips.push_back(to_millimetres(m.move.end));
        } else {
            const double length = path::length(m.move);
            (rapid ? figures.rapid_length : figures.cut_length) += length;
            if (!rapid) {
                figures_of(run.tool, figures).cut_length += length;
            }
            append_points(m.move, spacing, run.tips);
        }
        run.rapid.resize(run.tips.size(), rapid);
        run.lines.resize(run.tips.size(), m.move.line);
    }
    return runs;
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

double wall_gouge(const PocketBoundaries& walls,
                  const std::vector<ToolPositions>& runs,
                  double top,
                  std::optional<FaultPlace>& at)
{
    double worst = 0;
    for (const ToolPositions& run : runs) {
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const Vec3d tip = run.tips[k];
            const double depth =
                tip.z < top - 1e-9 ? run.tool.radius - walls.at(tip.x, tip.y) : 0.0;
            if (depth > worst) {
                worst = depth;
                at = {tip, run.lines[k], run.tool.number};
            }
        }
    }
    return worst;
}

// At the tips of all runs, which lie within `spacing`.
void find_fixture_hits(const Job& job,
                       const std::vector<ToolPositions>& runs,
                       VerifyFigures& figures)
{
    for (const job::Fixture& fixture : job.fixtures) {
        double& deepest = figures.fixture_hit_max.emplace(figures.fixture_hit_max.value_or(0));
        for (const ToolPositions& run : runs) {
            for (const Vec3d tip : run.tips) {
                const double inside = -distance_to(fixture, run.tool.radius, tip);
                if (inside > deepest) {
                    deepest = inside;
                    figures.fixture_hit_at = fmt::format("{} at x {:.3f} y {:.3f} z {:.3f}",
                                                         fixture.name, tip.x, tip.y, tip.z);
                }
            }
        }
    }
}

void add_contacts(const Job& job,
                  const ToolPositions& run,
                  const std::vector<BodyContact>& found,
                  std::vector<ContactFigures>& figures)
{
    for (const BodyContact& contact : found) {
        const auto known = std::find_if(figures.begin(), figures.end(),
                                        [&](const auto& f) { return f.part == contact.part; });
        ContactFigures& worst =
            known != figures.end() ? *known : figures.emplace_back(ContactFigures{contact.part});
        if (contact.depth > worst.depth) {
            worst = {contact.part,
                     contact.depth,
                     run.tips[contact.position],
                     run.lines[contact.position],
                     run.tool.number,
                     long_enough(job, run.tool, contact)};
        }
    }
}

// Cuts the stock run by run; fills the figures of depths, contacts and the engagement if it is wanted.
void cut_stock(const Job& job,
               const std::vector<ToolPositions>& runs,
               double spacing,
               bool engagement,
               const Progress& progress,
               MachinedStock& stock,
               Verification& result)
{
    VerifyFigures& figures = result.figures;
    for (const ToolPositions& run : runs) {
        figures.tool_positions += run.tips.size();
    }
    std::size_t done = 0;
    for (const ToolPositions& run : runs) {
        std::optional<EngagementTrace> trace;
        if (engagement) {
            trace.emplace(result.grid, run);
        }
        ContactTrace contact{result.grid, run, tool_discs(job, run.tool, kProgramSlack),
                             stock_around(job, result.grid)};
        const CutFigures cut = stock.cut(
            run, spacing,
            [&](double share) {
                progress(
                    (static_cast<double>(done) + share * static_cast<double>(run.tips.size())) /
                    static_cast<double>(figures.tool_positions));
            },
            trace ? &*trace : nullptr, contact.is_idle() ? nullptr : &contact);
        add_contacts(job, run, contact.finish(), figures.contacts);
        if (trace) {
            result.engagement.push_back(trace->finish());
        }
        done += run.tips.size();
        const DeepRapid* rapid = cut.deepest_rapid();
        if (rapid != nullptr && rapid->depth > figures.rapid_cut_max) {
            figures.rapid_cut_at = {run.tips[rapid->position], run.lines[rapid->position],
                                    run.tool.number};
        }
        figures.rapid_cut_max = std::max(figures.rapid_cut_max, cut.rapid_cut);
        figures.cut_depth_max = std::max(figures.cut_depth_max, cut.cut_depth);
        if (cut.cut_depth > 0) {
            double& of_tool = figures_of(run.tool, figures).cut_depth_max;
            of_tool = std::max(of_tool, cut.cut_depth);
        }
    }
}

void sum_engagement(const Job& job,
                    const std::vector<ToolPositions>& runs,
                    const VerifySettings& settings,
                    double spacing,
                    double removed_volume,
                    Verification& result)
{
    EngagementFigures& figures = result.figures.engagement.emplace();
    std::vector<std::optional<double>> limits;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        limits.push_back(engagement_limit(job, runs[k].tool, settings.max_engagement));
        set_limit(runs[k].tool, limits[k], result.grid.pitch, result.engagement[k]);
    }
    if (!settings.pitch) {
        look_closer(job, result.grid, spacing, runs, result.engagement);
    }
    for (std::size_t k = 0; k < runs.size(); ++k) {
        add_engagement(runs[k], limits[k], result.engagement[k], figures);
    }
    figures.removed_volume = removed_volume;
    figures.seconds = programmed_seconds(result.program);
}

// Judges surfaces and their walls; fills the maps.
void judge_surfaces(const Job& job,
                    const Scene& scene,
                    const std::vector<ToolPositions>& runs,
                    const PocketBoundaries& walls,
                    const std::vector<Tool>& tools,
                    double spacing,
                    const std::vector<double>& heights,
                    Verification& result)
{
    VerifyFigures& figures = result.figures;
    if (!walls.empty()) {
        figures.wall_gouge_max = wall_gouge(walls, runs, job.stock_top, figures.wall_gouge_at);
    }
    figures.ball_gouge_max = ball_gouge(scene, runs, job.stock_top, figures.ball_gouge_at);
    FloorMaps maps =
        judge_floor({scene.surfaces, scene.mesh, tools, walls, result.grid, heights, job.stock_top,
                     scene.scallop, scene.path_clearance, runs, most_left(scene, tools, spacing)},
                    figures);
    result.left = std::move(maps.left);
    result.gouge = std::move(maps.gouge);
    result.part = std::move(maps.part);
}

// Judges 2.5-D operations. In their regions surfaces of other operations do not limit the depth, so
// these figures of gouges replace those of the surfaces.
void add_levels(const Job& job,
                const Scene& scene,
                const std::string& program_file,
                const std::vector<ToolPositions>& runs,
                const StandingStock& before,
                const std::vector<double>& heights,
                Verification& result)
{
    std::vector<EarlierCut> cuts = straight_cuts(
        result.program, [&](int n) -> const Tool& { return tool_of(job, n, program_file); });
    for (const std::string& file : earlier_programs(job)) {
        for (EarlierCut& cut : earlier_cuts(job, file)) {
            cut.line = 0;  // of another program
            cuts.push_back(cut);
        }
    }
    result.figures.ball_gouge_max.reset();
    result.figures.wall_gouge_at.reset();
    LevelMaps maps = judge_levels({job, result.grid, heights, scene.floor_tolerance + kJudgement,
                                   scene.plan_tolerance + kJudgement, runs, cuts, before},
                                  result.figures);
    for (std::size_t k = 0; k < result.left.size(); ++k) {
        if (std::isnan(maps.left[k])) {
            maps.left[k] = result.left[k];
        }
    }
    result.left = std::move(maps.left);
    result.gouge = std::move(maps.gouge);
    result.part = std::move(maps.part);
}

}  // namespace

Verification verify(const Job& job,
                    const std::string& program_file,
                    const VerifySettings& settings,
                    const Progress& progress)
{
    const Scene scene = scene_of(job);
    Verification result;
    result.bounds = {scene.floor_tolerance, scene.plan_tolerance, kRapidCutAllowed,
                     kUncoveredAllowed};
    // high enough above any program's start that its first move descends
    constexpr double kStartAbove = 1000;
    result.program = read_program(job, program_file, job.stock_top + kStartAbove);
    VerifyFigures& figures = result.figures;
    figures.moves = result.program.counts;

    const double spacing = settings.spacing.value_or(position_spacing(job));
    std::vector<ToolPositions> runs =
        positions_of(job, result.program, program_file, spacing, figures);
    result.grid = stock_grid(job, part_box(scene.surfaces, scene.mesh), settings.pitch);

    MachinedStock stock = UncutStock{job}.on(result.grid);
    const std::vector<Tool> tools = finishing_tools(job, runs);
    const double removed_before = cut_earlier_programs(job, spacing, stock);
    const StandingStock before{result.grid, stock.heights()};
    cut_stock(job, runs, spacing, settings.engagement, progress, stock, result);
    if (settings.engagement) {
        sum_engagement(job, runs, settings, spacing, stock.removed_volume() - removed_before,
                       result);
    }
    progress(1.0);

    double widest = 0;
    for (const ToolPositions& run : runs) {
        widest = std::max(widest, run.tool.radius);
    }
    PocketBoundaries walls;
    for (const Wall& wall : scene.walls) {
        walls.add(wall.boundary,
                  WallDistance{wall.loop, wall.outer, widest + 2 * result.grid.pitch});
    }
    const std::vector<double> heights = heights_to_judge(job, stock);
    if (scene.has_floor() || !scene.has_levels) {
        judge_surfaces(job, scene, runs, walls, tools, spacing, heights, result);
    }
    if (scene.has_levels) {
        add_levels(job, scene, program_file, runs, before, heights, result);
    }
    find_fixture_hits(job, runs, figures);
    figures.between_sides = floor_between_sides(job, result.grid, stock.heights(), spacing);
    find_fault_places(runs, result);
    judge(job, scene.scallop, result);
    if (settings.engagement) {
        result.positions = std::move(runs);
    }
    return result;
}

}  // namespace cusp::verify
