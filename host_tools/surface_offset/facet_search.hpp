// What of a model's facets a ball comes down on, over the tree of boxes.
#pragma once

#include <optional>

#include "host_tools/surface_offset/nearest_search.hpp"

namespace cusp::host {

// A ball let down at (x, y) on the facets of a model; none where it passes beside all of them.
// Where several are met at once, the one that faces the ball most.
struct MeshContact {
    FacetContact at;
    std::size_t facet;
};
std::optional<MeshContact> rest_on_facets(const SurfaceModel::State& state,
                                          double x,
                                          double y,
                                          double radius);

// The highest facet at (x, y).
struct FacetUnder {
    std::size_t facet;
    double height;
};
std::optional<FacetUnder> highest_facet(const SurfaceModel::State& state, double x, double y);

}  // namespace cusp::host
