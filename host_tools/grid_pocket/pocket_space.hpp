// The pocket for its passes: where the axis may be, how low, and in which order.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/grid_pocket/grid_input.hpp"
#include "host_tools/grid_pocket/grid_navigation.hpp"
#include "host_tools/grid_pocket/grid_roughness.hpp"

namespace cusp::grid_pocket {

// Beyond the radius, mm, so that G-code rounded to its last digit still keeps it.
constexpr double kWallRounding = 5e-4;

// How the operation's tolerances and output bound the moves over the floor.
FollowSettings follow_settings(const job::Operation& operation);

// Everything about the pocket that the passes share.
struct PocketSpace {
    const job::Job& job;
    const job::Operation& operation;
    double kept;  // mm from the axis to the walls
    offset::RegionOffset walls;
    offset::Region2d centres;  // where the pass along the walls runs
    offset::EdgeTree centre_edges;
    CellGrid grid;
    ClPathFitter finish;
    ClPathFitter rough;           // leaves the allowance
    std::vector<double> heights;  // finish heights over cells
    std::vector<double> rough_heights;

    PocketSpace(const job::Job& j, const job::Operation& o, const PocketWalls& pocket);

    // The place of the pass along the walls nearest to a point. Precondition: there is such a pass.
    Vec2d on_wall_pass(Vec2d p) const;

    // Whether the axis may go straight from a to b.
    bool clear(Vec2d a, Vec2d b) const;
    bool clear(Cell a, Cell b) const { return clear(grid.centre(a), grid.centre(b)); }

    // Where a navigation may go. The rules must not outlive this.
    void add_ways(NavigationRules& rules) const;
};

// Heights of the tip over all cells inside, NaN elsewhere. Errors: InputError where no floor lies.
std::vector<double> heights_over(const PocketSpace& pocket, const ClPathFitter& follower);

// All cells, in the order they are machined.
Navigation finish_navigation(const PocketSpace& pocket);

// The steps between neighbours that the navigation takes.
Tracks tracks_of(const CellGrid& grid, const Navigation& navigation);

// Of the main path with the operation's zigzags and the wall's pass, mm.
double roughness_of(const PocketSpace& pocket, const Navigation& navigation);

// A place where the CL height jumps.
struct Cliff {
    Vec2d at;
    double height;  // mm
};

// The highest cliff between neighbouring cells, if any is higher than the tool's radius: the
// roughness does not count the material that stays beside it.
std::optional<Cliff> highest_cliff(const PocketSpace& pocket);

struct LayerPlanes {
    std::vector<double> z;  // descending
    int left_out;           // of the job's layers, those that no cell reaches
    double lowest;          // z that the tip reaches
};

// Layers are so much nearer than max_depth that scallops, tolerance and allowance fit in, too.
LayerPlanes layer_planes(const PocketSpace& pocket);

}  // namespace cusp::grid_pocket
