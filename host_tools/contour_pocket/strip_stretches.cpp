// Ways inward one after the other: where one of two neighbours meets too much, the stretch between
// them counts.
#include <algorithm>
#include <cmath>

#include "host_tools/contour_pocket/level_interval.hpp"
#include "host_tools/contour_pocket/strip_ridge.hpp"

namespace cusp::host {

void StripRidge::begin(const LevelStrip& strip)
{
    const double step = strip.to - strip.from;
    segments_.clear();
    lay(strip.outer, step);
    lay(strip.inner, step);
    sort_segments(step);
}

void StripRidge::add(const std::vector<PartialLoop>& loops)
{
    Region2d paths;
    for (const PartialLoop& loop : loops) {
        paths.contours.push_back(loop.path);
    }
    const double cell = cell_;
    lay(paths, cell);
    sort_segments(cell);
}

std::vector<Edge> StripRidge::stretches(const std::vector<Edge>& edges,
                                        const LevelStrip& strip,
                                        double from,
                                        double to)
{
    if (to - from <= least_interval(floor_.tool(), budget_)) {
        return {};
    }
    const Look look{strip, from - strip.from, to - from, true};
    look_closely(look.step);
    std::vector<Edge> found;
    for (const Edge& edge : edges) {
        stretches_on(edge, look, found);
    }
    return found;
}

void StripRidge::stretches_on(const Edge& edge, const Look& look, std::vector<Edge>& found) const
{
    constexpr double kPoint = 1e-6;  // mm
    // Under a flat foot steps stand over narrow places, between the ways.
    const double most = ball_ ? 1.0 : 0.85;
    const bool corners = look.foot == 0.0;
    const std::vector<double> places = places_along(edge, {corners, corners}, look.step);
    double begin = -1.0;
    const auto close = [&](double end) {
        const Vec2d a = point_on(edge, begin);
        const Vec2d b = point_on(edge, end);
        if (begin >= 0.0 && distance(a, b) > kPoint) {
            found.push_back(cusp::host::between(edge, a, b));
        }
        begin = -1.0;
    };
    Way last = way(edge, places.front(), look);
    for (std::size_t i = 1; i < places.size(); ++i) {
        const Way next = way(edge, places[i], look);
        const double share = std::max(
            {last.share, next.share, left_beside(last, next), between(edge, last, next, look)});
        if (share > most) {
            begin = begin < 0.0 ? places[i - 1] : begin;
        } else if (begin >= 0.0) {
            close(places[i - 1]);
        }
        last = next;
    }
    if (begin >= 0.0) {
        close(1.0);
    }
}

// Whether the metal that may stand over the touched place is all that stands there.
bool StripRidge::clear_square_to(const Probe& probe) const
{
    const double high = strayed_ * allowed(probe.secant);
    const Vec2d way = probe.gradient * (-1.0 / probe.secant);
    const Vec2d place = probe.touched + way * high;
    return left_at(place, probe.at) <= probe.floor + high / probe.secant;
}

}  // namespace cusp::host
