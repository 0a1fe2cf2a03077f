// Faults of a mesh: holes, edges with three facets, inverted facets; its shells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_info {

struct MeshHealth {
    std::size_t open_edges{};          // with a facet on one side only
    std::size_t holes{};               // connected borders of such edges
    std::size_t non_manifold_edges{};  // with more than two facets
    std::size_t inverted_facets{};     // oriented against most of their shell
    std::size_t inside_out_shells{};   // closed, with facets that face inwards, such as cavities
    std::size_t shells{};              // parts connected by edges
    bool closed{};                     // no edge open or with more than two facets
    std::optional<Vec3d> hole_at;      // an open edge's middle
    std::optional<Vec3d> non_manifold_at;
};

// Facets that share their corners.
struct MeshEdge {
    std::array<std::uint32_t, 2> corners;
    std::array<std::uint32_t, 2> facets;
};
struct WeldedMesh {
    std::vector<Vec3d> corners;
    std::vector<std::array<std::uint32_t, 3>> facets;
    // One value for each facet: +1 where its corners run counter-clockwise seen from outside, -1 where
    // clockwise; 0: its shell is not closed and has no outside.
    std::vector<std::int8_t> outwards;
    std::vector<MeshEdge> edges;  // those with two facets
    MeshHealth health;
};

// Welds corners with bitwise equal coordinates, since STL writers repeat them. Takes about 150
// bytes and a microsecond for each facet.
WeldedMesh weld(const std::vector<std::array<Vec3d, 3>>& triangles);

}  // namespace cusp::part_info
