// The profile is convex, so what an edge lifts the tip by has one top.
#include "host_tools/drop_cutter/edge_contact.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::drop_cutter {

using toolpath::Tool;

// Where the top lies inside, false position finds it to nanometres in few steps, at most forty.
EdgeContact drop_on_edge(const Tool& tool, double slope, double away, double low, double high)
{
    const double r = tool.radius;
    const double c = tool.corner_radius;
    const double room = r * r - away * away;
    if (room <= 0.0) {
        return {kNoContact, 0.0};
    }
    const double reach = std::sqrt(room);
    low = std::max(low, -reach);
    high = std::min(high, reach);
    if (low > high) {
        return {kNoContact, 0.0};
    }
    const auto rest_at = [&](double y) {
        const double out = std::max(0.0, std::sqrt(away * away + y * y) - (r - c));
        return EdgeContact{slope * y - (c - std::sqrt(std::max(c * c - out * out, 0.0))), y};
    };
    const auto higher = [](EdgeContact one, EdgeContact other) {
        return one.lift < other.lift ? other : one;
    };
    if (c == 0.0) {
        return higher(rest_at(low), rest_at(high));
    }
    if (c == r) {
        const double secant = std::sqrt(1.0 + slope * slope);
        const double top = slope * reach / secant;
        const double y = std::clamp(top, low, high);
        return {
            y == top ? reach * secant - c : slope * y - c + std::sqrt(std::max(room - y * y, 0.0)),
            y};
    }
    // Positive where the value rises.
    const auto rise = [&](double y) {
        const double d = std::sqrt(away * away + y * y);
        const double out = std::max(0.0, d - (r - c));
        return slope * d * std::sqrt(std::max(c * c - out * out, 0.0)) - out * y;
    };
    double a = low;
    double b = high;
    double rise_a = rise(a);
    double rise_b = rise(b);
    if (rise_a <= 0.0 || rise_b >= 0.0) {
        return higher(rest_at(low), rest_at(high));
    }
    // False position, where one end stays its weight is halved. The top is flat: a hundred
    // thousandth of the radius off it misses its height by the square of that.
    constexpr int kRounds = 40;
    const double near = 1e-5 * r;
    int stayed = 0;
    for (int i = 0; i < kRounds && b - a > near; ++i) {
        // Now and then by half, which no shape of the tool slows down.
        const double share = i % 8 == 7 ? 0.5 : rise_a / (rise_a - rise_b);
        const double y = a + share * (b - a);
        const double here = rise(y);
        if (std::abs(here) < 1e-6 * c * r) {
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
    return higher(higher(rest_at(a), rest_at(b)), higher(rest_at(low), rest_at(high)));
}

}  // namespace cusp::drop_cutter
