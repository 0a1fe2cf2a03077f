// The tool's profile is convex, so the tip's height over an edge has one maximum.
#include "host_tools/geometry/drop_cutter/edge_contact.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/bracketed_zero.hpp"

namespace cusp::drop_cutter {

using toolpath::Tool;

namespace {

// An error of 1e-5 radii in y changes the height at the maximum by its square only, so that is found to
// nanometres.
part_model::ZeroSearch search_for(const Tool& tool)
{
    constexpr int kRounds = 40;
    constexpr int kBisectEvery = 8;
    return {1e-5 * tool.radius, kRounds, kBisectEvery, 1e-6 * tool.corner_radius * tool.radius};
}

}  // namespace

std::optional<EdgeContact> drop_on_edge(const Tool& tool, const EdgeBeside& edge)
{
    const double slope = edge.slope;
    const double away = edge.away;
    const double r = tool.radius;
    const double c = tool.corner_radius;
    const double room = r * r - away * away;
    if (room <= 0.0) {
        return std::nullopt;
    }
    const double reach = std::sqrt(room);
    const double low = std::max(edge.low, -reach);
    const double high = std::min(edge.high, reach);
    if (low > high) {
        return std::nullopt;
    }
    const auto contact_at = [&](double y) {
        const double out = std::max(0.0, std::sqrt(away * away + y * y) - (r - c));
        return EdgeContact{slope * y - (c - std::sqrt(std::max(c * c - out * out, 0.0))), y};
    };
    const auto higher = [](EdgeContact one, EdgeContact other) {
        return one.lift < other.lift ? other : one;
    };
    if (c == 0.0) {
        return higher(contact_at(low), contact_at(high));
    }
    if (c == r) {
        const double secant = std::sqrt(1.0 + slope * slope);
        const double top = slope * reach / secant;
        const double y = std::clamp(top, low, high);
        return EdgeContact{
            y == top ? reach * secant - c : slope * y - c + std::sqrt(std::max(room - y * y, 0.0)),
            y};
    }
    // Positive where the height rises with y.
    const auto rise = [&](double y) {
        const double d = std::sqrt(away * away + y * y);
        const double out = std::max(0.0, d - (r - c));
        return slope * d * std::sqrt(std::max(c * c - out * out, 0.0)) - out * y;
    };
    const auto top = part_model::bracketed_zero({low, high}, search_for(tool), rise);
    return higher(higher(contact_at(top.low), contact_at(top.high)),
                  higher(contact_at(low), contact_at(high)));
}

}  // namespace cusp::drop_cutter
