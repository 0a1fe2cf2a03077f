// Reads each program as the controller would, and finds its tools.
#include "host_tools/judge/verify/earlier_programs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;
using toolpath::Tool;

namespace {

constexpr double kEarlierChord = 2e-4;  // mm
constexpr double kCurveStep = 0.05;     // mm: of NURBS

[[noreturn]] void refuse_tool(const Job& job, const std::string& file, int number)
{
    if (number == 0) {
        refuse_unnamed_tool(job, file);
    }
    throw InputError(
        fmt::format("{}: tool {} is not known: there is no comment such as \"(tool {} flat "
                    "diameter 6 mm)\", and "
                    "{} has no [[tool]] with number = {}",
                    file, number, number, job.file, number));
}

const Tool& tool_of_program(const Job& job,
                            const std::string& file,
                            const Program& program,
                            int number)
{
    if (const auto described = program.tools.find(number); described != program.tools.end()) {
        return described->second.tool;
    }
    for (const Tool& tool : job.tools) {
        if (tool.number == number || (number == 0 && job.tools.size() == 1)) {
            return tool;
        }
    }
    refuse_tool(job, file, number);
}

bool is_rapid(const ProgramMove& m) { return m.move.kind == path::MoveKind::kRapid; }

double spacing_for(const path::Move& move)
{
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        const double radius = std::max(arc->radius, arc->radius + arc->radius_change);
        return std::sqrt(8 * std::max(radius, kEarlierChord) * kEarlierChord);
    }
    return std::holds_alternative<path::Line>(move.path) ? kUnbounded : kCurveStep;
}

}  // namespace

void refuse_unnamed_tool(const Job& job, const std::string& file)
{
    throw InputError(
        fmt::format("{}: its tool is not known: there is neither a T word nor a comment such as "
                    "\"(tool 1 flat diameter 6 mm)\" before its first cut, and {} has {} tools",
                    file, job.file, job.tools.size()));
}

std::vector<EarlierCut> straight_cuts(const Program& program,
                                      const std::function<const Tool&(int)>& tool_of)
{
    std::vector<EarlierCut> cuts;
    std::vector<Vec3d> points;
    for (std::size_t k = 0; k < program.moves.size(); ++k) {
        const ProgramMove& m = program.moves[k];
        if (is_rapid(m)) {
            continue;
        }
        const Tool& tool = tool_of(m.tool);
        if (k == 0) {
            continue;
        }
        const bool is_chord = !std::holds_alternative<path::Line>(m.move.path);
        points.clear();
        append_points(m.move, spacing_for(m.move), points);
        Vec3d at = xyz(to_millimetres(m.move.start));
        for (const Vec3d p : points) {
            cuts.push_back({tool, is_chord, at, p, m.move.line});
            at = p;
        }
    }
    return cuts;
}

std::vector<EarlierCut> earlier_cuts(const Job& job, const std::string& file)
{
    const Program program = read_program(job, file, job.stock_top + kStartHigh);
    return straight_cuts(program, [&](int number) -> const Tool& {
        return tool_of_program(job, file, program, number);
    });
}

std::vector<std::string> earlier_programs(const Job& job)
{
    std::vector<std::string> files;
    const auto add = [&](const std::vector<std::string>& more) {
        for (const std::string& file : more) {
            if (std::find(files.begin(), files.end(), file) == files.end()) {
                files.push_back(file);
            }
        }
    };
    add(job.stock_programs);
    for (const job::Operation& operation : job.operations) {
        add(operation.rest.after);
    }
    return files;
}

namespace {

constexpr double kOpenBelow = 1000;  // mm under the stock's bottom

// The flat end that goes wherever the tool has gone through the bottom between two tips; none.
std::optional<Tool> through_tool(const Job& job, const Tool& tool, Vec3d from, Vec3d to)
{
    constexpr double kRounding = 1e-9;  // mm
    const double height = *job.stock_bottom - std::max(from.z, to.z);
    if (height < -kRounding) {
        return std::nullopt;
    }
    const double radius = radius_at_height(tool, std::max(0.0, height));
    if (!(radius > 0)) {
        return std::nullopt;
    }
    Tool through;
    through.number = tool.number;
    through.shape = toolpath::ToolShape::kFlat;
    through.radius = radius;
    return through;
}

Vec3d open_tip(const Job& job, const job::SetupFlip& turn, Vec3d tip)
{
    const Vec3d turned = turn.of(tip);
    return {turned.x, turned.y, open_level(job)};
}

// Moves through the bottom, in runs of equal radius.
void append_through(const Job& job,
                    const job::SetupFlip& turn,
                    const ToolPositions& run,
                    std::vector<ToolPositions>& out)
{
    bool joins = false;
    for (std::size_t k = 1; k < run.tips.size(); ++k) {
        const auto through =
            run.rapid[k] ? std::nullopt : through_tool(job, run.tool, run.tips[k - 1], run.tips[k]);
        if (!through) {
            joins = false;
            continue;
        }
        if (!joins || out.back().tool.radius < through->radius ||
            out.back().tool.radius > through->radius) {
            out.push_back(
                {*through, {open_tip(job, turn, run.tips[k - 1])}, {false}, {run.lines[k]}});
        }
        out.back().tips.push_back(open_tip(job, turn, run.tips[k]));
        out.back().rapid.push_back(false);
        out.back().lines.push_back(run.lines[k]);
        joins = true;
    }
}

}  // namespace

std::vector<ToolPositions> program_positions(const Job& job,
                                             const std::string& file,
                                             double spacing)
{
    std::vector<ToolPositions> runs;
    const Program program = read_program(job, file, job.stock_top + kStartHigh);
    int current = -1;
    for (std::size_t k = 1; k < program.moves.size(); ++k) {
        const ProgramMove& m = program.moves[k];
        if (is_rapid(m) && m.tool != current) {
            current = -1;  // a tool that cuts nothing need not be known
            continue;
        }
        if (m.tool != current) {
            current = m.tool;
            runs.push_back({tool_of_program(job, file, program, current), {}, {}});
            runs.back().tips.push_back(xyz(to_millimetres(m.move.start)));
        }
        ToolPositions& run = runs.back();
        append_points(m.move, spacing, run.tips);
        run.rapid.resize(run.tips.size(), is_rapid(m));
        run.lines.resize(run.tips.size(), m.move.line);
    }
    return runs;
}

double open_level(const Job& job) { return *job.stock_bottom - kOpenBelow; }

std::vector<EarlierCut> earlier_cuts(const Job& job, const job::SetupProgram& program)
{
    std::vector<EarlierCut> cuts;
    for (const EarlierCut& cut : earlier_cuts(job, program.file)) {
        if (!program.turn.turns_over()) {
            cuts.push_back(
                {cut.tool, cut.is_chord, program.turn.of(cut.from), program.turn.of(cut.to)});
        } else if (const auto through = through_tool(job, cut.tool, cut.from, cut.to)) {
            cuts.push_back({*through, cut.is_chord, open_tip(job, program.turn, cut.from),
                            open_tip(job, program.turn, cut.to)});
        } else {  // a plunge: its lower end
            const Vec3d low = cut.from.z < cut.to.z ? cut.from : cut.to;
            if (const auto hole = through_tool(job, cut.tool, low, low)) {
                const Vec3d tip = open_tip(job, program.turn, low);
                cuts.push_back({*hole, cut.is_chord, tip, tip});
            }
        }
    }
    return cuts;
}

std::vector<ToolPositions> earlier_positions(const Job& job, double spacing)
{
    std::vector<ToolPositions> runs;
    for (const std::string& file : earlier_programs(job)) {
        for (ToolPositions& run : program_positions(job, file, spacing)) {
            runs.push_back(std::move(run));
        }
    }
    for (const job::SetupProgram& program : job.turned_programs) {
        for (ToolPositions& run : program_positions(job, program.file, spacing)) {
            if (program.turn.turns_over()) {
                append_through(job, program.turn, run, runs);
                continue;
            }
            for (Vec3d& tip : run.tips) {
                tip = program.turn.of(tip);
            }
            runs.push_back(std::move(run));
        }
    }
    return runs;
}

double cut_earlier_programs(const Job& job, double spacing, MachinedStock& stock)
{
    for (const ToolPositions& run : earlier_positions(job, spacing)) {
        stock.cut(run, spacing, [](double) {});
    }
    return stock.removed_volume();
}

std::vector<double> heights_to_judge(const Job& job, const MachinedStock& stock)
{
    std::vector<double> heights = stock.heights();
    const double open =
        job.turned_programs.empty() ? -kUnbounded / 2 : open_level(job) + kOpenBelow / 2;
    std::replace_if(
        heights.begin(), heights.end(), [open](double z) { return z < open; }, kNoValue);
    return heights;
}

}  // namespace cusp::verify
