// Boxes are searched in the order of their upper bounds of a ball's height.
#include "host_tools/part_model/facet_search.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::part_model {
namespace {

constexpr double kAlike = 1e-9;  // mm: heights of a ball on facets that share the contact

// Calls look(facet) for the facets in boxes whose bound exceeds the best height so far, higher
// bounds first.
template <class Bound, class Look>
void visit_facets(const PartModel::State& state, double best, const Bound& bound, const Look& look)
{
    struct Waiting {
        double bound;
        int node;
    };
    std::array<Waiting, 128> stack;
    std::size_t count = 0;
    if (!state.facets.empty()) {
        stack[count++] = {kInfinite, 0};
    }
    while (count > 0) {
        const Waiting next = stack[--count];
        if (next.bound == -kInfinite || next.bound < best - kAlike) {
            continue;
        }
        const BoxTree::Node& node = state.tree.nodes[static_cast<std::size_t>(next.node)];
        if (node.child[0] < 0) {
            const std::size_t first = static_cast<std::size_t>(-node.child[0] - 1);
            const std::size_t end = first + static_cast<std::size_t>(node.child[1]);
            for (std::size_t facet = first; facet < end; ++facet) {
                best = std::max(best, look(facet));
            }
            continue;
        }
        const auto waiting = [&](int child) {
            const BoxTree::Node& box = state.tree.nodes[static_cast<std::size_t>(child)];
            return Waiting{bound(box), child};
        };
        Waiting first = waiting(node.child[0]);
        Waiting second = waiting(node.child[1]);
        if (first.bound < second.bound) {
            std::swap(first, second);
        }
        stack[count++] = second;
        stack[count++] = first;
    }
}

double square_to_box(const BoxTree::Node& box, double x, double y)
{
    const double dx = std::max({box.low.x - x, x - box.high.x, 0.0});
    const double dy = std::max({box.low.y - y, y - box.high.y, 0.0});
    return dx * dx + dy * dy;
}

}  // namespace

std::optional<MeshContact> drop_ball_on_facets(const PartModel::State& state,
                                               double x,
                                               double y,
                                               double radius)
{
    std::optional<MeshContact> best;
    const auto facing = [&](const MeshContact& contact) {
        return dot(Vec3d{x, y, contact.at.centre} - contact.at.point,
                   state.facets[contact.facet].normal);
    };
    const auto bound = [&](const BoxTree::Node& box) {
        const double up = radius * radius - square_to_box(box, x, y);
        return up < 0 ? -kInfinite : box.high.z + std::sqrt(up);
    };
    const auto look = [&](std::size_t facet) {
        const double least = best ? best->at.centre - kAlike : -kInfinite;
        if (const auto found = drop_ball_on_facet(state.facets[facet], x, y, radius, least)) {
            const MeshContact other{*found, facet};
            const double over = best ? other.at.centre - best->at.centre : kInfinite;
            if (over > kAlike || (over > -kAlike && facing(other) > facing(*best))) {
                best = other;
            }
        }
        return best ? best->at.centre : -kInfinite;
    };
    // The next query is usually near the last one, and so is its result.
    const double known = state.facets.empty() ? -kInfinite : look(state.last_facet);
    visit_facets(state, known, bound, look);
    if (best) {
        state.last_facet = best->facet;
    }
    return best;
}

std::optional<FacetUnder> highest_facet(const PartModel::State& state, double x, double y)
{
    std::optional<FacetUnder> best;
    const auto bound = [&](const BoxTree::Node& box) {
        return square_to_box(box, x, y) > 0 ? -kInfinite : box.high.z;
    };
    visit_facets(state, -kInfinite, bound, [&](std::size_t facet) {
        const auto height = height_at(state.facets[facet], x, y);
        if (height && (!best || *height > best->height)) {
            best = FacetUnder{facet, *height};
        }
        return best ? best->height : -kInfinite;
    });
    return best;
}

}  // namespace cusp::part_model
