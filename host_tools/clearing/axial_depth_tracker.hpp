// Axial depth of cut: how deep moves cut, and how high the stock is ahead of them.
//
//     AxialDepthTracker depth{box, tool, 0.0, 2.0};    // stock up to z = 0, cuts of 2 mm at most
//     depth.track(path.moves);                         // all moves so far are cut
//     if (depth.allowed_height_over(start, ahead, 1.0)) { ... }  // `ahead` would cut deeper
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/clearing/stock_height_map.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::clearing {

class AxialDepthTracker {
public:
    // box        all places that tools may touch
    // finest     the smallest of the tools
    // top        z of the uncut stock
    // max_depth  mm: no cut may be deeper; no value where any may
    // share      of the finest tool's radius: between points where the stock is known
    AxialDepthTracker(const offset::Box2d& box,
                      const toolpath::Tool& finest,
                      double top,
                      std::optional<double> max_depth,
                      double share = 1.0 / 12);

    // Another tool begins a path of its own.
    void begin(const toolpath::Tool& tool);

    // Takes off what moves cut that were added to the path since.
    void track(const std::vector<toolpath::ToolMove>& path);

    // What moves from `start` would cut, one after the other: no value where that is nowhere deeper
    // than `share` of max_depth; else the z that a tip on the moves may be raised to.
    std::optional<double> allowed_height_over(Vec3d start,
                                              const std::vector<toolpath::ToolMove>& moves,
                                              double share);

    // z where a tip that comes down over the place, over the moves, or somewhere on the circle
    // first touches stock; -kUnbounded where there is none.
    double stock_top_at(Vec2d place) const;
    double stock_top_over(Vec3d start, const std::vector<toolpath::ToolMove>& moves) const;
    double stock_top_around(Vec2d centre, double radius) const;

    std::optional<double> max_depth() const { return max_depth_; }

    // mm: deepest cut of the moves tracked so far.
    double deepest() const { return deepest_; }

private:
    template <class Visit>
    void walk(Vec3d start, const std::vector<toolpath::ToolMove>& moves, Visit visit) const;

    StockHeightMap stock_;
    std::optional<StockHeightMap> ahead_;  // what allowed_height_over() cuts
    std::optional<double> max_depth_;
    double apart_{};  // mm between places of moves ahead
    std::size_t tracked_moves_{0};
    Vec3d at_{};
    double deepest_{0.0};
};

}  // namespace cusp::clearing
