// Reads each program as the controller would, and finds its tools.
#include "host_tools/verify/earlier_programs.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "host_tools/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Job;
using toolpath::Tool;

namespace {

constexpr double kStartHigh = 1000;     // mm over the stock: above any program's start
constexpr double kEarlierChord = 2e-4;  // mm
constexpr double kCurveStep = 0.05;     // mm: of NURBS

[[noreturn]] void refuse_tool(const Job& job, const std::string& file, int number)
{
    if (number == 0) {
        throw InputError(
            fmt::format("{}: its tool is not known: there is neither a T word nor a comment such "
                        "as \"(tool 1 flat "
                        "diameter 6 mm)\" before its first cut, and {} has {} tools",
                        file, job.file, job.tools.size()));
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
        return described->second;
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

std::vector<EarlierCut> earlier_cuts(const Job& job, const std::string& file)
{
    const Program program = read_program(file, job.stock_top + kStartHigh);
    std::vector<EarlierCut> cuts;
    std::vector<Vec3d> points;
    for (std::size_t k = 0; k < program.moves.size(); ++k) {
        const ProgramMove& m = program.moves[k];
        if (is_rapid(m)) {
            continue;
        }
        const Tool& tool = tool_of_program(job, file, program, m.tool);
        if (k == 0) {
            continue;  // the place before the first move is not known
        }
        const bool is_chord = !std::holds_alternative<path::Line>(m.move.path);
        points.clear();
        append_points(m.move, spacing_for(m.move), points);
        Vec3d at = to_millimetres(m.move.start);
        for (const Vec3d p : points) {
            cuts.push_back({tool, is_chord, at, p});
            at = p;
        }
    }
    return cuts;
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
        add(operation.after);
    }
    return files;
}

std::vector<ToolPositions> earlier_positions(const Job& job, double spacing)
{
    std::vector<ToolPositions> runs;
    for (const std::string& file : earlier_programs(job)) {
        const Program program = read_program(file, job.stock_top + kStartHigh);
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
                runs.back().tips.push_back(to_millimetres(m.move.start));
            }
            ToolPositions& run = runs.back();
            append_points(m.move, spacing, run.tips);
            run.rapid.resize(run.tips.size(), is_rapid(m));
            run.lines.resize(run.tips.size(), m.move.line);
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

}  // namespace cusp::verify
