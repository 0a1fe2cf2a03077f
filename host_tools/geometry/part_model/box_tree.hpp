// A tree of boxes over cells, edges or triangles, for nearest searches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

struct BoxTree {
    struct Node {
        Vec3d low;
        Vec3d high;
        // Children, side by side; a leaf has child[0] < 0 and holds child[1] items from -child[0] - 1 on.
        std::array<int, 2> child;
    };
    std::vector<Node> nodes;  // the first is the root
};

// Over boxes given by their corners; a leaf is one item.
//
// numbers  of each box, which leaves hold
BoxTree make_box_tree(const std::vector<std::array<Vec3d, 2>>& boxes,
                      const std::vector<std::uint32_t>& numbers);

// Over triangles, up to four a leaf.
//
// order  set to the triangles' numbers in the order of the tree's items
BoxTree make_facet_tree(const std::vector<std::array<Vec3d, 3>>& triangles,
                        std::vector<std::uint32_t>& order);

}  // namespace cusp::part_model
