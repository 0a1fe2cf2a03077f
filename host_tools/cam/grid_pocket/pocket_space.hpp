// The pocket for its passes: where the axis may be, heights of the tip, order of the cells.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/cam/grid_pocket/grid_input.hpp"
#include "host_tools/cam/grid_pocket/grid_navigation.hpp"
#include "host_tools/cam/grid_pocket/grid_roughness.hpp"

namespace cusp::grid_pocket {

// mm beyond the radius, so that rounded G-code still keeps the distance.
constexpr double kWallRounding = 5e-4;

// mm: what roughing leaves over the floor, along the normal, and where it clears adaptively at the
// walls. There it is more than the job asks for, so that the stock height map can see it.
double roughing_allowance(const job::Operation& operation);

// The settings that follow from the operation's tolerances and output.
FollowSettings follow_settings(const job::Operation& operation);

// Data of the pocket common to all passes.
struct PocketSpace {
    const job::Job& job;
    const job::Operation& operation;
    double kept;             // mm: least distance of the axis from the walls
    double rough_allowance;  // mm
    offset::RegionOffset walls;
    offset::Region2d centres;  // the wall pass is its border
    offset::EdgeTree centre_edges;
    CellGrid grid;
    ClPathFitter finish;
    ClPathFitter rough;           // leaves the allowance
    std::vector<double> heights;  // finish heights over cells
    std::vector<double> rough_heights;

    PocketSpace(const job::Job& j, const job::Operation& o, const PocketWalls& pocket);

    // The point of the wall pass nearest to a point. Precondition: the pass exists.
    Vec2d on_wall_pass(Vec2d p) const;

    // True if the axis may move straight from a to b.
    bool clear(Vec2d a, Vec2d b) const;
    bool clear(Cell a, Cell b) const { return clear(grid.centre(a), grid.centre(b)); }

    // Sets the rules for clear moves. They must not outlive this.
    void add_clearances(NavigationRules& rules) const;
};

// Heights of the tip at all cells inside, NaN elsewhere. Errors: InputError where there is no
// floor.
std::vector<double> heights_over(const PocketSpace& pocket, const ClPathFitter& follower);

// All cells, in the order they are machined.
Navigation finish_navigation(const PocketSpace& pocket);

// The steps between neighbours that the navigation takes.
Tracks tracks_of(const CellGrid& grid, const Navigation& navigation);

// mm: of the main path with the operation's zigzags and the wall pass.
double roughness_of(const PocketSpace& pocket, const Navigation& navigation);

// A place where the CL height jumps.
struct Cliff {
    Vec2d at;
    double height;  // mm
};

// The highest cliff between neighbouring cells, if any is higher than the tool's radius: the
// roughness does not include stock left beside it.
std::optional<Cliff> highest_cliff(const PocketSpace& pocket);

// z: the lowest of the tip in layers. Needs the rough heights.
double lowest_of_tip(const PocketSpace& pocket);

struct LayerPlanes {
    std::vector<double> z;  // descending
    int left_out;           // number of the job's layers that no cell reaches
    double lowest;          // z: the lowest of the tip
};

// Distances of layers are less than max_depth by the scallops, tolerance and allowance.
LayerPlanes layer_planes(const PocketSpace& pocket);

}  // namespace cusp::grid_pocket
