// The stock's outline in plan, and pockets that reach it.
#pragma once

#include "host_tools/job/job/job.hpp"

namespace cusp::job {

// mm: an outline that is no farther inside than this lies on the stock's edge.
inline constexpr double kOnEdge = 0.002;

// The ends of the stock; unbounded if the job does not give them.
struct StockSides {
    double x_low{-kUnbounded};
    double x_high{kUnbounded};
    double y_low{-kUnbounded};
    double y_high{kUnbounded};
};

StockSides stock_sides(const Job& job);

// True if the operation clears a pocket adaptively whose outline lies on or outside of the stock's
// edge somewhere: the tool comes in there from beside the stock. The job's x and y are all there is
// of the stock then, even where the drawing is larger.
bool is_open_pocket(const Job& job, const Operation& operation);

}  // namespace cusp::job
