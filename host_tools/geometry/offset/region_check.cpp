// Finds crossings with a box tree and nesting faults with one probe a contour.
#include "host_tools/geometry/offset/region_check.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/edge_crossings.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

namespace {

struct Place {
    std::size_t contour;
    std::size_t edge;
};

// True if the edges certainly cross: false where one only ends on the other. Contours that cross at
// corners are found by probing the middles of their edges.
bool passes_through(const Edge& a, const Edge& b, Vec2d p)
{
    const bool end_of_a = distance(p, a.start) < kSamePoint || distance(p, a.end) < kSamePoint;
    const bool end_of_b = distance(p, b.start) < kSamePoint || distance(p, b.end) < kSamePoint;
    return !end_of_a && !end_of_b;
}

std::optional<RegionFault> crossing_of(const Region2d& region, Place i, Place j)
{
    const Contour& first = region.contours[i.contour];
    const Edge& a = first[i.edge];
    const Edge& b = region.contours[j.contour][j.edge];
    const bool neighbours = i.contour == j.contour && ((i.edge + 1) % first.size() == j.edge ||
                                                       (j.edge + 1) % first.size() == i.edge);
    for (const Vec2d p : crossings(a, b, 1e-9)) {
        const bool common_end =
            neighbours && (distance(p, a.end) < kSamePoint || distance(p, a.start) < kSamePoint);
        if (i.contour == j.contour ? !common_end : passes_through(a, b, p)) {
            const auto kind =
                i.contour == j.contour ? RegionFaultKind::kCrossesItself : RegionFaultKind::kCross;
            return RegionFault{kind, std::min(i.contour, j.contour), std::max(i.contour, j.contour),
                               p};
        }
    }
    return std::nullopt;
}

std::optional<RegionFault> find_crossing(const Region2d& region)
{
    std::vector<Edge> edges;
    std::vector<Place> places;
    for (std::size_t c = 0; c < region.contours.size(); ++c) {
        for (std::size_t e = 0; e < region.contours[c].size(); ++e) {
            edges.push_back(region.contours[c][e]);
            places.push_back({c, e});
        }
    }
    const EdgeTree tree{edges};
    std::optional<RegionFault> fault;
    for (std::size_t i = 0; i < edges.size() && !fault; ++i) {
        tree.visit_meeting(box_of(edges[i]), [&](std::uint32_t j) {
            if (j > i && !fault) {
                fault = crossing_of(region, places[i], places[j]);
            }
        });
    }
    return fault;
}

// A point of the hole on the wrong side of another contour. Precondition: contours do not cross
// between corners, so an edge lies on the same side as its middle. Edges along the other contour
// are skipped; for two equal contours every point counts.
std::optional<Vec2d> stray_point(const Contour& hole, const EdgeTree& other, bool should_surround)
{
    bool apart = false;
    for (const Edge& edge : hole) {
        const Vec2d p = point_on(edge, 0.4142);
        const bool upon = other.any_nearer(p, kSamePoint);
        if (!upon && other.surrounds(p) != should_surround) {
            return p;
        }
        apart = apart || !upon;
    }
    return apart ? std::nullopt : std::optional{hole.front().start};
}

// The first hole that is not directly inside the outer contour.
std::optional<RegionFault> find_stray_hole(const Region2d& region)
{
    std::vector<EdgeTree> trees;
    std::vector<Box2d> boxes;
    for (const Contour& contour : region.contours) {
        trees.emplace_back(contour);
        boxes.push_back(box_of(Region2d{{contour}}));
    }
    for (std::size_t i = 1; i < region.contours.size(); ++i) {
        for (std::size_t j = 0; j < region.contours.size(); ++j) {
            if (j == i || (j > 0 && !meet(boxes[i], boxes[j]))) {
                continue;
            }
            if (const auto p = stray_point(region.contours[i], trees[j], j == 0)) {
                const auto kind =
                    j == 0 ? RegionFaultKind::kHoleOutside : RegionFaultKind::kHoleInHole;
                return RegionFault{kind, j, i, *p};
            }
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<RegionFault> find_fault(const Region2d& region)
{
    for (std::size_t c = 0; c < region.contours.size(); ++c) {
        for (const Edge& edge : region.contours[c]) {
            if (distance(edge.start, edge.end) < kSamePoint) {
                return RegionFault{RegionFaultKind::kNoLength, c, c, edge.start};
            }
        }
    }
    if (const auto fault = find_crossing(region)) {
        return fault;
    }
    return find_stray_hole(region);
}

std::string fault_text(const RegionFault& fault,
                       const std::string& first,
                       const std::string& second,
                       const std::string& where)
{
    const std::string at = " at " + where;
    switch (fault.kind) {
        case RegionFaultKind::kNoLength:
            return first + ": a curve has no length" + at;
        case RegionFaultKind::kCrossesItself:
            return first + ": the loop crosses itself" + at;
        case RegionFaultKind::kCross:
            return first + ": crosses " + second + at;
        case RegionFaultKind::kHoleOutside:
            return second + ": the island lies outside the boundary" + at;
        case RegionFaultKind::kHoleInHole:
            break;
    }
    return second + ": the island lies inside another, " + first + "," + at;
}

}  // namespace cusp::offset
