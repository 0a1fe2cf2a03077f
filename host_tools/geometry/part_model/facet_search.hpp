// Drop cutter for balls on meshes, over the tree of boxes.
#pragma once

#include <optional>

#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

// A ball dropped at (x, y) on the facets of a model; none where it misses them all. If it touches
// several, the one that faces its centre most.
struct MeshContact {
    FacetContact at;
    std::size_t facet;
};
std::optional<MeshContact> drop_ball_on_facets(const PartModel::State& state,
                                               double x,
                                               double y,
                                               double radius);

// The highest facet at (x, y).
struct FacetUnder {
    std::size_t facet;
    double height;
};
std::optional<FacetUnder> highest_facet(const PartModel::State& state, double x, double y);

}  // namespace cusp::part_model
