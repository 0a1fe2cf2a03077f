// The tool's profile is convex, so the tip's height over an edge has one maximum.
#include "host_tools/geometry/drop_cutter/edge_contact.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::drop_cutter {

using toolpath::Tool;

namespace {

// An interval, and the slope of the height at its ends: positive at `a`, negative at `b`.
struct Bracket {
    double a;
    double b;
    double rise_a;
    double rise_b;
};

// Narrows the bracket to a zero of rise(y) by false position; the weight of an end that stays is
// halved (Illinois algorithm). An error of 1e-5 radii in y changes the height at the maximum by its
// square only, so that is found to nanometres.
template <class Rise>
void narrow(Bracket& bracket, const Tool& tool, const Rise& rise)
{
    constexpr int kRounds = 40;
    const double near = 1e-5 * tool.radius;
    auto& [a, b, rise_a, rise_b] = bracket;
    int stayed = 0;
    for (int i = 0; i < kRounds && b - a > near; ++i) {
        // Every eighth step bisects: that converges for every shape of tool.
        const double share = i % 8 == 7 ? 0.5 : rise_a / (rise_a - rise_b);
        const double y = a + share * (b - a);
        const double here = rise(y);
        if (std::abs(here) < 1e-6 * tool.corner_radius * tool.radius) {
            a = b = y;
        } else if (here > 0.0) {
            a = y;
            rise_a = here;
            rise_b *= stayed > 0 ? 0.5 : 1.0;
            stayed = 1;
        } else {
            b = y;
            rise_b = here;
            rise_a *= stayed < 0 ? 0.5 : 1.0;
            stayed = -1;
        }
    }
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
    Bracket bracket{low, high, rise(low), rise(high)};
    if (bracket.rise_a <= 0.0 || bracket.rise_b >= 0.0) {
        return higher(contact_at(low), contact_at(high));
    }
    narrow(bracket, tool, rise);
    return higher(higher(contact_at(bracket.a), contact_at(bracket.b)),
                  higher(contact_at(low), contact_at(high)));
}

}  // namespace cusp::drop_cutter
