// Sums over the steps of a run.
#include "host_tools/judge/verify/engagement.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::verify {

using job::Job;
using job::Operation;
using toolpath::Tool;

namespace {

constexpr double kAllowedShare = 1.05;   // of the limit
constexpr double kAllowedPitches = 0.7;  // of the width of a straight cut
constexpr double kRadian = 180 / kPi;    // degrees

// degrees
double found_over(double limit, double radius, double pitch)
{
    const double most = std::min(180.0, kAllowedShare * limit) / kRadian;
    return kRadian * elementary::acos(std::clamp(
                         elementary::cos(most) - kAllowedPitches * pitch / radius, -1.0, 1.0));
}

}  // namespace

std::optional<double> engagement_limit(const Job& job,
                                       const Tool& tool,
                                       std::optional<double> asked)
{
    std::optional<double> least = asked;
    for (const Operation& operation : job.operations) {
        const auto is_it = [&](const Tool& other) {
            return other.number == tool.number;
        };
        // The tool of a finish in the same operation has no limit.
        const bool roughs = operation.tools.empty() ? is_it(operation.tool)
                                                    : std::any_of(operation.tools.begin(),
                                                                  operation.tools.end(), is_it);
        if (!asked && operation.passes.max_engagement && roughs) {
            least = std::min(least.value_or(*operation.passes.max_engagement),
                             *operation.passes.max_engagement);
        }
    }
    return least;
}

void set_limit(const Tool& tool, std::optional<double> limit, double pitch, EngagementRun& run)
{
    run.counts_over = limit ? found_over(*limit, tool.radius, pitch) : kUnbounded;
}

void add_engagement(const ToolPositions& positions,
                    std::optional<double> limit,
                    const EngagementRun& run,
                    EngagementFigures& figures)
{
    if (limit) {
        figures.limit = std::min(figures.limit.value_or(*limit), *limit);
        figures.over_length = figures.over_length.value_or(0);
        figures.limited_max = figures.limited_max.value_or(0);
    }
    for (std::size_t k = 1; k < run.kinds.size(); ++k) {
        const double way = norm(positions.tips[k] - positions.tips[k - 1]);
        const auto angle = static_cast<double>(run.angles[k]);
        if (run.kinds[k] == StepKind::kAir) {
            figures.air_length += way;
        } else if (run.kinds[k] == StepKind::kCut && limit && angle > run.counts_over) {
            *figures.over_length += way;
        }
        if (limit) {
            figures.limited_max = std::max(*figures.limited_max, angle);
        }
        if (angle > figures.angle_max) {
            figures.angle_max = angle;
            figures.place = positions.tips[k];
            figures.line = positions.lines[k];
        }
    }
}

double programmed_seconds(const Program& program)
{
    const Vec3d rate = toolpath::MachineRates{}.velocity;
    double seconds = 0;
    for (std::size_t k = 1; k < program.moves.size(); ++k) {
        const path::Move& move = program.moves[k].move;
        if (move.kind == path::MoveKind::kFeed) {
            seconds += path::length(move) / static_cast<double>(move.feed);
        } else {
            const Vec3d way = xyz(to_millimetres(move.end)) - xyz(to_millimetres(move.start));
            seconds += std::max(
                {std::abs(way.x) / rate.x, std::abs(way.y) / rate.y, std::abs(way.z) / rate.z});
        }
    }
    return seconds;
}

}  // namespace cusp::verify
