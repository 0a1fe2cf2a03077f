// The tip's way is looked at in steps, and its ends are found between two looks by halving.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/job/import/solid_edges.hpp"
#include "host_tools/job/job/chamfer_tip.hpp"

namespace cusp::import {

using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::Region2d;

namespace {

constexpr double kWayLook = 0.4;   // mm between looks along a way
constexpr double kWayEnd = 1e-3;   // mm: of the ends of a way
constexpr double kLeastWay = 0.5;  // mm: a shorter one is none
constexpr double kClear =
    0.01;  // mm that the tool may be in the part, by the heights of its facets

// A place on a contour.
struct OnWay {
    std::size_t edge;
    double share;
};

std::vector<OnWay> places_along(const Contour& contour)
{
    std::vector<OnWay> places;
    for (std::size_t n = 0; n < contour.size(); ++n) {
        const int looks = 1 + static_cast<int>(length(contour[n]) / kWayLook);
        for (int k = 0; k < looks; ++k) {
            places.push_back({n, (k + 0.5) / looks});
        }
    }
    return places;
}

Vec2d point_at(const Contour& contour, OnWay at) { return point_on(contour[at.edge], at.share); }

// The edges from one place on to another one.
std::vector<Edge> stretch(const Contour& contour, OnWay from, OnWay to)
{
    std::vector<Edge> edges;
    const auto add = [&](const Edge& edge, Vec2d a, Vec2d b) {
        if (offset::distance(a, b) > offset::kSamePoint) {
            edges.push_back(offset::between(edge, a, b));
        }
    };
    if (from.edge == to.edge && from.share <= to.share) {
        add(contour[from.edge], point_at(contour, from), point_at(contour, to));
        return edges;
    }
    add(contour[from.edge], point_at(contour, from), contour[from.edge].end);
    for (std::size_t n = (from.edge + 1) % contour.size(); n != to.edge;
         n = (n + 1) % contour.size()) {
        edges.push_back(contour[n]);
    }
    add(contour[to.edge], contour[to.edge].start, point_at(contour, to));
    return edges;
}

// Between a place that is good and its neighbour that is not: the last good one.
template <class IsGood>
OnWay last_good(const Contour& contour, OnWay good, OnWay bad, const IsGood& is_good)
{
    // on the edge of the good one; a way ends at the next edge at the latest
    const bool onwards = bad.edge == good.edge ? bad.share > good.share
                                               : bad.edge == (good.edge + 1) % contour.size();
    OnWay limit{good.edge, bad.edge == good.edge ? bad.share : onwards ? 1.0 : 0.0};
    if (bad.edge != good.edge && is_good(point_at(contour, limit))) {
        return limit;
    }
    while (std::abs(limit.share - good.share) * length(contour[good.edge]) > kWayEnd) {
        const OnWay middle{good.edge, (good.share + limit.share) / 2};
        (is_good(point_at(contour, middle)) ? good : limit) = middle;
    }
    return good;
}

// The longest stretches of a contour all of whose places are good.
template <class IsGood>
void add_stretches(const Contour& contour,
                   const IsGood& is_good,
                   std::vector<std::vector<Edge>>& found)
{
    const std::vector<OnWay> places = places_along(contour);
    const std::size_t count = places.size();
    std::vector<bool> good;
    for (const OnWay& place : places) {
        good.push_back(is_good(point_at(contour, place)));
    }
    const auto first_bad = std::find(good.begin(), good.end(), false);
    if (first_bad == good.end()) {
        found.push_back(contour);
        return;
    }
    const auto begin = static_cast<std::size_t>(first_bad - good.begin());
    for (std::size_t k = 1; k < count; ++k) {
        const std::size_t from = (begin + k) % count;
        if (!good[from]) {
            continue;
        }
        std::size_t to = from;
        for (; good[(to + 1) % count]; to = (to + 1) % count) {
            ++k;
        }
        std::vector<Edge> way = stretch(
            contour, last_good(contour, places[from], places[(from + count - 1) % count], is_good),
            last_good(contour, places[to], places[(to + 1) % count], is_good));
        if (!way.empty() && length(way) >= kLeastWay) {
            found.push_back(std::move(way));
        }
    }
}

}  // namespace

std::vector<bool> SolidEdges::on_band(const std::vector<Look>& looks,
                                      const EdgeTree& tree,
                                      const EdgeBand& band) const
{
    std::vector<Rise> rises;
    for (const Look& look : looks) {
        rises.push_back(rise_at(look, tree, band));
    }
    const std::size_t count = looks.size();
    std::vector<bool> on(count, false);
    const auto flat =
        std::find_if(rises.begin(), rises.end(), [](const Rise& rise) { return !rise.evenly; });
    const auto begin =
        static_cast<std::size_t>(flat - rises.begin()) % std::max<std::size_t>(count, 1);
    for (std::size_t k = 0; k < count;) {
        std::size_t end = k;
        bool on_below = true;
        bool on_above = true;
        for (; end < count && rises[(begin + end) % count].evenly; ++end) {
            on_below = on_below && rises[(begin + end) % count].on_below;
            on_above = on_above && rises[(begin + end) % count].on_above;
        }
        for (std::size_t n = k; n < end; ++n) {
            on[(begin + n) % count] = !on_below && !on_above;
        }
        k = end + 1;
    }
    return on;
}

SolidEdges::Survey SolidEdges::survey(const EdgeBand& band) const
{
    Survey found;
    for (const Contour& loop : standing(band.low).contours) {
        const std::vector<Look> looks = looks_along(loop);
        const std::vector<bool> on = on_band(looks, EdgeTree{loop}, band);
        const bool is_whole = std::find(on.begin(), on.end(), false) == on.end();
        double length = 0;
        std::size_t rows = is_whole ? 1U : 0U;
        std::optional<Vec2d> place;
        for (std::size_t k = 0; k < looks.size(); ++k) {
            if (on[k]) {
                length += looks[k].step;
                rows += on[(k + looks.size() - 1) % looks.size()] ? 0U : 1U;
                place = place ? place : looks[k].foot;
            }
        }
        if (length >= kLeastWay) {
            found.place = is_whole && found.count > 0 ? found.place : *place;
            found.count += rows;
            found.length += length;
            found.has_parts = found.has_parts || !is_whole;
        }
    }
    return found;
}

EdgeWays SolidEdges::ways(const EdgeBand& band, const toolpath::Tool& vee) const
{
    const double away = vee.tip_radius + job::kChamferTip;
    const double tip =
        band.high - (band.width + job::kChamferTip) / elementary::tan(vee.tip_angle / 2);
    const Region2d stands = standing(band.low);
    std::vector<Look> seen;  // of the band
    EdgeWays found;
    for (const Contour& loop : stands.contours) {
        const std::vector<Look> looks = looks_along(loop);
        const std::vector<bool> on = on_band(looks, EdgeTree{loop}, band);
        for (std::size_t k = 0; k < looks.size(); ++k) {
            if (on[k]) {
                seen.push_back(looks[k]);
            }
        }
    }
    const EdgeTree tree{edges_of(stands)};
    std::vector<Edge> feet;
    for (const Look& look : seen) {
        const Vec2d half = offset::left_normal(look.across) * (look.step / 2);
        feet.push_back(offset::line_edge(look.foot - half, look.foot + half));
    }
    const EdgeTree on_band_tree{feet};
    const auto is_good = [&](Vec2d at) {
        constexpr double kSameAway = 0.01;  // mm
        constexpr double kSeen = 0.1;       // mm: looks stand for straight edges
        const Vec2d foot = tree.nearest_edge(at).point;
        const Look look{foot, offset::unit(foot - at), 0};
        if (std::abs(offset::distance(foot, at) - away) > kSameAway ||
            !on_band_tree.any_nearer(foot, kSeen) || !rise_at(look, tree, band).evenly) {
            return false;
        }
        return is_clear(vee, at, tip);
    };
    if (!seen.empty()) {
        for (const Contour& contour :
             offset::RegionOffset{offset::reversed(stands)}.at(away).contours) {
            add_stretches(contour, is_good, found.ways);
        }
    }
    std::vector<Edge> all;
    for (const std::vector<Edge>& way : found.ways) {
        all.insert(all.end(), way.begin(), way.end());
    }
    const EdgeTree beside{all};
    for (const Look& look : seen) {
        if (!all.empty() && beside.any_nearer(look.foot, 1.01 * away)) {
            found.broken += look.step;
        } else {
            found.left_at = look.foot;
        }
    }
    return found;
}

}  // namespace cusp::import
