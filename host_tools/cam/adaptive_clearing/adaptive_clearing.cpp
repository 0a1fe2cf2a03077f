// Clears for climb milling, or mirrored; of two ways the shorter one.
#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/cam/adaptive_clearing/mirrored_path.hpp"
#include "host_tools/cam/adaptive_clearing/region_planner.hpp"

namespace cusp::adaptive_clearing {

using job::CutDirection;
using offset::Region2d;

namespace {

// mm at the feed that would take as long.
double effort(const AdaptivePath& path, double radius)
{
    constexpr double kRapidShare = 0.2;
    constexpr double kLift = 10.0;  // radii
    constexpr double kOver = 10.0;  // times the way that is over the limit
    double sum = path.length;
    Vec2d at{};
    for (const AdaptiveRun& run : path.runs) {
        sum += run.link.empty() ? kLift * radius : 0.0;
        for (const LinkLeg& leg : run.link) {
            sum += norm(leg.end - at) * (leg.free ? kRapidShare : 1.0);
            at = leg.end;
        }
        at = run.path.empty() ? at : run.path.back().end;
    }
    for (const OverEngagement& over : path.over) {
        sum += kOver * over.length;
    }
    return sum;
}

// Round regions are planned in both ways: which is shorter depends on where the last passes meet the
// walls.
AdaptivePath shorter_path(const Region2d& region, const AdaptiveSettings& settings)
{
    PlannedRegion steered = plan_region(region, settings, false);
    if (!steered.is_round) {
        return std::move(steered.path);
    }
    AdaptivePath spiral = plan_region(region, settings, true).path;
    const double radius = settings.tool_radius;
    return effort(spiral, radius) < effort(steered.path, radius) ? spiral : steered.path;
}

}  // namespace

double cleared_radius(const toolpath::Tool& tool, double scallop_height)
{
    const double corner = tool.corner_radius;
    const double height = std::min(corner, scallop_height);
    return tool.radius - corner + std::sqrt(height * (2.0 * corner - height));
}

AdaptivePath clear_adaptively(const Region2d& region, const AdaptiveSettings& settings)
{
    if (settings.direction == CutDirection::kClimb) {
        return shorter_path(region, settings);
    }
    AdaptiveSettings other = settings;
    for (Region2d& open : other.open) {
        open = mirrored(open);
    }
    AdaptivePath path = shorter_path(mirrored(region), other);
    mirror(path);
    return path;
}

}  // namespace cusp::adaptive_clearing
