// The result of a run in lines for people.
#include <fmt/format.h>

#include "firmware/base/machine_limits.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "host_tools/controller/simulate/simulate.hpp"

namespace cusp::simulate {

namespace {

// The greatest values of a derivative of the set points with the limits of the settings. Set points are whole
// nanometres; `rounding`, nm a tick to the power of the order, bounds the effect.
std::string limited(
    const char* name, int order, double rounding, AxisVecd value, AxisVecf limit, unsigned axes)
{
    double added = rounding / kNanometresPerMillimetre;
    for (int k = 0; k < order; ++k) {
        added *= kServoTicksPerSecond;
    }
    const std::string power = order == 1 ? "" : fmt::format("^{}", order);
    std::string rotary;
    std::string limit_of_rotary;
    if (axes > kLinearAxes) {
        rotary = fmt::format("  A {:.3f} deg/s{}", value[kLinearAxes], power);
        limit_of_rotary = fmt::format(", {:g}", limit[kLinearAxes]);
    }
    return fmt::format(
        "{:<10} X {:.3f}  Y {:.3f}  Z {:.3f} mm/s{}{} at most (limits {:g}, {:g}, {:g}{}; up to "
        "{:g} is rounding to nanometres)\n",
        name, value.x, value.y, value.z, power, rotary, limit.x, limit.y, limit.z, limit_of_rotary,
        added);
}

std::string tools_text(const SimulationResult& result)
{
    std::string text = "tools     ";
    for (const program_run::ToolTime& tool : result.tools) {
        text += fmt::format(" T{} {:.1f} s{}", tool.number, tool.seconds(),
                            &tool == &result.tools.back() ? "" : ",");
    }
    return text + fmt::format("; {} change{} of tool\n", result.tool_changes,
                              result.tool_changes == 1 ? "" : "s");
}

}  // namespace

std::string summary_text(const SimulationResult& result, const MachineLimits& limits)
{
    const program_run::ProgramMoveCounts& moves = result.moves;
    const AxisVecd end = to_millimetres(result.end);
    std::string text = fmt::format("{} lines, {} rapids, {} lines, {} arcs, {} NURBS\n",
                                   result.lines, moves.rapid, moves.line, moves.arc, moves.nurbs);
    text += fmt::format("time       {:.3f} s in motion, {:.1f} mm, simulated in {:.3f} s\n",
                        result.duration_s, result.length_mm, result.wall_s);
    text += fmt::format("end        X {:.3f}  Y {:.3f}  Z {:.3f} mm", end.x, end.y, end.z);
    text += result.axes > kLinearAxes ? fmt::format("  A {:.3f} deg\n", end[kLinearAxes]) : "\n";
    text += limited("speed", 1, 1, result.max_velocity, limits.velocity, result.axes);
    text += limited("accel", 2, 2, result.max_acceleration, limits.acceleration, result.axes);
    text += limited("jerk", 3, 4, result.max_jerk, limits.jerk, result.axes);
    text += fmt::format("deviation  {:.6f} mm at most, in line {}\n", result.max_deviation_mm,
                        result.max_deviation_line);
    if (result.starved_ticks > 0) {
        text += fmt::format("starved    {} ms without a line to run\n", result.starved_ticks);
    }
    if (result.tool_changes > 0) {
        text += tools_text(result);
    }
    if (result.rotary_line > 0) {
        text += fmt::format("ignored    A, B and C words, from line {} on: they turn nothing\n",
                            result.rotary_line);
    }
    for (const std::uint64_t line : result.pause_lines) {
        text += fmt::format("pause      line {}: resumed at once\n", line);
    }
    return text;
}

std::string faults_text(const std::string& program_file, const SimulationResult& result)
{
    std::string text;
    for (const program_run::RunError& error : result.errors) {
        text += fmt::format("{}:{}: {}\n", program_file, error.line, fault_text(result, error));
    }
    return text + (result.stopped ? "stopped before the end\n" : "");
}

}  // namespace cusp::simulate
