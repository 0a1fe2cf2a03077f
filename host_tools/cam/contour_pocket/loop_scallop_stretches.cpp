// Examines cross lines in order. The stretch between two neighbours is reported if one of them has
// too high a scallop.
#include <algorithm>
#include <cmath>

#include "host_tools/cam/contour_pocket/loop_scallop.hpp"
#include "host_tools/cam/contour_pocket/loop_spacing.hpp"

namespace cusp::contour_pocket {

using clearing::LoopStrip;
using clearing::PartialLoop;
using offset::distance;
using offset::Edge;
using offset::Region2d;

void LoopScallop::begin(const LoopStrip& strip)
{
    const double step = strip.to - strip.from;
    segments_.clear();
    set_paths(strip.outer, step);
    set_paths(strip.inner, step);
    sort_segments(step);
}

void LoopScallop::add(const std::vector<PartialLoop>& loops)
{
    Region2d paths;
    for (const PartialLoop& loop : loops) {
        paths.contours.push_back(loop.path);
    }
    const double cell = cell_;
    set_paths(paths, cell);
    sort_segments(cell);
}

std::vector<Edge> LoopScallop::stretches(const std::vector<Edge>& edges,
                                         const LoopStrip& strip,
                                         double from,
                                         double to)
{
    if (to - from <= least_stepover(floor_.tool(), tolerances_)) {
        return {};
    }
    const Search search{strip, from - strip.from, to - from, true};
    set_resolution(search.step);
    std::vector<Edge> found;
    for (const Edge& edge : edges) {
        stretches_on(edge, search, found);
    }
    return found;
}

void LoopScallop::stretches_on(const Edge& edge,
                               const Search& search,
                               std::vector<Edge>& found) const
{
    constexpr double kPoint = 1e-6;  // mm
    // A flat bottom leaves steps over narrow places between the lines.
    const double max_share = ball_ ? 1.0 : 0.85;
    const bool corners = search.foot == 0.0;
    const std::vector<double> places = places_along(edge, {corners, corners}, search.step);
    double begin = -1.0;
    const auto close = [&](double end) {
        const Vec2d a = point_on(edge, begin);
        const Vec2d b = point_on(edge, end);
        if (begin >= 0.0 && distance(a, b) > kPoint) {
            found.push_back(cusp::offset::between(edge, a, b));
        }
        begin = -1.0;
    };
    CrossLine last = cross_line(edge, places.front(), search);
    for (std::size_t i = 1; i < places.size(); ++i) {
        const CrossLine next = cross_line(edge, places[i], search);
        const double share = std::max(
            {last.share, next.share, left_beside(last, next), between(edge, last, next, search)});
        if (share > max_share) {
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

// True if the stock above the contact is no higher than allowed, along the normal.
bool LoopScallop::is_low_along_normal(const Probe& probe) const
{
    const double high = scallop_share_ * allowed(probe.secant);
    const Vec2d way = probe.gradient * (-1.0 / probe.secant);
    const Vec2d place = probe.touched + way * high;
    return left_at(place, probe.at) <= *probe.floor + high / probe.secant;
}

}  // namespace cusp::contour_pocket
