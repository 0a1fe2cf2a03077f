// Ground of a tool that finishes surfaces: it may be over them, and beside them as far as it reaches. Operations with
// walls cut what lies beyond, and these walls judge it.
//
//     const FinishedGround ground{operation, part_heights(...).z, grid};
//     ground.room(x, y);  // mm of the tool's centre, as from walls
#pragma once

#include <algorithm>
#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// True if an operation without walls stays with its ground: it finishes, and does not rough the stock around.
bool stays_with_ground(const job::Operation& operation);

// True for the positions of whole cuts that stay: a cut, from one rapid move to the next below z `top`, is that of one
// operation.
//
// stays  of a tip: whether the operation may have cut there
template <class Stays>
std::vector<char> whole_cuts(const ToolPositions& run, double top, const Stays& stays)
{
    std::vector<char> out(run.tips.size());
    for (std::size_t first = 0; first < out.size();) {
        std::size_t last = first;
        bool all = true;
        while (last < out.size() && run.rapid[last] == run.rapid[first] && run.tips[last].z < top) {
            all = all && stays(run.tips[last]);
            ++last;
        }
        std::fill(out.begin() + static_cast<std::ptrdiff_t>(first),
                  out.begin() + static_cast<std::ptrdiff_t>(last), all ? 1 : 0);
        first = std::max(first + 1, last);
    }
    return out;
}

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
