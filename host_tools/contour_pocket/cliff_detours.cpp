// Looks from the ends of the cliff passes' edges, which are short.
#include "host_tools/contour_pocket/cliff_detours.hpp"

#include <algorithm>

#include "host_tools/clearing/free_way.hpp"
#include "host_tools/offset/edge_tree.hpp"

namespace cusp::host {

namespace {

constexpr double kOnePlace = 1e-6;  // mm

struct Place {
    std::size_t pass;
    std::size_t edge;
    Vec2d at;            // on the pass
    std::size_t corner;  // of the cliff pass: the start of that edge, or its end
    double apart{1e300};
};

bool is_closed(const Contour& path)
{
    return distance(path.front().start, path.back().end) < kOnePlace;
}

// From the corner on to the end and, where that is not the start, back over all of it.
std::vector<Edge> out_and_back(const Contour& cliff, const Place& place)
{
    const auto middle = cliff.begin() + static_cast<std::ptrdiff_t>(place.corner);
    const Vec2d corner = place.corner < cliff.size() ? cliff[place.corner].start : cliff.back().end;
    std::vector<Edge> path;
    if (distance(place.at, corner) > kOnePlace) {
        path.push_back(line_edge(place.at, corner));
    }
    path.insert(path.end(), middle, cliff.end());
    if (!is_closed(cliff)) {
        const Contour back = reversed(cliff);
        path.insert(path.end(), back.begin(), back.end());
    }
    path.insert(path.end(), cliff.begin(), middle);
    if (distance(place.at, corner) > kOnePlace) {
        path.push_back(line_edge(corner, place.at));
    }
    return path;
}

class DetourPlaces {
public:
    DetourPlaces(const ClearedRegion& cleared,
                 const RegionOffset& walls,
                 double least,
                 double radius)
        : walls_{walls}, least_{least}, radius_{radius}, tree_{sorted(cleared)}
    {
    }

    Place find(const Contour& cliff) const
    {
        constexpr double kBeside = 0.1;  // of the radius
        Place best{};
        for (std::size_t i = 0; i <= cliff.size() && tree_.size() > 0; ++i) {
            const Vec2d corner = i < cliff.size() ? cliff[i].start : cliff.back().end;
            const EdgeTree::Nearest nearest = tree_.nearest_edge(corner);
            const Owner& owner = owners_[nearest.edge];
            const Place place{owner.pass, owner.edge, nearest.point, i, nearest.distance};
            const bool beside = place.apart < kBeside * radius_;
            const bool better = beside && best.apart < kBeside * radius_ ? place.pass > best.pass
                                                                         : place.apart < best.apart;
            if (better && place.apart < radius_ &&
                is_free(walls_, line_edge(corner, place.at), least_)) {
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

    // Passes that are entered from above start with a slope along all of them.
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
    double least_;
    double radius_;
    std::vector<Owner> owners_;
    EdgeTree tree_;
};

struct CliffDetour {
    Place place;
    ClearingPass pass;
};

// The pass up to each place, the way out there, and so on.
void divide(const ClearingPass& pass,
            std::vector<CliffDetour>& detours,
            std::vector<ClearingPass>& result)
{
    std::sort(detours.begin(), detours.end(), [&](const CliffDetour& a, const CliffDetour& b) {
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
            part.start = PassStart::kHere;
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

void add_cliff_passes(ClearedRegion& cleared,
                      const std::vector<ClearingPass>& cliffs,
                      const Region2d& reach)
{
    // No part lies inside another: islands have no inside.
    const auto part_of = [&](const ClearingPass& pass) {
        return std::find_if(reach.contours.begin(), reach.contours.end(), [&](const Contour& c) {
            return area(c) > 0.0 && surrounds(c, pass.path.front().start);
        });
    };
    std::vector<std::vector<ClearingPass>> behind(cleared.passes.size());
    for (const ClearingPass& cliff : cliffs) {
        const auto part = part_of(cliff);
        std::size_t last = cleared.passes.size() - 1;
        while (last > 0 && part_of(cleared.passes[last]) != part) {
            --last;
        }
        behind[last].push_back(cliff);
    }
    std::vector<ClearingPass> passes;
    for (std::size_t i = 0; i < behind.size(); ++i) {
        passes.push_back(cleared.passes[i]);
        passes.insert(passes.end(), behind[i].begin(), behind[i].end());
    }
    cleared.passes = std::move(passes);
}

std::vector<ClearingPass> add_cliff_detours(ClearedRegion& cleared,
                                            const std::vector<ClearingPass>& cliffs,
                                            const RegionOffset& walls,
                                            double least,
                                            double radius)
{
    const DetourPlaces places{cleared, walls, least, radius};
    std::vector<std::vector<CliffDetour>> detours(cleared.passes.size());
    std::vector<ClearingPass> alone;
    for (const ClearingPass& cliff : cliffs) {
        const Place place = places.find(cliff.path);
        if (place.apart >= radius) {
            alone.push_back(cliff);
            continue;
        }
        CliffDetour detour{place, cliff};
        detour.pass.start = PassStart::kHere;
        detour.pass.path = out_and_back(cliff.path, place);
        detours[place.pass].push_back(std::move(detour));
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

}  // namespace cusp::host
