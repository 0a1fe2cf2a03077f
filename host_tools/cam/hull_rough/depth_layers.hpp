// The planes between layers, from the tops of the convex hull boxes.
#pragma once

#include <vector>

#include "host_tools/cam/hull_rough/hull_patch.hpp"

namespace cusp::hull_rough {

struct DepthLimits {
    double max_thickness{};  // mm, > 0, of a layer
    // mm, 0 <= min_thickness <= max_thickness: thinner layers are merged as far as the maximum allows
    double min_thickness{};
};

struct LayerPlan {
    // z, descending; planes[i] is the top of layer i, the last the bottom
    std::vector<double> planes;
    std::vector<HullPatch> patches;  // the input, quartered where a layer was too thick
    int raw_layers{};                // before splitting and merging
    int split_layers{};              // after splitting, before merging
};

// Layers between the tops of the patches' boxes, from `top` down to `bottom`. If a layer is too
// thick, the patches at its top are quartered until new tops divide it; if there are none (a flat
// patch), it is divided equally. Layers that are too thin are merged into the one above, from the
// bottom up. Source: Chuang & Pan, section 4; equal division and the order of merging are ours.
LayerPlan depth_layers(std::vector<HullPatch> patches,
                       double top,
                       double bottom,
                       DepthLimits limits);

// The planes, for at most as many layers as `plan` has, that leave the least stock over the part.
// They are chosen by dynamic programming over the area that the patches cover at each height. The
// number of layers is that of the paper. Returns the plan's planes if the limits allow no others.
std::vector<double> least_leftover_planes(const LayerPlan& plan, DepthLimits limits);

}  // namespace cusp::hull_rough
