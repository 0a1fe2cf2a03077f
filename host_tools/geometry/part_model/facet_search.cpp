// Boxes are searched in the order of their upper bounds of a ball's height.
#include "host_tools/geometry/part_model/facet_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

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

std::optional<MeshContact> drop_on_facets(const PartModel::State& state,
                                          const ToolProfile& tool,
                                          double x,
                                          double y)
{
    // Facets that share the contact are found in any order, so all alike are compared at the end.
    struct Alike {
        FacetContact at;
        std::size_t facet;
    };
    thread_local std::vector<Alike> alike;
    alike.clear();
    double highest = -kInfinite;
    const double square_radius = tool.radius() * tool.radius();
    const auto bound = [&](const BoxTree::Node& box) {
        const double square = square_to_box(box, x, y);
        return square > square_radius ? -kInfinite : box.high.z - tool.height(std::sqrt(square));
    };
    const auto look = [&](std::size_t facet) {
        const auto found = drop_on_facet(state.facets[facet], tool, x, y, highest - kAlike);
        if (found && found->centre >= highest - kAlike) {
            highest = std::max(highest, found->centre);
            alike.push_back({*found, facet});
        }
        return highest;
    };
    // The next query is usually near the last one, and so is its result.
    std::size_t& last_facet = state.history().last_facet;
    const double known = state.facets.empty() ? -kInfinite : look(last_facet);
    visit_facets(state, known, bound, look);
    std::optional<MeshContact> best;
    double best_facing = -kInfinite;
    for (const Alike& contact : alike) {
        if (contact.at.centre < highest - kAlike) {
            continue;
        }
        const Vec3d into = -tool.core_at(x, y, contact.at.centre).reach(contact.at.point);
        const double reach = norm(into);
        const Vec3d lean = reach > 0 ? into / reach : Vec3d{};
        const double facing = dot(lean, state.facets[contact.facet].normal);
        if (!best || facing > best_facing ||
            (facing == best_facing && contact.facet < best->facet)) {
            best = MeshContact{contact.at, lean, contact.facet};
            best_facing = facing;
        }
    }
    if (best) {
        last_facet = best->facet;
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
        if (height &&
            (!best || *height > best->height || (*height == best->height && facet < best->facet))) {
            best = FacetUnder{facet, *height};
        }
        return best ? best->height : -kInfinite;
    });
    return best;
}

}  // namespace cusp::part_model
