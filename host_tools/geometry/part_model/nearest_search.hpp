// The search for the point of a model nearest to a tool's core, over a tree of boxes.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/box_tree.hpp"
#include "host_tools/geometry/part_model/facet_distance.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/part_model/tool_core.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_model {

struct PartModel::State {
    std::atomic<std::size_t> halves{};  // how many halves of cells exist, at all levels
    std::atomic<int> sharers{};         // SharedQueries that live
    std::shared_mutex parts;            // held by each of their parts, alone to release halves
    std::atomic<bool> released{};       // by one of these parts
    std::vector<std::unique_ptr<BezierCell>> cells;
    std::vector<TrimRegion> regions;
    // Corners of edges, loop by loop; edges have the number of their first corner.
    std::vector<Vec3d> edges;
    std::vector<std::size_t> first_edges;  // of each surface
    double edge_error{};
    std::vector<Facet> facets;  // in the order of the tree
    // Over cells and edges, whose numbers follow those of cells; or over facets.
    BoxTree tree;
    Vec3d low;
    Vec3d high;
    // The cells of a surface, by their parameters: the breaks of u and v, and the first cell.
    struct Grid {
        std::vector<double> u;
        std::vector<double> v;
        std::size_t first;
        // Knots where the tangent may jump, and the ends of the domain.
        std::vector<double> creases_u;
        std::vector<double> creases_v;
    };
    std::vector<Grid> grids;
    const BezierCell& cell_at(int surface, double u, double v) const;
    int surface_of_edge(std::size_t edge) const;
    bool outside_trims(const BezierCell& cell) const;
    // A contact and what move clearances have found around it.
    struct KnownContact {
        CcPoint at;
        const BezierCell* cell{nullptr};  // the piece of surface it lies in; null: not known
        // mm: all but the surroundings of the cell is farther than the contact by at least this;
        // negative: not known.
        double margin{-1};
    };
    // The contacts of the last queries: a path queries each contact for the moves to and from it.
    KnownContact known(const CcPoint& contact) const;
    void remember(const KnownContact& contact) const;
    // The last results of a thread, from which its next query starts.
    struct History {
        std::array<std::optional<KnownContact>, 4> known_contacts;
        std::size_t oldest_contact{};
        // The cell of the last result: the next one is usually near it.
        const BezierCell* last_cell{nullptr};
        double last_s{};
        double last_t{};
        std::size_t last_facet{};
        // The span of the last cell_at() in u and v, and its surface.
        int last_surface{-1};
        std::size_t last_u{};
        std::size_t last_v{};
    };
    // The history of the calling thread.
    History& history() const;
    // Clears the histories of all threads. To be called while no other thread queries.
    void forget_histories() const;
    // Releases all halves. As forget_histories().
    void forget_cells();

private:
    static std::uint64_t next_number();
    const std::uint64_t number_{next_number()};  // no two models ever share one
    mutable std::mutex guard_;
    mutable std::unordered_map<std::thread::id, std::unique_ptr<History>> histories_;
};

// All in mm.
struct NearestOptions {
    double limit;            // greater distances are returned as this
    double max_error{0};     // how much too low the distance may be, if more than the method's own
    double near_enough{-1};  // the search ends at distances up to this
};
struct NearestResult {
    double distance;
    NearestPoint place;
};
// A lower bound of the distance from the core to the model, and the nearest point.
NearestResult nearest(const PartModel::State& state,
                      const ToolCore& core,
                      const NearestOptions& options);

// True if the whole model is at least `least` (mm) from the core: ends at the first point that is
// not.
bool is_core_distance_at_least(const PartModel::State& state, const ToolCore& core, double least);

}  // namespace cusp::part_model
