// A table of the tools and a list of figures.
#include "host_tools/judge/report/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"

namespace cusp::report {

using program_run::ToolTime;
using simulate::SimulationResult;
using toolpath::PlannedOperation;
using verify::ToolFigures;
using verify::Verification;
using verify::VerifyBounds;
using verify::VerifyFigures;

namespace {

std::string minutes(double seconds)
{
    const auto whole = static_cast<int>(std::lround(seconds));
    return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::string row(const std::string& tool, double seconds, double length, double depth)
{
    constexpr double kMetre = 1000;  // mm
    return fmt::format("  {:<14} {:>13} {:>8.1f} m {:>12.2f} mm\n", tool, minutes(seconds),
                       length / kMetre, depth);
}

std::string tools(const SimulationResult& run, const VerifyFigures& cut)
{
    std::string text =
        fmt::format("  {:<14} {:>13} {:>10} {:>15}\n", "tool", "time", "path cut", "deepest cut");
    for (const ToolFigures& t : cut.tools) {
        const auto time =
            std::find_if(run.tools.begin(), run.tools.end(),
                         [&](const ToolTime& one) { return one.number == t.tool.number; });
        text += row(
            fmt::format("T{} {} {:g} mm", t.tool.number, name_of(t.tool.shape), 2 * t.tool.radius),
            time == run.tools.end() ? 0.0 : time->seconds(), t.cut_length, t.cut_depth_max);
    }
    return text + row("in all", run.total_s, cut.cut_length, cut.cut_depth_max);
}

std::string line(const char* name, const std::string& value)
{
    return fmt::format("  {:<22} {}\n", name, value);
}

std::string allowed(double value, int decimals, double limit)
{
    return fmt::format("{:.{}f} mm (allowed {:g} mm)", value, decimals, limit);
}

int retracts(const std::vector<PlannedOperation>& planned)
{
    int sum = 0;
    for (const PlannedOperation& operation : planned) {
        sum += operation.stats.retracts;
    }
    return sum;
}

double planning(const std::vector<PlannedOperation>& planned)
{
    double sum = 0;
    for (const PlannedOperation& operation : planned) {
        sum += operation.stats.planning_s;
    }
    return sum;
}

}  // namespace

std::string run_summary(const std::vector<PlannedOperation>& planned,
                        const SimulationResult& run,
                        const Verification& cut)
{
    constexpr double kPercent = 100;
    const VerifyFigures& f = cut.figures;
    const VerifyBounds& bounds = cut.bounds;
    const double scallop = f.scallop_bound.value_or(0);
    std::string text = tools(run, f) + "\n";
    text += line("tool changes", fmt::format("{}", run.tool_changes));
    text += line("retracts", fmt::format("{}", retracts(planned)));
    text += line("rapid moves", fmt::format("{:.1f} m", f.rapid_length / 1000));
    text += line("gouge, floor",
                 allowed(f.ball_gouge_max.value_or(f.gouge_max), 4, bounds.floor_tolerance));
    text += line("gouge, walls", allowed(f.wall_gouge_max.value_or(0), 4, bounds.plan_tolerance));
    text += line("scallop, highest", allowed(f.scallop_max, 3, scallop));
    text += line("uncut", fmt::format("{:.2f} % of the floor", kPercent * f.uncut_share));
    text += line("over the scallop",
                 fmt::format("{:.2f} % of the floor (allowed {:g} %)", kPercent * f.uncovered_share,
                             kPercent * bounds.uncovered_share));
    text += line("rapids through stock", allowed(f.rapid_cut_max, 4, bounds.rapid_cut));
    text +=
        line("steps", fmt::format("X {}, Y {}, Z {}", run.steps[0], run.steps[1], run.steps[2]));
    return text + line("planned in", fmt::format("{:.2f} s", planning(planned)));
}

}  // namespace cusp::report
