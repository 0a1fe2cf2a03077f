// Searches from the ends of the pencil passes' edges, which are short.
#include "host_tools/cam/contour_pocket/pencil_detours.hpp"

#include <algorithm>
#include <optional>

#include "host_tools/cam/clearing/clear_path.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::contour_pocket {

using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::is_path_clear;
using clearing::PassStart;
using offset::area;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::EdgeTree;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using offset::reversed;
using offset::surrounds;

namespace {

constexpr double kOnePlace = 1e-6;  // mm

struct Place {
    std::size_t pass;
    std::size_t edge;
    Vec2d at;            // on the loop
    std::size_t corner;  // of the pencil pass: the start of that edge, or its end
    double apart;        // mm from that corner
};

bool is_closed(const Contour& path)
{
    return distance(path.front().start, path.back().end) < kOnePlace;
}

// From the corner to the end and, unless that is the start again, back over all of it.
std::vector<Edge> out_and_back(const Contour& pencil, const Place& place)
{
    const auto middle = pencil.begin() + static_cast<std::ptrdiff_t>(place.corner);
    const Vec2d corner =
        place.corner < pencil.size() ? pencil[place.corner].start : pencil.back().end;
    std::vector<Edge> path;
    if (distance(place.at, corner) > kOnePlace) {
        path.push_back(line_edge(place.at, corner));
    }
    path.insert(path.end(), middle, pencil.end());
    if (!is_closed(pencil)) {
        const Contour back = reversed(pencil);
        path.insert(path.end(), back.begin(), back.end());
    }
    path.insert(path.end(), pencil.begin(), middle);
    if (distance(place.at, corner) > kOnePlace) {
        path.push_back(line_edge(corner, place.at));
    }
    return path;
}

class DetourPlaces {
public:
    DetourPlaces(const ClearedRegion& cleared,
                 const RegionOffset& walls,
                 double wall_clearance,
                 double radius)
        : walls_{walls}, wall_clearance_{wall_clearance}, radius_{radius}, tree_{sorted(cleared)}
    {
    }

    // The place where a detour along the pencil pass may leave a loop, if any.
    std::optional<Place> find(const Contour& pencil) const
    {
        constexpr double kBeside = 0.1;  // of the radius
        std::optional<Place> best;
        for (std::size_t i = 0; i <= pencil.size() && tree_.size() > 0; ++i) {
            const Vec2d corner = i < pencil.size() ? pencil[i].start : pencil.back().end;
            const EdgeTree::Nearest nearest = tree_.nearest_edge(corner);
            const Owner& owner = owners_[nearest.edge];
            const Place place{owner.pass, owner.edge, nearest.point, i, nearest.distance};
            const bool beside = place.apart < kBeside * radius_;
            const bool better = !best ? true
                                : beside && best->apart < kBeside * radius_
                                    ? place.pass > best->pass
                                    : place.apart < best->apart;
            if (better && place.apart < radius_ &&
                is_path_clear(walls_, line_edge(corner, place.at), wall_clearance_)) {
                best = place;
            }
        }
        return best;
    }

private:
    struct Owner {
        std::size_t pass;
        std::size_t edge;
    };

    // The edges of loops. Passes entered from above are left out: they start with a slope along all
    // of them.
    std::vector<Edge> sorted(const ClearedRegion& cleared)
    {
        std::vector<Edge> edges;
        for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
            const Contour& path = cleared.passes[i].path;
            for (std::size_t e = 0; cleared.passes[i].start == PassStart::kLink && e < path.size();
                 ++e) {
                edges.push_back(path[e]);
                owners_.push_back({i, e});
            }
        }
        return edges;
    }

    const RegionOffset& walls_;
    double wall_clearance_;
    double radius_;
    std::vector<Owner> owners_;
    EdgeTree tree_;
};

struct PencilDetour {
    Place place;
    ClearingPass pass;
};

// The pass up to each place, the detour from there, and so on.
void divide(const ClearingPass& pass,
            std::vector<PencilDetour>& detours,
            std::vector<ClearingPass>& result)
{
    std::sort(detours.begin(), detours.end(), [&](const PencilDetour& a, const PencilDetour& b) {
        return a.place.edge != b.place.edge
                   ? a.place.edge < b.place.edge
                   : distance(pass.path[a.place.edge].start, a.place.at) <
                         distance(pass.path[b.place.edge].start, b.place.at);
    });
    ClearingPass part = pass;
    part.path.clear();
    const auto add = [&](const Edge& edge, Vec2d from, Vec2d to) {
        if (distance(from, to) > kOnePlace) {
            part.path.push_back(between(edge, from, to));
        }
    };
    const auto close = [&] {
        if (!part.path.empty()) {
            result.push_back(part);
            part.path.clear();
            part.start = PassStart::kContinue;
            part.link.clear();
        }
    };
    auto next = detours.begin();
    for (std::size_t e = 0; e < pass.path.size(); ++e) {
        const Edge& edge = pass.path[e];
        Vec2d from = edge.start;
        for (; next != detours.end() && next->place.edge == e; ++next) {
            add(edge, from, next->place.at);
            from = distance(from, next->place.at) > kOnePlace ? next->place.at : from;
            close();
            result.push_back(next->pass);
        }
        add(edge, from, edge.end);
    }
    close();
}

}  // namespace

void add_pencil_passes(ClearedRegion& cleared,
                       const std::vector<ClearingPass>& pencils,
                       const Region2d& reach)
{
    // Reach regions are not nested: islands have no inside.
    const auto part_of = [&](const ClearingPass& pass) {
        return std::find_if(reach.contours.begin(), reach.contours.end(), [&](const Contour& c) {
            return area(c) > 0.0 && surrounds(c, pass.path.front().start);
        });
    };
    std::vector<std::vector<ClearingPass>> behind(cleared.passes.size());
    for (const ClearingPass& pencil : pencils) {
        const auto part = part_of(pencil);
        std::size_t last = cleared.passes.size() - 1;
        while (last > 0 && part_of(cleared.passes[last]) != part) {
            --last;
        }
        behind[last].push_back(pencil);
    }
    std::vector<ClearingPass> passes;
    for (std::size_t i = 0; i < behind.size(); ++i) {
        passes.push_back(cleared.passes[i]);
        passes.insert(passes.end(), behind[i].begin(), behind[i].end());
    }
    cleared.passes = std::move(passes);
}

std::vector<ClearingPass> add_pencil_detours(ClearedRegion& cleared,
                                             const std::vector<ClearingPass>& pencils,
                                             const RegionOffset& walls,
                                             double wall_clearance,
                                             double radius)
{
    const DetourPlaces places{cleared, walls, wall_clearance, radius};
    std::vector<std::vector<PencilDetour>> detours(cleared.passes.size());
    std::vector<ClearingPass> alone;
    for (const ClearingPass& pencil : pencils) {
        const std::optional<Place> place = places.find(pencil.path);
        if (!place) {
            alone.push_back(pencil);
            continue;
        }
        PencilDetour detour{*place, pencil};
        detour.pass.start = PassStart::kContinue;
        detour.pass.path = out_and_back(pencil.path, *place);
        detours[place->pass].push_back(std::move(detour));
    }
    std::vector<ClearingPass> passes;
    for (std::size_t i = 0; i < cleared.passes.size(); ++i) {
        if (detours[i].empty()) {
            passes.push_back(cleared.passes[i]);
        } else {
            divide(cleared.passes[i], detours[i], passes);
        }
    }
    cleared.passes = std::move(passes);
    return alone;
}

}  // namespace cusp::contour_pocket
