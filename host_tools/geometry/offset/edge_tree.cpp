// The tree is built by halving at the median along the longer side, so its depth is below 40.
#include "host_tools/geometry/offset/edge_tree.hpp"

#include <algorithm>
#include <numeric>

namespace cusp::offset {

namespace {

constexpr std::uint32_t kLeafSize = 4;

void grow(Box2d& box, const Box2d& by)
{
    box.x0 = std::min(box.x0, by.x0);
    box.y0 = std::min(box.y0, by.y0);
    box.x1 = std::max(box.x1, by.x1);
    box.y1 = std::max(box.y1, by.y1);
}

double square_distance(const Box2d& box, Vec2d p)
{
    const double dx = std::max(0.0, std::max(box.x0 - p.x, p.x - box.x1));
    const double dy = std::max(0.0, std::max(box.y0 - p.y, p.y - box.y1));
    return dx * dx + dy * dy;
}

}  // namespace

EdgeTree::EdgeTree(std::vector<Edge> edges) : edges_{std::move(edges)}, index_(edges_.size())
{
    std::iota(index_.begin(), index_.end(), 0U);
    boxes_.reserve(edges_.size());
    for (const Edge& edge : edges_) {
        boxes_.push_back(box_of(edge));
    }
    if (edges_.empty()) {
        return;
    }
    nodes_.reserve(edges_.size());
    nodes_.push_back({});
    build(0, 0, static_cast<std::uint32_t>(edges_.size()));
    std::vector<Edge> sorted;
    std::vector<Box2d> sorted_boxes;
    sorted.reserve(edges_.size());
    sorted_boxes.reserve(edges_.size());
    for (const std::uint32_t i : index_) {
        sorted.push_back(edges_[i]);
        sorted_boxes.push_back(boxes_[i]);
    }
    edges_ = std::move(sorted);
    boxes_ = std::move(sorted_boxes);
}

void EdgeTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count)
{
    Box2d box;
    for (std::uint32_t i = first; i < first + count; ++i) {
        grow(box, boxes_[index_[i]]);
    }
    if (count <= kLeafSize) {
        nodes_[node] = {box, first, count};
        return;
    }
    const bool wide = box.x1 - box.x0 > box.y1 - box.y0;
    const auto centre = [&](std::uint32_t i) {
        return wide ? boxes_[i].x0 + boxes_[i].x1 : boxes_[i].y0 + boxes_[i].y1;
    };
    const auto begin = index_.begin() + first;
    const std::uint32_t half = count / 2;
    std::nth_element(begin, begin + half, begin + count,
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node] = {box, child, 0};
    nodes_.resize(nodes_.size() + 2);
    build(child, first, half);
    build(child + 1, first + half, count - half);
}

bool EdgeTree::any_nearer(Vec2d point, double reach) const
{
    const double square = reach * reach;
    std::uint32_t stack[64];
    int depth = 0;
    const auto consider = [&](std::uint32_t node) {
        stack[depth] = node;
        depth += square_distance(nodes_[node].box, point) < square ? 1 : 0;
    };
    if (!nodes_.empty()) {
        consider(0);
    }
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (node.count == 0) {
            consider(node.first);
            consider(node.first + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (square_distance(boxes_[i], point) < square &&
                distance_to(edges_[i], point) < reach) {
                return true;
            }
        }
    }
    return false;
}

// Calls better(i), which updates `best`, for edges that may be nearer than `best`, near boxes
// first.
template <class Better>
void EdgeTree::search(Vec2d point, const double& best, Better better) const
{
    std::uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0 && !nodes_.empty()) {
        const Node& node = nodes_[stack[--depth]];
        if (square_distance(node.box, point) >= best * best) {
            continue;
        }
        if (node.count == 0) {
            const double left = square_distance(nodes_[node.first].box, point);
            const double right = square_distance(nodes_[node.first + 1].box, point);
            stack[depth++] = left < right ? node.first + 1 : node.first;
            stack[depth++] = left < right ? node.first : node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (square_distance(boxes_[i], point) < best * best) {
                better(i);
            }
        }
    }
}

std::optional<Vec2d> EdgeTree::some_nearer(Vec2d point, double reach) const
{
    std::optional<Vec2d> found;
    double best = reach;
    search(point, best, [&](std::uint32_t i) {
        const Vec2d near = nearest_on(edges_[i], point);
        if (!found && distance(near, point) < reach) {
            found = near;
            best = 0.0;  // ends the search
        }
    });
    return found;
}

bool EdgeTree::surrounds(Vec2d point) const
{
    bool inside = false;
    visit_sorted({point.x, point.y, kUnbounded, point.y},
                 [&](std::uint32_t i) { inside ^= crossed_by_ray(edges_[i], point); });
    return inside;
}

double EdgeTree::nearest(Vec2d point, double limit) const
{
    double best = limit;
    search(point, best,
           [&](std::uint32_t i) { best = std::min(best, distance_to(edges_[i], point)); });
    return best;
}

EdgeTree::Nearest EdgeTree::nearest_edge(Vec2d point) const
{
    double best = kUnbounded;
    std::uint32_t at = 0;
    search(point, best, [&](std::uint32_t i) {
        const double apart = distance_to(edges_[i], point);
        if (apart < best) {
            best = apart;
            at = i;
        }
    });
    return {best, nearest_on(edges_[at], point), index_[at]};
}

}  // namespace cusp::offset
