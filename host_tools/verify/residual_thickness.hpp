// How thick the metal is that a program left over single places, measured the shortest way: beside
// cliffs a sliver stands high that is hardly there.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/machined_stock.hpp"

namespace cusp::verify {

class ResidualThickness {
public:
    // runs  all positions of the tools; they must outlive this
    // top   of the uncut stock: positions from there on cut nothing
    ResidualThickness(const std::vector<ToolPositions>& runs, double top);

    // mm from a place in the metal to the nearest position of a tool. High by at most what stands
    // between two positions.
    //
    // max_distance  mm: what is known to be more than the answer, as the height of metal over the
    // place
    // sufficient  mm: thicknesses up to this may be inexact
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
