// Ground of a tool that finishes surfaces: it may be over them, and beside them as far as it reaches. Operations with
// walls cut what lies beyond, and these walls judge it.
//
//     const FinishedGround ground{operation, part_heights(...).z, grid};
//     ground.room(x, y);  // mm of the tool's centre, as from walls
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

// True if an operation without walls stays with its ground: it finishes, and does not rough the stock around.
bool stays_with_ground(const job::Operation& operation);

class FinishedGround {
public:
    // heights  of the operation's surfaces at the points of the grid; NaN where there is none
    FinishedGround(const job::Operation& operation,
                   const std::vector<double>& heights,
                   const HeightGrid& grid);

    // mm: a place with at least the tool's radius is beside the ground at most. The distance of any
    // other place counts as that from a wall. Accuracy: two pitches, to the tool's favour.
    double room(double x, double y) const;

private:
    HeightGrid grid_;
    double reach_;              // mm: the room over the ground
    std::vector<double> away_;  // mm, of each point
};

}  // namespace cusp::verify
