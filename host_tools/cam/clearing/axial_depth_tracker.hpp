// Axial depth of cut: the depth of moves, and the height of the stock ahead of them.
//
//     AxialDepthTracker depth{box, tool, 0.0, 2.0};    // stock up to z = 0, cuts of at most 2 mm
//     depth.track(path.moves);                         // removes the stock cut by all moves so far
//     if (depth.allowed_height_over(start, ahead, 1.0)) { ... }  // `ahead` would cut deeper
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/cam/clearing/stock_height_map.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::clearing {

class AxialDepthTracker {
public:
    // box        everything that tools may touch
    // finest     the smallest of the tools
    // top        z of the uncut stock
    // max_depth  mm: limit of the depth of cut; none: no limit
    // share      of the finest tool's radius: pitch of the stock height map
    AxialDepthTracker(const offset::Box2d& box,
                      const toolpath::Tool& finest,
                      double top,
                      std::optional<double> max_depth,
                      double share = 1.0 / 12);

    // Starts the path of another tool.
    void begin(const toolpath::Tool& tool);

    // Removes the stock cut by moves added to the path since the last call.
    void track(const std::vector<toolpath::ToolMove>& path);

    // Simulates moves from `start`: none if no cut is deeper than `share` of max_depth; else the z
    // to which a tip on the moves may be raised.
    std::optional<double> allowed_height_over(Vec3d start,
                                              const std::vector<toolpath::ToolMove>& moves,
                                              double share);

    // z at which a tip descending at the place, over the moves, or anywhere on the circle first
    // touches stock; -kUnbounded, no bound, where there is none.
    double stock_top_at(Vec2d place) const;
    double stock_top_over(Vec3d start, const std::vector<toolpath::ToolMove>& moves) const;
    double stock_top_around(Vec2d centre, double radius) const;

    // At least stock_top_at() at each place that is no farther from this one than `within` (mm).
    double most_stock_top_near(Vec2d place, double within) const;

    std::optional<double> max_depth() const { return max_depth_; }

    // mm: deepest cut of the tracked moves.
    double deepest() const { return deepest_; }

private:
    template <class Visit>
    void walk(Vec3d start, const std::vector<toolpath::ToolMove>& moves, Visit visit) const;

    StockHeightMap stock_;
    std::optional<double> max_depth_;
    double apart_{};  // mm between points of moves ahead
    std::size_t tracked_moves_{0};
    Vec3d at_{};
    double deepest_{0.0};
};

}  // namespace cusp::clearing
