// The search for the place of a model nearest to a tool's core, over a tree of boxes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "host_tools/part_model/bezier_cell.hpp"
#include "host_tools/part_model/box_tree.hpp"
#include "host_tools/part_model/facet_distance.hpp"
#include "host_tools/part_model/part_model.hpp"
#include "host_tools/part_model/tool_core.hpp"
#include "host_tools/part_model/trim_region.hpp"

namespace cusp::part_model {

struct PartModel::State {
    std::size_t halves{};  // of the cells, and of those
    std::vector<std::unique_ptr<BezierCell>> cells;
    std::vector<TrimRegion> regions;
    std::vector<std::array<Vec3d, 2>> edges;
    std::vector<int> edge_surface;
    double edge_error{};
    std::vector<Facet> facets;  // as the tree has them in order
    BoxTree tree;               // of cells first, then edges; or of facets
    Vec3d low;
    Vec3d high;
    // To find the cell of a parameter pair: breaks of u and v and the first cell, per surface.
    struct Grid {
        std::vector<double> u;
        std::vector<double> v;
        std::size_t first;
        // Knots where the tangent may jump, and the ends of the domain.
        std::vector<double> creases_u;
        std::vector<double> creases_v;
        // The spans of the last answer: the next question is mostly in or beside them.
        mutable std::size_t last_u{};
        mutable std::size_t last_v{};
    };
    std::vector<Grid> grids;
    const BezierCell& cell_at(int surface, double u, double v) const;
    bool outside_trims(const BezierCell& cell) const;
    // The cell of the last answer: the next question is mostly beside it.
    mutable const BezierCell* last_cell{nullptr};
    mutable double last_s{};
    mutable double last_t{};
    mutable std::size_t last_facet{};
};

// The lower bound of the distance from the core to the model, cut off at `limit`, and its place.
//
// max_error    mm: how low it may be, if that is more than what this takes anyhow
// near_enough  mm: a result of no more only says that the model is no farther than this
struct NearestResult {
    double distance;
    NearestPoint place;
};
NearestResult nearest(const PartModel::State& state,
                      const ToolCore& core,
                      double limit,
                      double max_error = 0,
                      double near_enough = -1);

// Whether all of the model is at least so far from the core: ends at the first place that is not.
bool is_core_distance_at_least(const PartModel::State& state, const ToolCore& core, double least);

}  // namespace cusp::part_model
