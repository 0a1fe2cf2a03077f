// Axial depth of cut: how deep passes would cut, and how high the stock is ahead of them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/clearing/stock_height_map.hpp"
#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

constexpr double kUnlimitedDepth = 1e300;

class AxialDepthTracker {
public:
    // box     all places that tools may touch
    // finest  the smaller of the tools: the stock is known at points a 24th of its radius apart
    // top     of the uncut stock, z
    // most    mm: no cut may be deeper; kUnlimitedDepth where any may
    AxialDepthTracker(const offset::Box2d& box,
                      const toolpath::Tool& finest,
                      double top,
                      double most);

    // Another tool begins a path of its own.
    void begin(const toolpath::Tool& tool);

    // Takes off what moves do that were added to the path since.
    void track(const std::vector<toolpath::ToolMove>& path);

    // What following the path would cut, move by move: no value where that is nowhere deeper than
    // `share` of what may be; else z of a level that a tip on the path may be raised to.
    std::optional<double> allowed_height_over(const ClPath& path, double share);

    // z: where a tip that comes down over the path first touches stock.
    double stock_top_over(const ClPath& path) const;

    // z: where a tip that comes down over the place first touches stock.
    double stock_top_at(Vec2d place) const;

    // z: where a tip that comes down somewhere on the circle first touches stock.
    double stock_top_around(Vec2d centre, double radius) const;

    double max_depth() const { return max_depth_; }

    // mm: deepest cut of the moves tracked so far.
    double deepest() const { return deepest_; }

private:
    template <class Visit>
    void walk(const ClPath& path, Visit visit) const;

    clearing::StockHeightMap stock_;
    clearing::StockHeightMap ahead_;  // what allowed_height_over() cuts
    double max_depth_;
    double apart_{};  // mm between places of a path
    std::size_t tracked_moves_{0};
    Vec3d at_{};
    double deepest_{0.0};
};

}  // namespace cusp::contour_pocket
