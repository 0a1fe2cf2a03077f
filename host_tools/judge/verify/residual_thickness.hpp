// Thickness of the stock left at a point, measured as the shortest distance through it: a sliver
// beside a cliff is high along the axis, and yet thin.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"

namespace cusp::verify {

class ResidualThickness {
public:
    // runs  all positions of the tools; must outlive this
    // top   of the uncut stock: positions above it cut nothing
    ResidualThickness(const std::vector<ToolPositions>& runs, double top);

    // mm from a point in the stock to the nearest position of a tool. Too high by at most the
    // slivers between two positions.
    //
    // max_distance  mm: an upper bound of the result, as the height of material over the place
    // sufficient    mm: results up to this may be inexact
    double at(Vec3d place, double max_distance, double sufficient) const;

private:
    struct Position {
        std::uint32_t run;
        std::uint32_t number;
    };
    std::size_t cell(double at, double first, std::size_t count) const;

    const std::vector<ToolPositions>& runs_;
    double widest_{};
    double pitch_{};
    double x0_{};
    double y0_{};
    std::size_t nx_{};
    std::size_t ny_{};
    std::vector<std::vector<Position>> cells_;
};

}  // namespace cusp::verify
