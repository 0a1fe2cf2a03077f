// The circle touches the contour from the side of the waste, so the tool's direction does not jump.
#include "host_tools/cam/prismatic/profile_leads.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::prismatic {

using offset::arc_edge;
using offset::Edge;
using offset::EdgeTree;
using offset::left_normal;
using offset::point_on;
using offset::tangent_on;

// Samples 0.05 mm apart: between two of them the distance from a wall dips by at most an eighth of
// that squared times the curvatures of arc and wall offset, 1e-3 mm for radii of 0.6 mm; where the
// arc comes near the wall it runs along it.
bool keeps_clear(const Edge& way, const EdgeTree& walls, double clearance)
{
    constexpr double kApart = 0.05;     // mm
    constexpr double kRounding = 1e-6;  // mm
    const int pieces = 8 + static_cast<int>(offset::length(way) / kApart);
    for (int i = 0; i <= pieces; ++i) {
        if (walls.any_nearer(point_on(way, static_cast<double>(i) / pieces),
                             clearance - kRounding)) {
            return false;
        }
    }
    return true;
}

namespace {

// The arcs at a place of an edge; none where one has no room.
std::optional<Leads> leads_at(const Edge& edge,
                              double share,
                              const EdgeTree& walls,
                              const LeadSettings& settings,
                              double scale)
{
    const Vec2d p = point_on(edge, share);
    const Vec2d t = tangent_on(edge, share);
    const Vec2d n = left_normal(t) * (settings.waste_on_left ? 1.0 : -1.0);
    const int turn = settings.waste_on_left ? 1 : -1;
    Leads leads;
    if (const double r = settings.in * scale; r > 0) {
        const Vec2d centre = p + n * r;
        leads.in = arc_edge(centre - t * r, p, centre, turn);
        if (!keeps_clear(*leads.in, walls, settings.clearance)) {
            return std::nullopt;
        }
    }
    if (const double r = settings.out * scale; r > 0) {
        const Vec2d centre = p + n * r;
        leads.out = arc_edge(p, centre + t * r, centre, turn);
        if (!keeps_clear(*leads.out, walls, settings.clearance)) {
            return std::nullopt;
        }
    }
    return leads;
}

// A place that a contour may begin at.
struct Place {
    std::size_t edge;
    double share;  // of the edge
    double rank;   // mm: of the edge's length; straight sides count four times
    double way;    // mm: of rapid moves
};

// The first that are worth a look, the best first.
std::vector<Place> places_on(const std::vector<Edge>& edges,
                             const std::function<double(Vec2d)>& way)
{
    constexpr std::size_t kMostPlaces = 192;
    constexpr double kLong = 0.5;  // of the longest side
    std::vector<Place> places;
    double longest = 0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const double rank = offset::length(edges[k]) * (edges[k].turn == 0 ? 4.0 : 1.0);
        longest = std::max(longest, rank);
        for (const double share : {0.5, 0.25, 0.75}) {
            places.push_back({k, share, rank, way ? way(point_on(edges[k], share)) : 0.0});
        }
    }
    std::stable_sort(places.begin(), places.end(), [&](const Place& a, const Place& b) {
        const bool a_long = a.rank >= kLong * longest;
        if (!way || a_long != (b.rank >= kLong * longest)) {
            return a.rank > b.rank;
        }
        return a.way < b.way;
    });
    places.resize(std::min(places.size(), kMostPlaces));
    return places;
}

}  // namespace

LeadContour with_leads(const ContourRun& contour,
                       const EdgeTree& walls,
                       const std::vector<double>& kept,
                       double free,
                       const LeadSettings& settings,
                       const std::function<double(Vec2d)>& way)
{
    constexpr double kLeastScale = 1.0 / 16;
    const std::vector<Edge>& edges = contour.edges();
    const std::vector<Place> places = places_on(edges, way);
    const auto is_free = [&](double at) {
        return std::all_of(kept.begin(), kept.end(), [&](double k) {
            const double apart = std::abs(k - at);
            return std::min(apart, contour.length() - apart) > free;
        });
    };
    for (double scale = 1; scale >= kLeastScale; scale /= 2) {
        for (const Place& place : places) {
            const Edge& edge = edges[place.edge];
            const double at = contour.begin_of(place.edge) + place.share * offset::length(edge);
            if (!is_free(at)) {
                continue;
            }
            if (const auto leads = leads_at(edge, place.share, walls, settings, scale)) {
                return {contour.turned(at), *leads};
            }
        }
    }
    return {contour, {}};
}

}  // namespace cusp::prismatic
