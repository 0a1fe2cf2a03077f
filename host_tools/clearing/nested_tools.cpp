// Undersides compared at places across the radius.
#include "host_tools/clearing/nested_tools.hpp"

#include <algorithm>

namespace cusp::host {
namespace {

// Whether `after`, with its axis `apart` outside the places of `before`, meets no more than the
// ridge: what stands at some distance from those places is the underside of `before` there.
bool nests(const Tool& before, const Tool& after, double apart, double ridge)
{
    constexpr int kPlaces = 256;
    constexpr double kSlack = 1e-9;
    for (int i = 0; i <= kPlaces; ++i) {
        const double at = after.radius * i / kPlaces;
        const double from_before = std::max(0.0, at + apart);
        if (from_before > before.radius + kSlack ||
            profile_height(before, std::min(from_before, before.radius)) >
                profile_height(after, at) + ridge + kSlack) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::optional<double> nested_reach(const Tool& before, const Tool& after, double ridge)
{
    double held = -after.radius;
    double open = before.radius - after.radius;
    if (nests(before, after, open, ridge)) {
        return open;
    }
    if (!nests(before, after, held, ridge)) {
        return std::nullopt;
    }
    for (int i = 0; i < 30; ++i) {
        const double middle = (held + open) / 2;
        (nests(before, after, middle, ridge) ? held : open) = middle;
    }
    return held;
}

bool leaves_nothing_for(const Tool& before, const Tool& after, double ridge)
{
    // Where a cutter fits, a smaller one fits up to the difference of the radii around it.
    return before.radius <= after.radius &&
           nests(before, after, before.radius - after.radius, ridge);
}

}  // namespace cusp::host
