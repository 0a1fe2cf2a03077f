// Drop cutter on meshes, over the tree of boxes.
#pragma once

#include <optional>

#include "host_tools/geometry/part_model/facet_drop.hpp"
#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

// A tool dropped at (x, y) on the facets of a model; none where it misses them all. If it touches
// several, the one that faces it most.
struct MeshContact {
    FacetContact at;
    Vec3d
        lean;  // unit, from the contact into the tool; zero for a contact with a corner radius of 0
    std::size_t facet;
};
std::optional<MeshContact> drop_on_facets(const PartModel::State& state,
                                          const ToolProfile& tool,
                                          double x,
                                          double y);

// The highest facet at (x, y).
struct FacetUnder {
    std::size_t facet;
    double height;
};
std::optional<FacetUnder> highest_facet(const PartModel::State& state, double x, double y);

}  // namespace cusp::part_model
