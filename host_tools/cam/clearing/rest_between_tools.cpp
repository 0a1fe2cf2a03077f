// Compares the lower sides of tools at points across the radius.
#include "host_tools/cam/clearing/rest_between_tools.hpp"

#include <algorithm>

namespace cusp::clearing {

using toolpath::Tool;

namespace {

// True if `after`, with its axis `apart` outside the places of `before`, meets no more than the
// scallop height: at some distance from those places the stock is the lower side of `before`.
bool nests(const Tool& before, const Tool& after, double apart, double scallop_height)
{
    constexpr int kPlaces = 256;
    constexpr double kRoundingSlack = 1e-9;
    for (int i = 0; i <= kPlaces; ++i) {
        const double at = after.radius * i / kPlaces;
        const double from_before = std::max(0.0, at + apart);
        if (from_before > before.radius + kRoundingSlack ||
            profile_height(before, std::min(from_before, before.radius)) >
                profile_height(after, at) + scallop_height + kRoundingSlack) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::optional<double> rest_offset_between_tools(const Tool& before,
                                                const Tool& after,
                                                double scallop_height)
{
    double held = -after.radius;
    double open = before.radius - after.radius;
    if (nests(before, after, open, scallop_height)) {
        return open;
    }
    if (!nests(before, after, held, scallop_height)) {
        return std::nullopt;
    }
    for (int i = 0; i < 30; ++i) {
        const double middle = (held + open) / 2;
        (nests(before, after, middle, scallop_height) ? held : open) = middle;
    }
    return held;
}

bool leaves_no_rest(const Tool& before, const Tool& after, double scallop_height)
{
    // If a cutter fits, a smaller one fits up to the difference of the radii around it.
    return before.radius <= after.radius &&
           nests(before, after, before.radius - after.radius, scallop_height);
}

}  // namespace cusp::clearing
