// A tree of boxes over cells, edges or triangles, for searches of what is near.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_model {

struct BoxTree {
    struct Node {
        Vec3d low;
        Vec3d high;
        // Children; a leaf has child[0] < 0 and holds child[1] items from -child[0] - 1 on.
        std::array<int, 2> child;
    };
    std::vector<Node> nodes;  // the first is the top
};

// Over boxes given by their corners; items keep their numbers, one a leaf.
BoxTree make_box_tree(const std::vector<std::array<Vec3d, 2>>& boxes);

// Over triangles, some a leaf.
//
// order  set to the triangles' numbers as the tree's items are in order
BoxTree make_facet_tree(const std::vector<std::array<Vec3d, 3>>& triangles,
                        std::vector<std::uint32_t>& order);

}  // namespace cusp::part_model
