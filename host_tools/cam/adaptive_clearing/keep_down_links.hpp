// Links at depth: from where a pass ends, through swept ground, to where the next one starts.
//
//     KeepDownLinks links{swept, walls, wall_clearance};
//     std::vector<LinkLeg> link = links.between(end, start);    // empty: the tool has to lift
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

#include "host_tools/cam/adaptive_clearing/swept_area.hpp"
#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::adaptive_clearing {

// A straight move of a link.
struct LinkLeg {
    Vec2d end;
    // Stock and walls stay 0.03 radii away from the tool: it may go at rapid.
    bool free{};
    // No stock is met: the tool may rise on its way. Stock that a tool above the floor met would
    // also be below it, where the tool may come down at rapid.
    bool may_rise{};
};

class KeepDownLinks {
public:
    // wall_clearance  mm: of the tool's centre
    KeepDownLinks(const SweptArea& swept, const offset::RegionOffset& walls, double wall_clearance);

    // Straight if that is free, else around stock. Engagement along a link is at most a few
    // degrees. Empty if there is no way, or only a long one.
    std::vector<LinkLeg> between(Vec2d from, Vec2d to);

    // For a tool that comes down where stock is near `start`: the move at the feed from a place
    // without any. None where no stock is near, or no such place.
    std::optional<offset::Edge> approach(Vec2d start) const;

private:
    using Node = std::uint64_t;  // of the lattice of places
    bool is_room(Vec2d place) const;
    bool is_free(Vec2d from, Vec2d to) const;
    bool is_free(Node node);
    bool is_open(Vec2d from, Vec2d to) const;
    std::optional<Vec2d> beside(Vec2d place) const;
    std::vector<Vec2d> way(Vec2d from, Vec2d to);
    std::vector<Vec2d> straightened(const std::vector<Vec2d>& places) const;
    Node node_at(Vec2d place) const;
    Vec2d place_of(Node node) const;

    const SweptArea& swept_;
    const offset::RegionOffset& walls_;
    double wall_clearance_;
    double radius_;
    double pitch_;
    std::unordered_set<Node> known_free_;  // what is free stays free
};

}  // namespace cusp::adaptive_clearing
