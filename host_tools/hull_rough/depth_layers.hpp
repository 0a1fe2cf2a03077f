// How deep each layer is cut: planes from the tops of the convex hull boxes.
#pragma once

#include <vector>

#include "host_tools/hull_rough/hull_patch.hpp"

namespace cusp::hull_rough {

struct DepthLimits {
    double most{};  // mm, > 0: no layer is thicker
    // mm, 0 <= least <= most: thinner layers are merged where the limit above allows
    double least{};
};

struct LayerPlan {
    // z, descending; planes[i] is the top of layer i, the last the bottom
    std::vector<double> planes;
    std::vector<HullPatch> patches;  // the input, quartered where a layer was too thick
    int raw_layers{};                // before any was split or merged
    int split_layers{};              // after splitting, before merging
};

// Layers between the tops of the patches' boxes, from `top` down to `bottom`. A layer that is too
// thick has the patches that start it quartered until new tops divide it, or is divided equally
// where they bring none (a flat patch). Layers that are too thin are merged into the one above,
// from the bottom up, until none can be. Source: Chuang & Pan, section 4; equal division and the
// order of merging are ours.
LayerPlan depth_layers(std::vector<HullPatch> patches,
                       double top,
                       double bottom,
                       DepthLimits limits);

// As many layers as `plan` has, or fewer, with the planes where least metal is left over the part:
// the planes are chosen by dynamic programming over the area that the patches cover at each height.
// The number of layers stays the paper's; only where they lie changes. Returns the plan's planes
// where the limits allow no others.
std::vector<double> least_leftover_planes(const LayerPlan& plan, DepthLimits limits);

}  // namespace cusp::hull_rough
