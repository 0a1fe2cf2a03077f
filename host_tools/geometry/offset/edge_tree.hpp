// A static tree of boxes over edges: nearest distance in O(log n) for evenly spread edges.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

class EdgeTree {
public:
    explicit EdgeTree(std::vector<Edge> edges);

    std::size_t size() const { return edges_.size(); }  // edges

    // True if some edge is nearer to the point than `reach`.
    bool any_nearer(Vec2d point, double reach) const;

    // The smaller of `limit` and the least distance to an edge.
    double nearest(Vec2d point, double limit) const;

    // True if the edges run around the point an odd number of times: for the contours of a region,
    // whether the point belongs to it. As cusp::offset::contains(), in O(log n + edges to the right
    // of the point).
    bool surrounds(Vec2d point) const;

    struct Nearest {
        double distance;
        Vec2d point;
        std::size_t edge;  // index in the caller's list
    };
    // Precondition: there are edges.
    Nearest nearest_edge(Vec2d point) const;

    // The nearest point of the first edge found within `reach` of the point.
    std::optional<Vec2d> some_nearer(Vec2d point, double reach) const;

    // Calls visit(index) for the edges whose boxes intersect the given one.
    template <class Visit>
    void visit_meeting(const Box2d& box, Visit visit) const;

private:
    // As visit_meeting(), with indices into edges_.
    template <class Visit>
    void visit_sorted(const Box2d& box, Visit visit) const;

    struct Node {
        Box2d box;
        std::uint32_t first;  // edge of a leaf, or left child; the right child is next to it
        std::uint32_t count;  // 0 for an inner node
    };
    template <class Better>
    void search(Vec2d point, const double& best, Better better) const;
    void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

    std::vector<Edge> edges_;
    std::vector<Box2d> boxes_;
    std::vector<std::uint32_t> index_;  // of edges_[i] in the caller's list
    std::vector<Node> nodes_;
};

inline bool meet(const Box2d& a, const Box2d& b)
{
    return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

template <class Visit>
void EdgeTree::visit_meeting(const Box2d& box, Visit visit) const
{
    visit_sorted(box, [&](std::uint32_t i) { visit(index_[i]); });
}

template <class Visit>
void EdgeTree::visit_sorted(const Box2d& box, Visit visit) const
{
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0 && !nodes_.empty()) {
        const Node& node = nodes_[stack[--depth]];
        if (!meet(node.box, box)) {
            continue;
        }
        if (node.count == 0) {
            stack[depth++] = node.first;
            stack[depth++] = node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (meet(boxes_[i], box)) {
                visit(i);
            }
        }
    }
}

}  // namespace cusp::offset
