// Each file of surfaces is taken once; arcs become positions no farther apart than the spacing.
#include <algorithm>
#include <set>

#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;
using job::Operation;
using job::ToleranceSide;
using toolpath::Tool;

namespace {

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
        const bool has_walls = !job::finishes_ground(operation);
        if (has_walls && operation.outline.boundary && boundaries.insert(pocket).second) {
            scene.walls.push_back({pocket, *operation.outline.boundary, true});
        }
        for (std::size_t i = 0; has_walls && i < operation.outline.islands.size(); ++i) {
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

}  // namespace

const Tool& tool_of(const Job& job, int number, const std::string& program)
{
    for (const Tool& tool : job.tools) {
        if (tool.number == number || (number == 0 && job.tools.size() == 1)) {
            return tool;
        }
    }
    if (number == 0) {
        refuse_unnamed_tool(job, program);
    }
    throw InputError(fmt::format("{}: T{} is no tool of the job {}", program, number, job.file));
}

std::vector<int> measured_tools_of(const Job& job)
{
    std::vector<int> out;
    for (const Operation& operation : job.operations) {
        const int number = operation.tool.number;
        if (operation.tolerance.scallop && job::finishes_ground(operation) &&
            operation.tool.shape != toolpath::ToolShape::kBall &&
            std::find(out.begin(), out.end(), number) == out.end()) {
            out.push_back(number);
        }
    }
    return out;
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

void read_positions(Verifying& work)
{
    // high enough above any program's start that its first move descends
    constexpr double kStartAbove = 1000;
    work.scene = scene_of(work.job);
    Program& program = work.result.program;
    program = read_program(work.job, work.program_file, work.job.stock_top + kStartAbove);
    VerifyFigures& figures = work.result.figures;
    figures.moves = program.counts;
    figures.measured_tools = measured_tools_of(work.job);
    work.spacing = work.settings.spacing.value_or(position_spacing(work.job));
    std::vector<ToolPositions>& runs = work.runs;
    int current = -1;
    for (std::size_t k = 0; k < program.moves.size(); ++k) {
        const ProgramMove& m = program.moves[k];
        const bool rapid = m.move.kind == path::MoveKind::kRapid;
        const Tool& tool = rapid && m.tool == 0 ? work.job.tools.front()
                                                : tool_of(work.job, m.tool, work.program_file);
        if (m.tool != current) {
            current = m.tool;
            runs.push_back({tool, {}, {}});
        }
        ToolPositions& run = runs.back();
        if (!rapid && k > 0) {
            ToolFigures& of_tool = figures_of(tool, figures);
            of_tool.first_cut =
                of_tool.first_cut.line > 0
                    ? of_tool.first_cut
                    : FaultPlace{xyz(to_millimetres(m.move.end)), m.move.line, tool.number};
        }
        if (k == 0) {  // the machine's start position is unknown
            run.tips.push_back(xyz(to_millimetres(m.move.end)));
        } else {
            const double length = path::length(m.move);
            (rapid ? figures.rapid_length : figures.cut_length) += length;
            if (!rapid) {
                figures_of(run.tool, figures).cut_length += length;
            }
            append_points(m.move, work.spacing, run.tips);
        }
        run.rapid.resize(run.tips.size(), rapid);
        run.lines.resize(run.tips.size(), m.move.line);
    }
    work.result.grid =
        stock_grid(work.job, part_box(work.scene.surfaces, work.scene.mesh), work.settings.pitch);
}

}  // namespace cusp::verify
