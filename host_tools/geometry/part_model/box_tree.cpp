// A node is split at the median of its items' centres, along the longest side.
#include "host_tools/geometry/part_model/box_tree.hpp"

#include <algorithm>

namespace cusp::part_model {
namespace {

constexpr std::size_t kFacetsALeaf = 4;

// An item to be put into a tree, with the centre of its box as sort key.
struct Item {
    std::array<float, 3> middle;
    std::uint32_t number;
};

// Makes tree.nodes[here] the root of a tree over the items [begin, end).
//
// box_of(number, low, high) extends a box by that of an item.
template <class BoxOf>
void build(BoxTree& tree,
           std::size_t here,
           std::vector<Item>& items,
           std::size_t begin,
           std::size_t end,
           std::size_t leaf,
           const BoxOf& box_of)
{
    BoxTree::Node node{{kInfinite, kInfinite, kInfinite},
                       {-kInfinite, -kInfinite, -kInfinite},
                       {-static_cast<int>(begin) - 1, static_cast<int>(end - begin)}};
    if (end - begin <= leaf) {
        for (std::size_t k = begin; k < end; ++k) {
            box_of(items[k].number, node.low, node.high);
        }
        tree.nodes[here] = node;
        return;
    }
    std::array<float, 3> low = items[begin].middle;
    std::array<float, 3> high = low;
    for (std::size_t k = begin; k < end; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], items[k].middle[axis]);
            high[axis] = std::max(high[axis], items[k].middle[axis]);
        }
    }
    const std::array<float, 3> size{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0
                             : size[1] >= size[2]                     ? 1
                                                                      : 2;
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t k) {
        return items.begin() + static_cast<std::ptrdiff_t>(k);
    };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
        return a.middle[axis] < b.middle[axis];
    });
    // Side by side: a search looks at both boxes at once.
    const std::size_t first = tree.nodes.size();
    tree.nodes.resize(first + 2);
    build(tree, first, items, begin, middle, leaf, box_of);
    build(tree, first + 1, items, middle, end, leaf, box_of);
    const BoxTree::Node& a = tree.nodes[first];
    const BoxTree::Node& b = tree.nodes[first + 1];
    for (unsigned k = 0; k < 3; ++k) {
        node.low[k] = std::min(a.low[k], b.low[k]);
        node.high[k] = std::max(a.high[k], b.high[k]);
    }
    node.child = {static_cast<int>(first), static_cast<int>(first + 1)};
    tree.nodes[here] = node;
}

// The tree over items 0 to count - 1.
template <class BoxOf>
BoxTree tree_over(std::size_t count,
                  std::size_t leaf,
                  const BoxOf& box_of,
                  std::vector<std::uint32_t>& order)
{
    BoxTree tree;
    order.clear();
    if (count == 0) {
        return tree;
    }
    std::vector<Item> items(count);
    for (std::size_t k = 0; k < count; ++k) {
        Vec3d low{kInfinite, kInfinite, kInfinite};
        Vec3d high = -low;
        items[k].number = static_cast<std::uint32_t>(k);
        box_of(k, low, high);
        for (unsigned axis = 0; axis < 3; ++axis) {
            items[k].middle[axis] = static_cast<float>(0.5 * (low[axis] + high[axis]));
        }
    }
    // No leaf is less than about half full.
    tree.nodes.reserve(2 * (count / std::max<std::size_t>(1, (leaf + 1) / 2) + 1));
    tree.nodes.resize(1);
    build(tree, 0, items, 0, count, leaf, box_of);
    order.reserve(count);
    for (const Item& item : items) {
        order.push_back(item.number);
    }
    return tree;
}

void widen(Vec3d& low, Vec3d& high, Vec3d to)
{
    for (unsigned axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], to[axis]);
        high[axis] = std::max(high[axis], to[axis]);
    }
}

}  // namespace

BoxTree make_box_tree(const std::vector<std::array<Vec3d, 2>>& boxes,
                      const std::vector<std::uint32_t>& numbers)
{
    std::vector<std::uint32_t> order;
    BoxTree tree = tree_over(
        boxes.size(), 1,
        [&](std::size_t k, Vec3d& low, Vec3d& high) {
            widen(low, high, boxes[k][0]);
            widen(low, high, boxes[k][1]);
        },
        order);
    for (BoxTree::Node& node : tree.nodes) {
        if (node.child[0] < 0) {
            const auto place = static_cast<std::size_t>(-node.child[0] - 1);
            node.child[0] = -static_cast<int>(numbers[order[place]]) - 1;
        }
    }
    return tree;
}

BoxTree make_facet_tree(const std::vector<std::array<Vec3d, 3>>& triangles,
                        std::vector<std::uint32_t>& order)
{
    return tree_over(
        triangles.size(), kFacetsALeaf,
        [&](std::size_t k, Vec3d& low, Vec3d& high) {
            for (const Vec3d& corner : triangles[k]) {
                widen(low, high, corner);
            }
        },
        order);
}

}  // namespace cusp::part_model
